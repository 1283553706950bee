"""III-C: step responses under the printed disturbance, every controller, many targets."""

from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.convergence.figures import draw
from sinuous.papers.hachen2025.gains import DLS_BEST, DLS_PRINTED
from sinuous.papers.hachen2025.runs import held, sampled_targets, scenario
from sinuous.papers.workers import Workers
from sinuous.plants.kinematic import KinematicPlant
from sinuous.recording import Recording
from sinuous.scenario import Scenario
from sinuous.summary import tip_error

SCENARIO = "convergence"
CONTROLLERS: dict[str, tuple[str, ...]] = {
    "DLS, printed gains": DLS_PRINTED,
    "DLS, best gains": DLS_BEST,
    "MPC alone": (),
    "MPC + local": ("control.local.enabled=true", "control.offset_free.when=never"),
    "MPC offset-free": ("control.local.enabled=false", "control.offset_free.when=always"),
    "MPC + local, offset-free": ("control.offset_free.when=always",),
}
"""What is changed in the scenario for each."""

TARGETS, DURATION, REST = 50, 10.0, 5.0  # how many, time of a run and of its end [s]
QUICK_TARGETS, QUICK_DURATION, QUICK_REST = 2, 6.0, 2.0
SEED = 2025  # of the targets; run k has the disturbances of seed k
SHOWN_DISTANCE = 0.040  # of the printed figures' target from where the tip starts [m]

# A run has settled once only this share of the way is left, over the time of two draws [s].
LEFT, WINDOW = 0.1, 0.4
# Draws of the disturbance at a target, to know how far it alone puts a robot off.
DRAWS = 200

Item = tuple[str, int, list[float], float, float, bool]


def run(workers: Workers, quick: bool) -> Data:
    """Every controller at every target."""
    count = QUICK_TARGETS if quick else TARGETS
    duration, rest = (QUICK_DURATION, QUICK_REST) if quick else (DURATION, REST)
    robot = scenario(SCENARIO).robot
    targets = sampled_targets(robot, count, SEED)
    away = np.linalg.norm(targets - robot.tip(robot.home), axis=1)
    shown = int(np.argmin(np.abs(away - SHOWN_DISTANCE)))
    items: list[Item] = [
        (name, k, target.tolist(), duration, rest, k == shown)
        for k, target in enumerate(targets)
        for name in CONTROLLERS
    ]
    rows = workers.map("step responses under disturbance", respond, items)
    return {
        "scenario": SCENARIO,
        "targets_m": targets.tolist(),
        "distance_m": away.tolist(),
        "duration_s": duration,
        "rest_s": rest,
        "shown": shown,
        "rows": rows,
    }


def respond(item: Item) -> dict[str, Any]:
    """One controller at one target."""
    name, seed, target, duration, rest, shown = item
    base = scenario(SCENARIO, *CONTROLLERS[name])
    recording = held(base, np.array(target), duration, seed)
    curves = response(recording)
    last = recording.time > duration - rest
    error = curves["real_m"]
    at_rest = float(np.mean(error[last]))
    return {
        "controller": name,
        "target": seed,
        "tip_error_at_rest_m": at_rest,
        "tip_error_from_disturbance_m": float(np.mean(undone(base, recording, seed))),
        "nominal_error_final_m": float(curves["nominal_m"][-1]) if "MPC" in name else None,
        "local_error_at_rest_m": float(np.mean(curves["local_m"][last])),
        "body_error_at_rest_m": float(np.mean(curves["body_m"][last])),
        "settling_time_s": settling_time(error, recording.header.dt, at_rest),
        "local_error_before_draws_m": float(np.mean(before_draws(base, curves["local_m"])[1:])),
        "approach_linearity": linearity(curves["nominal_m"]) if "MPC" in name else None,
        "clipped_fraction": float(np.mean(recording.clipped > 1e-3)),
        "curves": {key: value.tolist() for key, value in curves.items()} if shown else None,
    }


def response(recording: Recording) -> dict[str, Array]:
    """Errors [m] and input norms [m/s] of a run over time, as Figs. 5 and 6 show them."""
    disks = recording.header.disk_indices[:-1]
    apart = np.linalg.norm(
        recording.nominal_points[:, disks] - recording.actual_points[:, disks], axis=2
    )
    nominal_rates = recording.rates - recording.local_rates
    return {
        "time_s": recording.time,
        "nominal_m": tip_error(recording.nominal_tip + recording.offset, recording.target),
        "real_m": tip_error(recording.actual_tip, recording.target),
        "local_m": tip_error(recording.nominal_tip, recording.actual_tip),
        "body_m": np.mean(apart, axis=1),
        "nominal_input_m_s": np.linalg.norm(nominal_rates, axis=1),
        "local_input_m_s": np.linalg.norm(recording.local_rates, axis=1),
    }


def before_draws(base: Scenario, values: Array) -> Array:
    """Values (K,) in the last step before each draw of the disturbance."""
    assert base.disturbance is not None
    period = round(1.0 / (base.disturbance.rate * base.mpc.dt))
    return values[period - 1 :: period]


def linearity(error: Array) -> float | None:
    """How straight the error (K,) falls until a tenth of it is left: R^2 of a line, None if the
    way takes fewer than four steps."""
    way = error[: int(np.argmax(error <= LEFT * error[0]))]
    if len(way) < 4:
        return None
    time = np.arange(len(way))
    rest = way - np.polyval(np.polyfit(time, way, 1), time)
    return float(1.0 - np.var(rest) / np.var(way))


def settling_time(error: Array, dt: float, at_rest: float) -> float | None:
    """When the error (K,) [m], smoothed, came near that at rest [s]."""
    width = round(WINDOW / dt)
    smooth = np.convolve(error, np.full(width, 1.0 / width), mode="valid")
    good = np.flatnonzero(smooth <= at_rest + LEFT * max(float(error[0]) - at_rest, 0.0))
    return float((good[0] + 0.5 * width) * dt) if len(good) else None


def undone(base: Scenario, recording: Recording, seed: int) -> Array:
    """Tip errors (DRAWS,) [m] of a robot that stands still at the end of a run.

    Nothing answers the disturbance: this is what it does on its own, for the same pose.
    """
    c, disturbance = recording.configuration[-1], base.disturbance
    assert disturbance is not None
    plant = KinematicPlant(base.robot, seed=seed, disturbance=disturbance, start=c)
    still = np.zeros(len(base.robot.actuator_names))
    tips = [plant.step(still, 1.0 / disturbance.rate).tip for _ in range(DRAWS)]
    return tip_error(np.array(tips), base.robot.tip(c))


CONVERGENCE = Experiment(
    name="convergence",
    title="Convergence under disturbances (Figs. 5, 6)",
    section="III-C",
    run=run,
    draw=draw,
)
