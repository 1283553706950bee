"""Scenario files become values in SI; what they name is found beside them."""

import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sinuous as sn
from sinuous.control.mpc import Costs
from sinuous.scenario.path import Leg, follow, timed_path, waypoints
from sinuous.scenario.start import check_start
from sinuous.scenario.text import toml_text

EXAMPLES = Path(__file__).parent.parent / "examples" / "scenarios"
ROUNDING = 1e-12  # of lengths below a metre, after a few operations

FULL = """\
name = "everything"
seed = 7
recover = true
[robot]
file = "hachen2025"
limits = "hardware"
base_position_cm = [1, 2, 3]
base_rotation_deg = [90, 0, 90]
start_lengths_mm = [50, 50, 50, 50, 60, 60, 60, 60, 70, 70, 70, 70]
[zone]
mesh = "meshes/tube.stl"
unit = "cm"
keep_out = ["meshes/post.stl"]
[mpc]
horizon = 3
rate_hz = 50
margin_mm = 2
tip_speed_mm_s = 40
cost = "printed"
[path]
csv = "path.csv"
max_steps = 9
[plant.disturbance]
length_std_mm = 0.1
point_std_mm = 0.2
point_max_mm = 1
rate_hz = 4
"""


@pytest.fixture
def full(tmp_path: Path) -> Path:
    """A scenario that uses every field."""
    (tmp_path / "meshes").mkdir()
    tube = sn.shapes.tube([[0.0, 0.0, -0.3], [0.0, 0.0, 0.3]], 0.2)
    post = sn.shapes.capsule([0.1, 0.0, 0.0], [0.1, 0.0, 0.1], 0.01)
    for mesh, name in ((tube, "tube.stl"), (post, "post.stl")):
        mesh.apply_scale(100.0)
        mesh.export(tmp_path / "meshes" / name)
    (tmp_path / "path.csv").write_text("t_s,x_mm,y_mm,z_mm\n1,0,0,100\n3,20,0,100\n")
    (tmp_path / "scenario.toml").write_text(FULL)
    return tmp_path / "scenario.toml"


def test_every_field_arrives(full: Path) -> None:
    scenario = sn.load_scenario(full)
    mpc = scenario.mpc
    assert (scenario.name, scenario.seed, scenario.recover) == ("everything", 7, True)
    assert (mpc.horizon, mpc.margin, mpc.tip_speed) == (3, 0.002, 0.04)
    assert mpc.dt == 1 / 50
    assert mpc.costs == Costs.printed()
    assert mpc.robot.rate_limits.max() == pytest.approx(0.0045)  # of the hardware
    assert scenario.disturbance == sn.Disturbance(
        length_std=1e-4, point_std=2e-4, point_max=1e-3, rate=4.0
    )
    assert len(scenario.zone.surfaces) == 2
    assert scenario.zone.clearance([0.0, 0.0, 0.0]) == pytest.approx(0.09)  # to the post
    lengths = mpc.robot.lengths(scenario.first_configuration)
    np.testing.assert_allclose(lengths, np.repeat([0.05, 0.06, 0.07], 4), atol=ROUNDING)


def test_the_base_turns_about_fixed_axes(full: Path) -> None:
    robot = sn.load_scenario(full).robot
    # About x: z to -y; then about the world's z: -y to x.
    np.testing.assert_allclose(robot.points(robot.home)[0], [0.01, 0.02, 0.03], atol=ROUNDING)
    along = robot.tip(robot.home) - robot.points(robot.home)[0]
    np.testing.assert_allclose(along / np.linalg.norm(along), [1.0, 0.0, 0.0], atol=ROUNDING)


def test_defaults(tmp_path: Path) -> None:
    path = tmp_path / "least.toml"
    path.write_text(
        'name = "least"\nrobot.file = "hachen2025"\npath.waypoints_mm = [[0, 0, 200]]\n'
    )
    scenario = sn.load_scenario(path)
    np.testing.assert_array_equal(scenario.first_configuration, scenario.robot.home)
    assert scenario.zone.surfaces == ()
    assert scenario.mpc.costs == Costs()
    assert scenario.disturbance is None
    check_start(scenario)


def test_overrides(full: Path) -> None:
    scenario = sn.load_scenario(
        full, set=["mpc.horizon=2", "mpc.margin_cm=0.5", "robot.limits=simulation"]
    )
    assert (scenario.mpc.horizon, scenario.mpc.margin) == (2, 0.005)
    assert scenario.robot.rate_limits.max() == pytest.approx(0.02)


