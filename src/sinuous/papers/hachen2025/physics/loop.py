"""Many targets on physics: where the real tip rests, whatever the model does not know."""

from typing import Any, cast

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.gains import DLS_PRINTED
from sinuous.papers.hachen2025.physics.loop_figures import draw
from sinuous.papers.hachen2025.runs import held, sampled_configurations, scenario
from sinuous.papers.physics import nothing, why_not
from sinuous.papers.workers import Workers
from sinuous.plants.sensors import TipTracker
from sinuous.recording import Recording
from sinuous.scenario import Scenario
from sinuous.summary import summarise, tip_error

SCENARIO = "physics"
OFFSET_FREE, DLS = "MPC offset-free", "DLS, printed gains"
CONTROLLERS: dict[str, tuple[str, ...]] = {
    OFFSET_FREE: ("control.local.enabled=false",),
    "MPC + local": ("control.offset_free.when=never",),
    DLS: DLS_PRINTED,
}
"""What is changed in the scenario for each."""

NOISE, BIAS = "noise", "noise and bias"
SENSORS: dict[str, tuple[str, ...]] = {
    NOISE: (),
    BIAS: (f"sensor.bias_mm={TipTracker.printed().accuracy.bias * 1e3}",),
}
BIASED = (OFFSET_FREE,)  # a bias does the same to all: one shows it

TARGETS, QUICK_TARGETS, SEED = 50, 3, 2026
DURATION, QUICK_DURATION = 6.0, 2.0  # of a run [s]
DLS_DURATION = 10.0  # DLS takes as long: an error of 40 mm falls by 5 % in a step
REST = 1.0  # its end, over which errors are averaged [s]
DRAWN = 2000  # configurations, of which about one in fourteen keeps the margin

Item = tuple[str, str, int, list[float], float]


def run(workers: Workers, quick: bool) -> Data:
    """Every controller at every target."""
    if reason := why_not():
        return nothing(reason)
    targets = reachable(scenario(SCENARIO), QUICK_TARGETS if quick else TARGETS)
    items: list[Item] = [
        (name, sensor, k, target.tolist(), _time(name, quick=quick))
        for k, target in enumerate(targets)
        for sensor in SENSORS
        for name in (CONTROLLERS if sensor == NOISE else BIASED)
    ]
    return {
        "missing": "",
        "scenario": SCENARIO,
        "targets_m": targets.tolist(),
        "rest_s": REST,
        "rows": workers.map("targets on physics", respond, items),
    }


def _time(controller: str, *, quick: bool) -> float:
    """Of a run [s]."""
    if quick:
        return QUICK_DURATION
    return DLS_DURATION if controller == DLS else DURATION


def reachable(base: Scenario, count: int) -> Array:
    """Tips (count, 3) [m] of random configurations that keep limits and margin."""
    robot = base.robot
    shapes = robot.points(sampled_configurations(robot, DRAWN, SEED))
    room = base.zone.clearance(shapes) - robot.required_distance(base.mpc.margin)
    found = shapes[np.all(room >= 0.0, axis=1), -1]
    assert len(found) >= count
    return found[:count]


def respond(item: Item) -> dict[str, Any]:
    """One controller at one target."""
    name, sensor, number, target, duration = item
    base = scenario(SCENARIO, *CONTROLLERS[name], *SENSORS[sensor])
    recording = held(base, np.array(target), duration, number)
    return {
        "controller": name,
        "sensor": sensor,
        "target": number,
        "margin_m": base.mpc.margin,
        **at_rest(recording, duration),
        **touched(recording),
        "curve": curve(recording) if number == 0 else None,
    }


def at_rest(recording: Recording, duration: float) -> dict[str, float]:
    """Means over the end of a run that was to last a duration [s]."""
    last = recording.time > duration - REST
    return {
        "tip_error_at_rest_m": float(
            np.mean(tip_error(recording.actual_tip[last], recording.target[last]))
        ),
        "tip_from_model_at_rest_m": float(
            np.mean(tip_error(recording.actual_tip[last], recording.nominal_tip[last]))
        ),
        "least_tension_at_rest_n": float(np.min(recording.tensions[last])),
    }


def touched(recording: Recording) -> dict[str, Any]:
    """Walls and cables, over a whole run."""
    summary = summarise(recording)
    physics = cast(dict[str, Any], summary["physics"])
    return {
        "least_nominal_clearance_m": summary["min_clearance_nominal_m"],
        "least_actual_clearance_m": summary["min_clearance_actual_m"],
        **physics,
    }


def curve(recording: Recording) -> dict[str, Any]:
    """The error over time [m], for a figure."""
    error = tip_error(recording.actual_tip, recording.target)
    return {"time_s": recording.time.tolist(), "real_m": error.round(7).tolist()}


PHYSICS = Experiment(
    name="physics",
    title="Many targets on physics",
    section="III-C, IV",
    run=run,
    draw=draw,
)
