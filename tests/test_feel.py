"""The hand goes 30 mm beyond a flat wall: the margin is kept, the wall is felt, one delay later."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from sinuous.arrays import Array
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.recording import Recording
from sinuous.scenario import Scenario, load_scenario
from sinuous.scenario.path import timed_path
from sinuous.session.runner import run

LIVE = Path(__file__).parents[1] / "examples" / "scenarios" / "live_watchdog.toml"
DELAY = 100  # one way, in ticks of 1 ms
CLOSE, PUSH, HOLD = 1.2, 3.0, 4.5  # ends of parts: beside the wall, 30 mm beyond, all at rest [s]
SPRING = 80.0  # [N/m]
ROUNDING = 1e-12

BACKWARD = 1e-3
"""Largest step back of a force that rises to half a newton [N]: the plane is renewed every 10 ms
while the tip still gives way by micrometres."""

CREEP = 1e-3  # what the force at rest is off the spring's [N]: the plan creeps by micrometres
LOADED = 200  # ticks until the spring of a new wall has all its force
MARGIN_ROUNDING = 1e-9  # [m]


@cache
def scene() -> Scenario:
    """The robot of the watchdog in a box, and a rigid hand."""
    scenario = load_scenario(
        LIVE,
        set=(
            f"teleop.delay_ms={DELAY}",
            "teleop.operator.kind='trajectory'",
            f"teleop.force.stiffness_n_m={SPRING}",
        ),
    )
    box = shapes.box((0.24, 0.24, 0.2), centre=(0.0, 0.0, 0.1))
    mpc = replace(scenario.mpc, zone=SafeZone.from_mesh(box, entrance=[0.0, 0.0, 0.0]))
    start = mpc.robot.tip(scenario.first_configuration)
    close, beyond = np.array([stop() - 0.003, 0.0, 0.07]), np.array([stop() + 0.03, 0.0, 0.07])
    path = timed_path(
        [0.0, 0.8, CLOSE, PUSH, HOLD], [start, close, close, beyond, beyond], max_steps=1
    )
    assert scenario.teleop is not None
    return replace(scenario, mpc=mpc, path=path, teleop=replace(scenario.teleop, mpc=mpc))


def stop() -> float:
    """Where the wall stops the tip [m]."""
    scenario = load_scenario(LIVE)
    return 0.12 - float(scenario.robot.required_distance(scenario.mpc.margin)[-1])


@cache
def pushed(stiffness: float = SPRING) -> Recording:
    """What happens."""
    scenario = scene()
    assert scenario.teleop is not None
    table = scenario.teleop.table
    teleop = replace(
        scenario.teleop, table=replace(table, force=replace(table.force, stiffness=stiffness))
    )
    return run(replace(scenario, teleop=teleop)).recording


def ticks(first: float, last: float) -> slice:
    return slice(round(1e3 * first), round(1e3 * last))


def along(signal: str) -> Array:
    return pushed().signal(signal)[:, 0]


def test_the_hand_is_beyond_and_the_body_keeps_its_margin() -> None:
    scenario, recording = scene(), pushed()
    assert scenario.teleop is not None
    hand = along("sent_m") + scenario.teleop.mapping.origin[0]
    assert hand.max() - stop() > 0.0299
    assert recording.nominal_clearance.min() >= scenario.mpc.margin - MARGIN_ROUNDING


def test_the_force_rises_with_the_depth_to_that_of_the_spring() -> None:
    force = along("virtual_n")
    assert not np.any(force[ticks(0.0, CLOSE)])  # no drag on the way
    rising = force[ticks(CLOSE, PUSH)]
    assert -np.diff(rising).min() < BACKWARD
    assert rising[-1] > 0.4
    depth = along("desired_m") - along("tip_m")
    assert abs(force[-1] - SPRING * depth[-1]) < CREEP


def test_it_is_felt_one_delay_later_and_not_before() -> None:
    """What the hand feels differs from what it feels without the force, from one delay on."""
    far = np.flatnonzero(along("virtual_n") > ROUNDING)[0]
    difference = along("felt_n") - pushed(0.0).signal("felt_n")[:, 0]
    assert np.flatnonzero(np.abs(difference) > ROUNDING)[0] == far + DELAY


def test_the_channel_makes_no_energy_and_the_wall_no_more_than_it_is_late() -> None:
    """A wall that the lagging tip meets when the desired point is beyond it is a loaded spring."""
    recording = pushed()
    assert recording.signal("channel_j").min() >= -ROUNDING
    first = np.flatnonzero(along("virtual_n") > ROUNDING)[0]
    lag = (along("desired_m") - along("tip_m"))[first : first + LOADED].max()
    assert 0.0 > recording.signal("follower_j").min() >= -0.5 * SPRING * lag**2
    assert recording.signal("follower_j")[-1] > 0.0
