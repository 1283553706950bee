"""4 again, on physics: both sets with an arm that weighs, beside the arm that is its model.

As in the experiment only the motors have encoders, so where the tip is, the follower's end takes
from the cables by forward kinematics: it does not see what weight and stretch do to it.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from sinuous.measurement import Measurement
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.physics import nothing, why_not
from sinuous.papers.qin2020.physics.figures import draw
from sinuous.papers.qin2020.runs import BOUNDARY, inverse
from sinuous.papers.qin2020.sets.experiment import (
    CONTACT,
    IMPEDANCE,
    QUICK_TIME,
    SCHEMES,
    SETS,
    chain,
    judged,
)
from sinuous.papers.qin2020.sets.signals import AXES
from sinuous.papers.workers import Workers
from sinuous.plants.plant import Plant, Truth
from sinuous.plants.sensors import Sensor, Timing
from sinuous.recording import Recording
from sinuous.robots.jointed import JointedRobot
from sinuous.scenario import Scenario
from sinuous.scenario.plants import Physics
from sinuous.session import run as run_session
from sinuous.summary import tip_error

MODEL, PHYSICS, PLAY = "its model", "physics", "physics, 0.2 mm of play"
PLANTS = (MODEL, PHYSICS, PLAY)
SLACKNESS = 0.2e-3  # play of every cable [m], representative of a worn transmission
ON_PHYSICS = ("plant.encoder_step_mm=0", "plant.physics.walls=false")  # there is no mesh

Item = tuple[str, str, str, bool]


def run(workers: Workers, quick: bool) -> Data:
    """Every set with every plant, C1 without play, and not at all if it must be quick."""
    if reason := why_not():
        return nothing(reason)
    schemes = ("C2",) if quick else tuple(SCHEMES)
    items: list[Item] = [
        (name, scheme, plant, quick)
        for name in SETS
        for scheme in schemes
        for plant in PLANTS
        if not (scheme == "C1" and plant == PLAY)
    ]
    return {
        "missing": "",
        "boundary_m": BOUNDARY,
        "axes": AXES,
        "rows": workers.map("sets of the experiment, on physics", drive, items),
    }


def drive(item: Item) -> dict[str, Any]:
    """One run."""
    name, scheme, plant, quick = item
    seconds = QUICK_TIME if quick else None
    changes = () if plant == MODEL else ON_PHYSICS
    found = chain(name, scheme, IMPEDANCE, *changes, seconds=seconds)
    if plant != MODEL:
        found = with_play(found, SLACKNESS if plant == PLAY else 0.0)
    done = run_session(found)
    row = judged((name, scheme, IMPEDANCE, quick), found, done)
    return {
        "plant": plant,
        **row,
        **unseen(done.recording, touching=name == CONTACT),
        **(done.summary["physics"] or {}),
    }


def with_play(found: Scenario, play: float) -> Scenario:
    """The scenario with encoders only, and a robot whose cables have play [m]."""
    robot, physics = found.robot, found.plant
    assert isinstance(robot, JointedRobot)
    assert isinstance(physics, Physics)
    cables = replace(robot.mechanics.cables, play=play)
    slack = replace(robot, mechanics=replace(robot.mechanics, cables=cables))
    return replace(found, plant=replace(physics, robot=slack), sensor=encoders)


def encoders(plant: Plant, _: int) -> Sensor:
    """A plant of which only the motors are seen: its shape is that of the model."""
    robot = inverse().robot

    def read(truth: Truth) -> Measurement:
        points = robot.points(robot.configuration(truth.lengths))
        return Measurement(points=points, tip=points[-1], lengths=truth.lengths)

    return Sensor(plant, read, timing=Timing())


def unseen(recording: Recording, *, touching: bool) -> dict[str, Any]:
    """Where the real tip is [m]: from its desired place, and from where encoders see it."""
    off = tip_error(recording.actual_tip, recording.measured_tip)
    error = tip_error(recording.actual_tip, recording.target)
    sides = np.abs(recording.actual_tip[:, [0, 2]])
    return {
        "tip_unseen_rms_m": float(np.sqrt(np.mean(off**2))),
        "tip_unseen_largest_m": float(np.max(off)),
        "real_tracking_rms_m": float(np.sqrt(np.mean(error**2))),
        "real_tracking_largest_m": float(np.max(error)),
        "real_beyond_boundary_m": float(np.max(sides)) - BOUNDARY if touching else None,
        "sample_s": recording.time.tolist(),
        "unseen_m": off.round(7).tolist(),
        "real_error_m": error.round(7).tolist(),
    }


SETS_ON_PHYSICS = Experiment(
    name="sets_physics",
    title="Set 1 and Set 2 on physics",
    section="4",
    run=run,
    draw=draw,
)
