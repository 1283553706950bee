"""IV: like the hardware. Only the tip is seen, motors are slow, and the robot is not its model."""

from dataclasses import replace
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.convergence.experiment import response
from sinuous.papers.hachen2025.hardware.figures import draw
from sinuous.papers.hachen2025.runs import held, scenario
from sinuous.papers.workers import Workers
from sinuous.recording import Recording
from sinuous.scenario import Scenario
from sinuous.scenario.path import Leg
from sinuous.session import run as run_session
from sinuous.summary import tip_error, violates_margin

SCENARIO = "hardware"
CONTROLLERS: dict[str, tuple[str, ...]] = {
    "MPC alone": ("control.local.enabled=false", "control.offset_free.when=never"),
    "MPC + local": ("control.offset_free.when=never",),
    "MPC offset-free": ("control.local.enabled=false",),
    "MPC + local, offset-free": (),
}
"""What is changed in the scenario for each; with only the tip measured the last is the default."""

SLACK = ("plant.mismatch.slack_bend_deg=40",)
"""A robot whose cables lose tension: a segment bends no further than that."""

GOAL_TIMES, QUICK_TIMES = (26.0, 15.0, 15.0, 15.0), (4.0, 2.0)  # at each goal [s]
HOLD_TIME, QUICK_HOLD = 25.0, 4.0  # at the boundary [s]
BEYOND = (0.08, 0.0, 0.16)  # a target beyond the side wall [m]
SEEDS = 3  # robots, each with its own making and its own bias of the tracker
PAIR = ("MPC + local", "MPC + local, offset-free")  # the paper's controller and ours
REST = 2.0  # the end of each goal's time, over which errors are averaged [s]

Item = tuple[str, str, int, bool]


def run(workers: Workers, quick: bool) -> Data:
    """Four goals (Fig. 12), the same with slack cables, and holding at a boundary (Fig. 13)."""
    names = PAIR if quick else tuple(CONTROLLERS)
    tests = [("goals", names), ("boundary", names), ("slack", PAIR)]
    items: list[Item] = [
        (test, name, seed, quick)
        for test, chosen in tests
        for name in chosen
        for seed in range(1 if quick or test == "slack" else SEEDS)
    ]
    return {
        "scenario": SCENARIO,
        "goal_times_s": list(QUICK_TIMES if quick else GOAL_TIMES),
        "rows": workers.map("like the hardware", drive, items),
    }


def drive(item: Item) -> dict[str, Any]:
    """One controller, one test, one robot."""
    test, name, seed, _ = item
    slack = SLACK if test == "slack" else ()
    base = replace(scenario(SCENARIO, *CONTROLLERS[name], *slack), seed=seed)
    return judged(item, driven(base, item), base)


def driven(base: Scenario, item: Item) -> Recording:
    """The run of a test in a scenario."""
    test, _, seed, _ = item
    if test == "boundary":
        return held(base, np.array(BEYOND), sum(times_of(item)), seed)
    return run_session(timed(base, times_of(item))).recording


def times_of(item: Item) -> tuple[float, ...]:
    """Times [s] for which each target of a test is held."""
    test, _, _, quick = item
    if test == "boundary":
        return (QUICK_HOLD if quick else HOLD_TIME,)
    return QUICK_TIMES if quick else GOAL_TIMES


def judged(item: Item, recording: Recording, base: Scenario) -> dict[str, Any]:
    """The row of a run."""
    test, name, seed, _ = item
    times = times_of(item)
    room = base.zone.clearance(recording.actual_tip) - base.robot.radii[-1]
    nominal_room = base.zone.clearance(recording.nominal_tip) - base.robot.radii[-1]
    curves = response(recording) | {"tip_room_m": room, "nominal_tip_room_m": nominal_room}
    return {
        "test": test,
        "controller": name,
        "seed": seed,
        "margin_m": base.mpc.margin,
        "real_error_at_goals_m": at_goals(recording, times, recording.actual_tip),
        "nominal_error_at_goals_m": at_goals(
            recording, times, recording.nominal_tip + recording.offset
        ),
        "local_error_at_goals_m": apart_at_goals(recording, times),
        "local_input_at_goals_m_s": averaged(recording, times, curves["local_input_m_s"]),
        "nominal_violations": int(np.count_nonzero(violates_margin(recording))),
        "least_nominal_clearance_m": float(np.min(recording.nominal_clearance)),
        "least_actual_clearance_m": float(np.min(recording.actual_clearance)),
        "least_tip_room_m": float(np.min(room)),
        "least_nominal_tip_room_m": float(np.min(nominal_room)),
        "curves": {key: value.round(7).tolist() for key, value in curves.items()}
        if seed == 0
        else None,
    }


def timed(base: Scenario, times: tuple[float, ...]) -> Scenario:
    """The scenario with every goal held for its time [s], at rest or not."""
    legs = [
        Leg(target=leg.target, moving=time, max_steps=0)
        for leg, time in zip(base.path, times, strict=False)
    ]
    return replace(base, path=tuple(legs))


def averaged(recording: Recording, times: tuple[float, ...], values: Array) -> list[float]:
    """Means of values (K,) over the end of each goal's time."""
    ends = np.cumsum(times)
    return [
        float(np.mean(values[(recording.time > end - REST) & (recording.time <= end + 1e-9)]))
        for end in ends
    ]


def at_goals(recording: Recording, times: tuple[float, ...], tip: Array) -> list[float]:
    """Mean distance of tips (K, 3) [m] from the target at the end of each goal's time [m]."""
    return averaged(recording, times, tip_error(tip, recording.target))


def apart_at_goals(recording: Recording, times: tuple[float, ...]) -> list[float]:
    """Mean distance of the real tip from the nominal one at the end of each goal's time [m]."""
    return averaged(recording, times, tip_error(recording.actual_tip, recording.nominal_tip))


HARDWARE = Experiment(
    name="hardware",
    title="Like the hardware (Figs. 12, 13)",
    section="IV",
    run=run,
    draw=draw,
)
