"""`[fitted]` in robot files: read as it is meant, refused if it is none of that robot."""

import tomllib
from collections.abc import Callable

import numpy as np
import pytest

from sinuous.errors import InputError
from sinuous.files import build
from sinuous.robots.pcc_tables import PccTable
from sinuous.robots.robot_file import PRESETS

FITTED = """
[fitted]
motors = ["a", "b", "c", "d", "e", "f", "g", "h", "i"]
directions = [1, 1, 1, 1, -1, 1, 1, 1, 1]
slack_mm = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]
hole_radius_mm = [4.1, 4.2, 4.3, 4.4, 4.5, 4.6, 4.7, 4.8, 4.9]
hole_angle_deg = [0, 120, 240, 30, 150, 270, 60, 180, 300]
twist_deg = [0, 5, 10]
stiffness_ratio = [3e6, 3e6, 3e6, 3e6, 3e6, 3e6, 3e6, 3e6, 3e6]
friction_1_m = [0.5, 0.6, 0.7]
rest_bend_deg = [[1, 2], [3, 4], [5, 6]]
play_mm = 0.1
base_position_mm = [10, 20, 30]
base_axes = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
"""


def table(change: Callable[[str], str] = lambda text: text, preset: str = "opencr_v4") -> PccTable:
    text = change((PRESETS / f"{preset}.toml").read_text(encoding="utf-8") + FITTED)
    return build(PccTable, tomllib.loads(text), file="mine.toml")


def test_it_is_read_in_si() -> None:
    fitted = table().robot("simulation").fitted
    assert fitted is not None
    model = fitted.model
    np.testing.assert_allclose(model.slack, 1e-4 * np.arange(1, 10))
    np.testing.assert_allclose(np.hypot(*model.holes.T), 1e-3 * np.arange(4.1, 4.95, 0.1))
    np.testing.assert_allclose(np.rad2deg(model.rest), [[1, 2], [3, 4], [5, 6]])
    np.testing.assert_allclose(model.friction, [0.5, 0.6, 0.7])
    np.testing.assert_allclose(fitted.T_t_b[:3, 3], [0.01, 0.02, 0.03])
    np.testing.assert_array_equal(fitted.T_t_b[:3, 0], [0, 1, 0])  # columns are the axes
    assert fitted.pulls(np.ones(9))[4] == -1.0


def test_kinematics_use_the_effective_pitch() -> None:
    robot = table(
        lambda t: t.replace("disks = 10", "disks = 10\neffective_pitch_mm = 6.0", 1)
    ).robot("simulation")
    # wider than the body: not where the holes are, but what the cables come to
    assert [segment.pitch_radii[0] for segment in robot.segments] == [6e-3, 4.5e-3, 4.5e-3]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: t.replace("slack_mm = [0.1, ", "slack_mm = ["), r"fitted.slack_mm.*9 values"),
        (lambda t: t.replace("twist_deg = [0, 5, 10]", "twist_deg = [0, 5]"), r"3 values, one for"),
        (lambda t: t.replace("[1, 1, 1, 1, -1", "[1, 1, 1, 1, 2"), r"fitted.directions"),
        (lambda t: t.replace("[0, -1, 0]", "[0, -2, 0]"), r"fitted.base_axes.*a rotation"),
        (lambda t: t.replace("play_mm = 0.1", "play_mm = -0.1"), r"fitted.play_mm"),
        (lambda t: t.replace('"motor"', '"segment"').replace("[112.5, 132.5]", "[50, 70]")
         .replace("[176.5, 196.5]", "[50, 70]"), r"cables counted at the motors"),
    ],
)  # fmt: skip
def test_nonsense_is_refused(change: Callable[[str], str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        table(change)


def test_a_robot_that_changes_its_length_has_none() -> None:
    with pytest.raises(InputError, match="segments of fixed length"):
        table(preset="hachen2025")
