"""The loop: the same from its seed, way-point by way-point, and a defined end whatever happens."""

import json
import os
import signal
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest

import sinuous as sn
from sinuous.plants.kinematic import KinematicPlant
from sinuous.plants.plant import Measurement
from sinuous.scenario.start import check_start
from sinuous.session import REST_STEPS, End, Rest, Result
from sinuous.session.folder import RunFolder
from sinuous.session.surface import SPACING, SurfaceClearance
from sinuous.summary import violates_margin

DT = 1.0 / 30.0
ROBOT = """\
name = "arm"
[[segment]]
length_mm = [80, 120]
disks = 10
cable_angles_deg = [0, 120, 240]
pitch_radius_mm = 6
body_radius_mm = 8
disk_thickness_mm = 2
min_bend_radius_mm = 40
[limits.simulation]
cable_speed_mm_s = 40
backbone_speed_mm_s = 40
cable_length_mm = [60, 140]
"""
SEEN = 5e-4  # [m] by which a test's target leaves no doubt which one was meant
EXACT = 1e-12  # [m] rounding of the same sum done twice
STEP = np.array([[1.0, 0.0, 0.0]])


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> sn.PccRobot:
    """One segment: the smallest robot there is."""
    path = tmp_path_factory.mktemp("robot") / "robot.toml"
    path.write_text(ROBOT)
    return sn.load_robot(path)


@pytest.fixture(scope="module")
def tube() -> sn.SafeZone:
    """A straight tube of 20 mm radius around z."""
    mesh = sn.shapes.tube([[0.0, 0.0, -0.05], [0.0, 0.0, 0.2]], 0.02, sections=48)
    return sn.SafeZone.from_mesh(mesh, name="tube")


@pytest.fixture(scope="module")
def scenario(robot: sn.PccRobot, tube: sn.SafeZone) -> sn.Scenario:
    """Two way-points in the tube, with noise."""
    mpc = sn.ShapeConstrainedMPC(robot, tube, margin=0.003, dt=DT, horizon=2)
    return sn.Scenario(
        name="tube",
        mpc=mpc,
        path=sn.waypoints([[0.002, 0.0, 0.105], [0.0, 0.002, 0.095]], max_steps=60),
        seed=3,
        disturbance=sn.Disturbance(length_std=1e-4, point_std=1e-4),
    )


@pytest.fixture(scope="module")
def result(scenario: sn.Scenario, tmp_path_factory: pytest.TempPathFactory) -> Result:
    return sn.run(scenario, out=tmp_path_factory.mktemp("out"))


def same(a: object, b: object) -> bool:
    return np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b


def test_a_run_repeats_bit_for_bit_but_for_the_time_it_takes(
    scenario: sn.Scenario, tmp_path: Path
) -> None:
    runs = list[sn.Recording]()
    for name in ("a", "b"):
        made = sn.run(scenario, out=tmp_path / name).recording
        read = sn.read_recording(tmp_path / name / "run.mcap")
        assert read.complete
        for field in fields(made):
            if field.name != "header":
                assert same(getattr(made, field.name), getattr(read, field.name)), field.name
        runs.append(read)
    a, b = runs
    for field in fields(a):
        if field.name not in ("header", "solve_time"):
            assert same(getattr(a, field.name), getattr(b, field.name)), field.name
    for field in fields(a.header):
        assert same(getattr(a.header, field.name), getattr(b.header, field.name)), field.name


def test_another_seed_is_another_run_of_the_same_nominal_robot(
    scenario: sn.Scenario, result: Result
) -> None:
    other = sn.run(replace(scenario, seed=4)).recording
    np.testing.assert_array_equal(other.configuration, result.recording.configuration)
    assert not np.array_equal(other.measured_tip, result.recording.measured_tip)


def test_a_waypoint_is_held_until_the_body_rests(scenario: sn.Scenario, result: Result) -> None:
    run = result.recording
    assert result.end is End.FINISHED
    np.testing.assert_allclose(run.time, np.arange(1, len(run) + 1) * DT, rtol=0, atol=EXACT)
    switch = int(np.flatnonzero(np.any(np.diff(run.target, axis=0) != 0.0, axis=1))[0])
    for last, leg in ((switch, scenario.path[0]), (len(run) - 1, scenario.path[1])):
        np.testing.assert_array_equal(run.target[last], leg.at(0.0))
        moved = np.linalg.norm(np.diff(run.nominal_points[: last + 1], axis=0), axis=2).max(axis=1)
        rested = moved[-REST_STEPS:] < 1e-4 * DT
        assert np.all(rested) or last + 1 in (60, switch + 61)


