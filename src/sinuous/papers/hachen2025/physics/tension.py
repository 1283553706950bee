"""Loss of tension, which section V names as what the model suffers from: failure and cure.

A cable that is slack does nothing while the model counts on it. Here it is bending that slackens
cables, because they run straight from disk to disk, and a pretension too low to make up for it.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.control.tension_estimate import BackboneTensions
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.physics.loop import OFFSET_FREE, at_rest, reachable
from sinuous.papers.hachen2025.physics.tension_figures import draw
from sinuous.papers.hachen2025.runs import held, scenario
from sinuous.papers.physics import nothing, why_not
from sinuous.papers.workers import Workers
from sinuous.recording import Recording
from sinuous.robots.cables import cable_rows
from sinuous.robots.pcc import PccRobot
from sinuous.scenario import Scenario
from sinuous.scenario.plants import Physics

SCENARIO = "physics"
FREE = ("plant.physics.walls=false",)  # nothing but cables
ALONE = "MPC alone"
CONTROLLERS: dict[str, tuple[str, ...]] = {
    ALONE: ("control.local.enabled=false", "control.offset_free.when=never"),
    OFFSET_FREE: ("control.local.enabled=false", "control.offset_free.when=always"),
}
FLOOR = 5.0  # [N]
TAUT = f"control.taut.floor_n={FLOOR}"
BLIND = ("plant.physics.tension_sensors=false", TAUT, "control.taut.estimate=true")
NONE, TOLD, ESTIMATED, MISTAKEN = (
    "none",
    "tensions told",
    "estimated",
    "estimated, loss unknown",
)
CURES: dict[str, tuple[str, ...]] = {NONE: (), TOLD: (TAUT,), ESTIMATED: BLIND, MISTAKEN: BLIND}
KEPT, LOST = 0.3e-3, 0.05e-3  # pretensions [m]: 30 N, as the robot's file says, and 5 N

TARGETS, QUICK_TARGETS = 6, 1
DURATION, QUICK_DURATION = 6.0, 2.0  # of a run [s]

Item = tuple[str, str, float, int, list[float], float]


def run(workers: Workers, quick: bool) -> Data:
    """Every cure, with the pretension kept and lost."""
    if reason := why_not():
        return nothing(reason)
    count, duration = (QUICK_TARGETS, QUICK_DURATION) if quick else (TARGETS, DURATION)
    targets = reachable(scenario(SCENARIO), count)
    items: list[Item] = [
        (name, cure, pretension, k, target.tolist(), duration)
        for name in ((ALONE,) if quick else CONTROLLERS)
        for pretension in ((LOST,) if quick else (KEPT, LOST))
        for cure in CURES
        if not (cure == MISTAKEN and pretension == KEPT)
        for k, target in enumerate(targets)
    ]
    return {
        "missing": "",
        "floor_n": FLOOR,
        "targets_m": targets.tolist(),
        "rows": workers.map("loss of tension", respond, items),
    }


def respond(item: Item) -> dict[str, Any]:
    """One run."""
    name, cure, pretension, number, target, duration = item
    base = scenario(SCENARIO, *FREE, *CONTROLLERS[name], *CURES[cure])
    base = pretensioned(base, pretension, known=cure != MISTAKEN)
    recording = held(base, np.array(target), duration, number)
    last = recording.time > duration - 1.0
    slack = np.any(recording.tensions <= 0.0, axis=1)
    return {
        "controller": name,
        "cure": cure,
        "pretension_m": pretension,
        "target": number,
        **at_rest(recording, duration),
        "body_error_at_rest_m": float(np.mean(body_error(recording)[last])),
        "slack_at_rest_fraction": float(np.mean(slack[last])),
        "slack_fraction": float(np.mean(slack)),
        "largest_tension_n": float(np.max(recording.tensions[last])),
        "estimate_error_n": float(np.sqrt(np.mean(estimate_error(base, recording) ** 2))),
        "least_tension_n": np.min(recording.tensions, axis=1).round(3).tolist(),
        "time_s": recording.time.tolist(),
    }


def pretensioned(base: Scenario, pretension: float, *, known: bool) -> Scenario:
    """The scenario with another pretension [m], which the controller knows of or not."""
    robot, physics = base.robot, base.plant
    assert isinstance(robot, PccRobot)
    assert isinstance(physics, Physics)
    cables = replace(robot.mechanics.cables, pretension=pretension)
    other = replace(robot, mechanics=replace(robot.mechanics, cables=cables))
    mpc = replace(base.mpc, robot=other) if known else base.mpc
    return replace(base, mpc=mpc, plant=replace(physics, robot=other))


def body_error(recording: Recording) -> Array:
    """Largest distance (K,) [m] of a point of the real body from where the model has it."""
    apart = np.linalg.norm(recording.actual_points - recording.nominal_points, axis=2)
    return np.max(apart, axis=1)


def estimate_error(base: Scenario, recording: Recording) -> Array:
    """Estimated less true tensions (C,) [N] at the end of a run."""
    robot, c = base.robot, recording.configuration[-1]
    assert isinstance(robot, PccRobot)
    shift = (robot.lengths(c) - recording.measured_lengths[-1])[cable_rows(robot)]
    return BackboneTensions(robot=robot)(c, shift) - recording.tensions[-1]


TENSION = Experiment(
    name="tension",
    title="Loss of tension: failure and cure",
    section="V",
    run=run,
    draw=draw,
)