def test_its_text_runs_from_anywhere(full: Path, tmp_path: Path) -> None:
    scenario = sn.load_scenario(full, set=["mpc.horizon=2"])
    copy = tmp_path / "elsewhere" / "copy.toml"
    copy.parent.mkdir()
    copy.write_text(scenario.text)
    again = sn.load_scenario(copy)
    assert again.text == scenario.text
    assert again.mpc.horizon == 2
    np.testing.assert_array_equal(again.zone.triangles, scenario.zone.triangles)
    np.testing.assert_array_equal(again.path[0].at(2.0), scenario.path[0].at(2.0))


def test_a_robot_file_is_found_beside_the_scenario(full: Path) -> None:
    preset = sn.load_scenario(full).robot_text
    (full.parent / "mine.toml").write_text(preset.replace("hachen2025", "mine"))
    scenario = sn.load_scenario(full, set=['robot.file="mine.toml"'])
    assert scenario.robot.name == "mine"
    assert tomllib.loads(scenario.text)["robot"]["file"] == str(full.parent / "mine.toml")


values = st.recursive(
    st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)


@given(st.dictionaries(st.text(), values, max_size=4))
def test_toml_text_reads_back(table: dict[str, object]) -> None:
    assert tomllib.loads(toml_text(table)) == table


def test_waypoints_stand_still() -> None:
    first, second = waypoints([[0.0, 0.0, 0.1], [0.0, 0.1, 0.1]], max_steps=5)
    assert (first.moving, first.steps(0.1)) == (0.0, 5)
    np.testing.assert_array_equal(second.at(3.0), [0.0, 0.1, 0.1])


def test_a_timed_path_is_followed_and_then_held() -> None:
    (leg,) = timed_path([1.0, 3.0], [[0.0, 0.0, 0.0], [0.2, 0.0, 0.4]], max_steps=7)
    for time, place in ((0.0, [0, 0, 0]), (1.5, [0.05, 0, 0.1]), (9.0, [0.2, 0, 0.4])):
        np.testing.assert_allclose(leg.at(time), place, atol=ROUNDING)
    assert leg.steps(0.1) == 30 + 7  # 3 / 0.1 is above 30 by rounding


def test_a_function_of_time_is_held_at_its_end() -> None:
    (leg,) = follow(lambda time: [0.0, time, 0.1], duration=2.0, max_steps=1)
    np.testing.assert_allclose(leg.at(5.0), [0.0, 2.0, 0.1])
    assert leg.steps(0.5) == 5


@pytest.mark.parametrize(("moving", "steps"), [(-1.0, 5), (np.nan, 5), (0.0, 0), (1.0, -1)])
def test_a_leg_has_an_end(moving: float, steps: int) -> None:
    with pytest.raises(ValueError, match="a leg"):
        Leg(target=lambda _: [0.0, 0.0, 0.0], moving=moving, max_steps=steps)


def test_a_scenario_is_checked_when_it_is_built(full: Path) -> None:
    scenario = sn.load_scenario(full)
    with pytest.raises(ValueError, match="path"):
        sn.Scenario(name="", mpc=scenario.mpc, path=())
    with pytest.raises(ValueError, match="start"):
        sn.Scenario(name="", mpc=scenario.mpc, path=scenario.path, start=np.zeros(3))


BEYOND = (  # whose paths lead into a wall
    *("unreachable", "watchdog", "jointed_teleop", "bad_link"),
    *("live_1khz", "live_jointed", "live_watchdog"),
)


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.stem)
def test_the_examples_may_start(path: Path) -> None:
    scenario = sn.load_scenario(path)
    check_start(scenario)
    places = np.array([leg.at(leg.moving) for leg in scenario.path])
    room = scenario.robot.radii[-1] + scenario.mpc.margin
    assert np.all(scenario.zone.clearance(places) > room) == (path.stem not in BEYOND)


def test_the_unreachable_target_is_40_mm_outside() -> None:
    scenario = sn.load_scenario(EXAMPLES / "unreachable.toml")
    away = -float(scenario.zone.clearance(scenario.path[0].at(0.0)))
    assert away == pytest.approx(0.04, abs=1e-4)  # the file rounds it to a tenth of a millimetre


def test_importing_costs_nothing() -> None:
    code = "import sys, sinuous; sys.exit('numba' in sys.modules or 'numpy' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_every_public_name_is_there() -> None:
    assert {name for name in sn.__all__ if getattr(sn, name) is None} == set()
    assert set(sn.__all__) <= set(dir(sn))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = sn.nothing  # pyright: ignore[reportAttributeAccessIssue]


def test_a_budget_reaches_the_controller() -> None:
    path = EXAMPLES / "free_space.toml"
    assert sn.load_scenario(path).mpc.budget is None
    assert sn.load_scenario(path, set=["mpc.budget_ms=0.3"]).mpc.budget == pytest.approx(3e-4)
    with pytest.raises(sn.InputError, match="budget"):
        sn.load_scenario(path, set=["mpc.budget_ms=0"])