def test_a_waypoint_ends_after_its_steps(scenario: sn.Scenario) -> None:
    path = sn.waypoints([[0.0, 0.0, 0.2], [0.0, 0.0, 0.1]], max_steps=3)
    run = sn.run(replace(scenario, path=path)).recording
    np.testing.assert_array_equal(run.target[:, 2], [0.2, 0.2, 0.2, 0.1, 0.1, 0.1])


def test_a_target_may_be_a_function_of_time(scenario: sn.Scenario) -> None:
    path = sn.follow(lambda t: [0.003 * np.sin(3 * t), 0.0, 0.1], duration=20 * DT, max_steps=2)
    run = sn.run(replace(scenario, path=path)).recording
    assert len(run) == 22
    held = np.minimum(run.time, 20 * DT)
    np.testing.assert_allclose(run.target[:, 0], 0.003 * np.sin(3 * held), atol=EXACT)
    error = np.linalg.norm(run.nominal_tip - run.target, axis=1)
    assert np.all(error[3:] < SEEN)


def test_rest_takes_ten_quiet_steps_in_a_row() -> None:
    rest, x, ends = Rest(DT), np.zeros((2, 3)), list[bool]()
    for moved in (*[0.0] * 5, 1e-4, *[1e-6] * 12):  # 0.1 mm/s is 3.3e-6 m a step
        x = x + moved * STEP
        ends.append(rest.after(x))
    assert ends == [False] * 15 + [True] * 3


def test_the_folder_holds_recording_and_summary(scenario: sn.Scenario, tmp_path: Path) -> None:
    result = sn.run(scenario, out=tmp_path / "deep" / "run")
    names = sorted(path.name for path in (tmp_path / "deep" / "run").iterdir())
    assert names == ["run.mcap", "summary.json"]
    stored = json.loads((tmp_path / "deep" / "run" / "summary.json").read_text())
    assert stored == result.summary
    assert stored["seed"] == 3
    assert stored["margin_violations"] == 0
    assert stored["solver_failures"] == 0
    assert stored["real_time_factor"] > 0.0
    assert stored["min_clearance_nominal_m"] == result.recording.nominal_clearance.min()
    assert {"python", "numpy", "sinuous"} <= stored["versions"].keys()


def test_an_earlier_run_is_overwritten_and_nothing_else_is(
    scenario: sn.Scenario, tmp_path: Path
) -> None:
    short = replace(scenario, path=sn.waypoints([[0.0, 0.0, 0.1]], max_steps=2))
    sn.run(scenario, out=tmp_path)
    (tmp_path / "figures").mkdir()
    (tmp_path / "figures" / "shapes.png").touch()
    (tmp_path / "notes.txt").touch()
    sn.run(short, out=tmp_path)
    assert len(sn.read_recording(tmp_path / "run.mcap")) == 2
    assert sorted(p.name for p in tmp_path.rglob("*") if p.is_file()) == [
        "notes.txt",
        "run.mcap",
        "summary.json",
    ]
    (tmp_path / "run.mcap").unlink()
    with pytest.raises(sn.InputError, match=r"notes\.txt"):
        RunFolder.prepare(tmp_path)


def test_violations_count_between_steps_too(scenario: sn.Scenario) -> None:
    """A body that swings through a wall and back within one step is caught on its way."""
    robot = scenario.robot
    before, after = robot.home.copy(), robot.home.copy()
    before[0], after[0] = 0.4, -0.4  # it nods to both sides; in the middle it is straight
    ball = sn.shapes.sphere(0.005, centre=[0.0, 0.0, 0.1145])
    free = sn.SafeZone.unbounded().minus(ball, name="ball")
    judge = SurfaceClearance.of(robot, free)
    ends = [float(np.min(free.clearance(robot.points(c)) - robot.radii)) for c in (before, after)]
    assert judge.least(before, after) < min(ends) - SEEN


def test_the_surface_is_judged_exactly(scenario: sn.Scenario) -> None:
    """Leaving out points that cannot be the closest changes nothing."""
    robot, zone = scenario.robot, scenario.zone
    judge = SurfaceClearance.of(robot, zone)
    fine = judge.robot
    rng = np.random.default_rng(0)
    for _ in range(20):
        a, b = robot.home + rng.normal(0.0, [0.2, 0.2, 0.005], (2, 3))
        shapes = a + np.linspace(0.2, 1.0, 5)[:, None] * (b - a)
        clearance = zone.clearance(fine.points(shapes)) - fine.radii
        assert judge.least(a, b) == clearance[:, fine.movable].min()
    arcs = np.linalg.norm(np.diff(fine.points(robot.home), axis=0), axis=1)
    assert np.all(arcs <= SPACING)


