"""The parts of the tab that need no page: fields that come of what was typed, and poses."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from sinuous.errors import InputError
from sinuous.live import Recipe
from sinuous.view.page.base_handle import Ghost, angles_of, pose_of
from sinuous.view.page.paths import (
    Wanted,
    assignments_for,
    live_scenarios,
    point_in,
    refusal,
    table_of,
)
from sinuous.view.page.registering import hit

ROOT = Path(__file__).parents[3] / "examples"
SCENARIOS, TUBE = ROOT / "scenarios", ROOT / "meshes" / "winding_tube.stl"
WATCHDOG = SCENARIOS / "live_watchdog.toml"
SCENARIO = Recipe(str(WATCHDOG)).make()
NOW = table_of(SCENARIO.text, SCENARIO.file)
SAME = Wanted(
    robot="hachen2025",
    mesh="",
    unit="mm",
    entrance="",
    keep_out="",
    margin=3.0,
    position=(0.0, 0.0, -70.0),
    rotation=(0.0, 0.0, 0.0),
)


def why(wanted: Wanted, folder: Path) -> str:
    fields = assignments_for(wanted, NOW)
    return refusal(SCENARIO.text, SCENARIO.file, fields, folder)


def test_what_there_is_can_be_had_again(tmp_path: Path) -> None:
    assert why(SAME, tmp_path) == ""


def test_a_mesh_of_ones_own_can_be_had_with_its_entrance(tmp_path: Path) -> None:
    own = tmp_path / 'my "tube" in ä.stl'
    own.write_bytes(TUBE.read_bytes())
    assert why(replace(SAME, mesh=str(own), entrance="0 0 0"), tmp_path) == ""


@pytest.mark.parametrize(
    ("wanted", "words"),
    [
        (replace(SAME, robot="nobody.toml"), "nobody.toml"),
        (replace(SAME, mesh="nowhere.stl"), "nowhere.stl"),
        (replace(SAME, mesh=str(TUBE), keep_out="nowhere.ply"), "nowhere.ply"),
        (replace(SAME, entrance="0, 0", mesh=str(TUBE)), "three numbers"),
        (replace(SAME, position=(300.0, 0.0, -70.0)), "live_watchdog.toml: robot.base_position"),
        (replace(SAME, margin=-1.0), "mpc.margin"),
    ],
)
def test_what_cannot_be_is_said(wanted: Wanted, words: str, tmp_path: Path) -> None:
    try:
        told = why(wanted, tmp_path)
    except InputError as error:
        told = str(error)
    assert words in told
    assert str(tmp_path) not in told


def test_another_robot_starts_at_its_own_home(tmp_path: Path) -> None:
    fields = assignments_for(replace(SAME, robot="opencr_v4"), NOW)
    robot = Recipe(str(WATCHDOG), fields).make()
    assert robot.robot.name != SCENARIO.robot.name
    # Lengths are written to a picometre.
    np.testing.assert_allclose(robot.first_configuration, robot.robot.home, atol=1e-8)


def test_a_room_is_given_to_a_scenario_without_one() -> None:
    free = Recipe(str(SCENARIOS / "free_space.toml"), ("mpc.rate_hz=100",)).make()
    wanted = replace(SAME, mesh=str(TUBE), entrance="0, 0, 0")
    fields = assignments_for(wanted, table_of(free.text, free.file))
    there = Recipe(free.file, ("mpc.rate_hz=100", *fields)).make()
    assert len(there.zone.triangles) > 0 == len(free.zone.triangles)


def test_only_scenarios_that_keep_step_are_offered() -> None:
    names = {path.name for path in live_scenarios(SCENARIOS)}
    assert {"live_watchdog.toml", "live_jointed.toml", "live_1khz.toml"} <= names
    assert "free_space.toml" not in names
    for name in names:
        Recipe(str(SCENARIOS / name)).make()


@given(st.tuples(*[st.floats(-1e3, 1e3)] * 3))
def test_a_point_is_read_as_it_is_written(point: tuple[float, float, float]) -> None:
    assert point_in(", ".join(map(repr, point))) == point
    assert point_in(" ".join(map(repr, point))) == point


@pytest.mark.parametrize("text", ["", "1, 2", "1 2 3 4", "1, 2, z", "nan 0 0"])
def test_what_is_no_point_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="three numbers"):
        point_in(text)


@given(
    st.tuples(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5), st.floats(-3.1, 3.1)),
    st.tuples(*[st.floats(-0.3, 0.3)] * 3),
)
def test_angles_and_pose_are_inverses(
    angles: tuple[float, float, float], position: tuple[float, float, float]
) -> None:
    pose = pose_of(np.array(position), np.array(angles))
    np.testing.assert_allclose(angles_of(pose[:3, :3]), angles, atol=1e-6)


def test_angles_are_those_of_the_scenario() -> None:
    recipe = Recipe(str(WATCHDOG), ("robot.base_rotation_deg=[3, -4, 20]", "recover=true"))
    base = recipe.make().robot.T_w_b
    np.testing.assert_allclose(pose_of(base[:3, 3], angles_of(base[:3, :3])), base, atol=1e-12)
    np.testing.assert_allclose(np.rad2deg(angles_of(base[:3, :3])), [3, -4, 20])


def test_the_ghost_is_the_body_that_the_scenario_would_have() -> None:
    ghost, base = Ghost(SCENARIO), SCENARIO.robot.T_w_b
    points = SCENARIO.robot.points(SCENARIO.first_configuration)
    np.testing.assert_allclose(ghost.at(base), points, atol=1e-12)
    there = pose_of(np.array([0.002, 0.001, -0.06]), np.array([0.02, 0.0, 0.3]))
    moved = SCENARIO.robot.at(there)
    points = moved.points(SCENARIO.first_configuration)
    np.testing.assert_allclose(ghost.at(there), points, atol=1e-12)
    least = np.min(SCENARIO.zone.clearance(points) - moved.radii)
    assert ghost.clearance(there) == pytest.approx(least)
    assert ghost.clearance(pose_of(np.array([0.3, 0.0, 0.0]), np.zeros(3))) < 0.0


def test_viser_is_not_loaded_with_the_command_line() -> None:
    code = "import sys, sinuous.cli.main, sinuous.cli.teleop_leaders; print('viser' in sys.modules)"
    program = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert program.stdout == "False\n"


@given(st.integers(0, 10**6))
def test_a_ray_meets_a_sphere_where_it_should(seed: int) -> None:
    """Within what the facets of the sphere leave out, 1 - cos of half their width."""
    sphere = trimesh.creation.icosphere(subdivisions=3, radius=0.05)
    rng = np.random.default_rng(seed)
    origin = 0.2 * (direction := rng.normal(size=3)) / np.linalg.norm(direction)
    place = hit(origin, -origin, np.asarray(sphere.triangles))
    assert place is not None
    np.testing.assert_allclose(place, 0.25 * origin, atol=0.0006)
    assert hit(origin, origin, np.asarray(sphere.triangles)) is None
