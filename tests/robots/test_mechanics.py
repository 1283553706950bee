"""What moves a robot besides its geometry: values, files in everyday units, refusals."""

from pathlib import Path

import pytest

from sinuous.errors import InputError
from sinuous.robots.mechanics import CableMechanics, JointedMechanics
from sinuous.robots.robot_file import PRESETS, load_jointed

PHYSICS = """
[physics]
module_mass_g = 250
joint_damping_n_m_s_rad = 0.05
joint_armature_g_cm2 = 2000
cable_stiffness_n_mm = 40
cable_damping_n_s_m = 90
pretension_mm = 0.5
play_mm = 0.2
"""
WHAT = """name = "arm"

[modules]
count = 2
holes = 6
radius_mm = 30
plate_offset_mm = 10
tube_length_mm = 80

[limits.simulation]
cable_speed_mm_s = 150
"""


def mechanics(text: str, folder: Path) -> JointedMechanics:
    """What a robot file with this `[physics]` makes."""
    path = folder / "arm.toml"
    path.write_text(WHAT + text)
    return load_jointed(path).mechanics


def test_a_file_says_it_in_everyday_units(tmp_path: Path) -> None:
    assert mechanics(PHYSICS, tmp_path) == JointedMechanics(
        cables=CableMechanics(stiffness=40e3, damping=90.0, pretension=0.5e-3, play=0.2e-3),
        module_mass=0.25,
        joint_damping=0.05,
        joint_armature=2e-4,
    )


def test_what_a_file_does_not_say_is_representative(tmp_path: Path) -> None:
    assert mechanics("", tmp_path) == JointedMechanics()
    assert mechanics("[physics]\nplay_mm = 1\n", tmp_path).cables == CableMechanics(play=1e-3)


def test_the_preset_states_the_default_and_marks_it() -> None:
    assert load_jointed("qin2020").mechanics == JointedMechanics()
    text = (PRESETS / "qin2020.toml").read_text()
    lines = text.partition("[physics]")[2].strip().splitlines()[1:]
    assert len(lines) == 7
    assert all("# representative" in line for line in lines)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("module_mass_g = 0", "physics.module_mass_g: expected more than 0, found 0"),
        ("play_mm = -1", "physics.play_mm: expected at least 0, found -1"),
        ("cable_stiffness_n_m = inf", "physics.cable_stiffness_n_m: expected"),
        ("pretension = 1", "physics.pretension: expected .*pretension_mm"),
        ("joint_damping = 1", "physics.joint_damping: expected .*joint_damping_n_m_s_rad"),
        ("mass_g = 1", "physics.mass_g"),
    ],
)
def test_a_bad_file_is_told_which_field(line: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=message):
        mechanics(f"[physics]\n{line}\n", tmp_path)


@pytest.mark.parametrize("field", ["stiffness", "damping", "pretension", "play"])
@pytest.mark.parametrize("value", [-1.0, float("nan"), float("inf")])
def test_cables_refuse_what_no_cable_has(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"{field} must be .* finite, not {value}"):
        CableMechanics(**{field: value})


@pytest.mark.parametrize("field", ["module_mass", "joint_damping", "joint_armature"])
def test_modules_refuse_what_no_module_has(field: str) -> None:
    with pytest.raises(ValueError, match=f"{field} must be .* finite, not -1"):
        JointedMechanics(**{field: -1.0})


def test_zero_is_allowed_where_it_means_none() -> None:
    CableMechanics(damping=0.0, pretension=0.0, play=0.0)
    JointedMechanics(joint_damping=0.0, joint_armature=0.0)
    with pytest.raises(ValueError, match="stiffness must be positive"):
        CableMechanics(stiffness=0.0)