def test_a_start_beyond_the_margin_is_refused_unless_it_may_recover(
    scenario: sn.Scenario, robot: sn.PccRobot
) -> None:
    base = np.eye(4)
    base[0, 3] = 0.011  # the body is 1 mm from the wall, the margin 3 mm
    mpc = replace(scenario.mpc, robot=robot.at(base))
    near = replace(scenario, mpc=mpc, disturbance=None)
    with pytest.raises(sn.InputError, match=r"mm from triangle \d+ of tube.*recover = true"):
        sn.run(near)
    run = sn.run(replace(near, recover=True)).recording
    assert run.status[0] == "recovering"
    assert violates_margin(run)[0]
    assert run.nominal_clearance[-1] > run.nominal_clearance[0]
    limits = robot.rate_limits * (1.0 + EXACT)
    assert np.all((run.rates >= limits[:, 0]) & (run.rates <= limits[:, 1]))


def test_a_start_outside_is_refused(scenario: sn.Scenario, robot: sn.PccRobot) -> None:
    base = np.eye(4)
    base[0, 3] = 0.014
    outside = replace(scenario, mpc=replace(scenario.mpc, robot=robot.at(base)))
    with pytest.raises(sn.InputError, match=r"mm beyond triangle \d+ of tube"):
        check_start(outside)


def test_recover_does_not_mind_a_good_start(scenario: sn.Scenario) -> None:
    check_start(replace(scenario, recover=True))


def test_ctrl_c_keeps_what_ran(scenario: sn.Scenario, tmp_path: Path) -> None:
    seen = list[sn.Sample]()

    def observe(sample: sn.Sample) -> None:
        seen.append(sample)
        if len(seen) == 5:
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    result = sn.run(scenario, out=tmp_path, observe=observe)
    assert result.end is End.INTERRUPTED
    assert len(result.recording) == len(sn.read_recording(tmp_path / "run.mcap")) == 5
    assert (tmp_path / "summary.json").is_file()
    assert signal.getsignal(signal.SIGINT) is before


def test_an_impatient_ctrl_c_keeps_what_ran(scenario: sn.Scenario, tmp_path: Path) -> None:
    def observe(sample: sn.Sample) -> None:
        if sample.time > 4.5 * DT:
            os.kill(os.getpid(), signal.SIGINT)
            os.kill(os.getpid(), signal.SIGINT)

    result = sn.run(scenario, out=tmp_path, observe=observe)
    assert result.end is End.INTERRUPTED
    assert len(result.recording) == len(sn.read_recording(tmp_path / "run.mcap")) == 5


class BrokenPlant(KinematicPlant):
    """A plant that loses its mind after some steps."""

    left = 5

    def step(self, rates: np.ndarray, dt: float) -> Measurement:
        measured = super().step(rates, dt)
        self.left -= 1
        return replace(measured, tip=measured.tip * np.nan) if self.left < 0 else measured


def test_a_plant_that_fails_ends_the_run(scenario: sn.Scenario, tmp_path: Path) -> None:
    broken = replace(scenario, plant=lambda: BrokenPlant(scenario.robot, seed=0))
    result = sn.run(broken, out=tmp_path)
    assert result.end is End.PLANT_FAILED
    recording = sn.read_recording(tmp_path / "run.mcap")
    assert recording.complete
    assert len(recording) == 5
    assert (tmp_path / "summary.json").is_file()


def test_reach_says_what_stops_it(scenario: sn.Scenario) -> None:
    there = sn.reaches(scenario, [0.002, 0.0, 0.105])
    assert there.reached
    assert there.obstacles == ()

    outside = sn.reaches(scenario, [0.06, 0.0, 0.1])
    assert not outside.reached
    assert "the target is 40 mm outside the zone" in outside.obstacles[0]
    assert any("of tube" in what and "a wall around (" in what for what in outside.obstacles)

    far = sn.reaches(scenario, [0.0, 0.0, 0.13])
    assert far.distance == pytest.approx(0.01, abs=SEEN)
    assert any("backbone" in what for what in far.obstacles)

    hurried = sn.reaches(scenario, [0.0, 0.0, 0.11], max_steps=2)
    assert "still moving after 2 steps" in hurried.obstacles
    with pytest.raises(ValueError, match="one step"):
        sn.reaches(scenario, [0.0, 0.0, 0.1], max_steps=0)
