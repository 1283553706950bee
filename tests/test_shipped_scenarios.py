"""The scenarios that come with the project do what the README says of them."""

from pathlib import Path

import numpy as np
import pytest

import sinuous as sn

SCENARIOS = Path(__file__).parents[1] / "examples" / "scenarios"
STEADY = 1e-5  # tip error at rest [m]
ROUNDING = 1e-9  # of a rate, in units of its limit


def worst_rate(recording: sn.Recording) -> float:
    """Largest actuator rate in units of its limit."""
    return float(np.max(np.abs(recording.rates) / recording.header.rate_limits[:, 1]))


REACHED = ("free_space", "winding_tube", "inverted_u", "narrow_hole", "jointed_vessel")


@pytest.mark.parametrize("name", REACHED)
def test_every_way_point_is_reached_without_touching_anything(name: str) -> None:
    scenario = sn.load_scenario(SCENARIOS / f"{name}.toml")
    run = sn.run(scenario)
    assert run.summary["margin_violations"] == 0
    assert run.summary["solver_failures"] == 0
    assert worst_rate(run.recording) <= 1.0 + ROUNDING
    robot, configurations = scenario.robot, run.recording.configuration
    assert robot.bend_slack(configurations).min() >= -1e-12
    error = np.linalg.norm(run.recording.nominal_tip - run.recording.target, axis=1)
    arrived = np.flatnonzero(np.any(np.diff(run.recording.target, axis=0) != 0.0, axis=1))
    assert len(arrived) == len(scenario.path) - 1
    assert np.all(error[[*arrived, -1]] < STEADY)


def test_a_target_outside_is_waited_for_at_the_margin() -> None:
    scenario = sn.load_scenario(SCENARIOS / "unreachable.toml", set=["path.max_steps=200"])
    run = sn.run(scenario)
    margin = scenario.mpc.margin
    assert run.summary["margin_violations"] == 0
    assert margin <= run.recording.nominal_clearance[-1] < margin + 3e-4
    tip = run.recording.nominal_tip[-30:]
    assert np.max(np.ptp(tip, axis=0)) < 1e-4  # no jitter


@pytest.mark.parametrize(
    ("cables", "deep", "failures"),
    [("40.4, 42.8, 42.8", 0.004, 0), ("38, 44, 44", 0.03, 5)],
    ids=["4 mm", "far"],
)
def test_a_start_outside_the_mesh_recovers_when_it_may(
    cables: str, deep: float, failures: int
) -> None:
    # Bent until the centre line is outside; slow motors, so that the way back takes a while.
    # Far outside, where nearly every plane is violated, the solver may give a few steps up:
    # the robot holds still for them and goes on.
    bent = f"robot.start_lengths_mm=[{cables}, 42, 42, 42, 42, 42, 42, 42, 42, 42]"
    settings = [bent, 'robot.limits="hardware"', "path.max_steps=70"]
    path = SCENARIOS / "winding_tube.toml"
    outside = sn.load_scenario(path, set=settings)
    depth = -outside.zone.clearance(outside.robot.points(outside.first_configuration)).min()
    assert depth > deep
    with pytest.raises(sn.InputError, match="recover = true"):
        sn.run(outside)
    run = sn.run(sn.load_scenario(path, set=[*settings, "recover=true"]))
    assert run.recording.status[0] == "recovering"
    assert run.summary["solver_failures"] <= failures
    assert worst_rate(run.recording) <= 1.0 + ROUNDING
    assert np.all(np.diff(run.recording.nominal_clearance[:4]) > 0.0)
    assert run.recording.nominal_clearance[-1] >= outside.mpc.margin
