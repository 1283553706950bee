"""A live session in a few numbers."""

import math
from typing import Any

from sinuous.live.board import Board
from sinuous.live.layout import Timed
from sinuous.live.watch import Watch
from sinuous.scenario import Scenario

NAMES = {
    Timed.TICK: "tick_lateness_s",
    Timed.WORK: "tick_work_s",
    Timed.STEP: "step_lateness_s",
    Timed.SOLVE: "solve_time_s",
    Timed.COMMAND: "step_due_to_command_s",
    Timed.MESSAGE: "message_to_command_s",
    Timed.IDLE: "idle_tick_lateness_s",
}


def loop_numbers(scenario: Scenario, board: Board, wall_time: float) -> dict[str, Any]:
    """What both loops have done in a time of the clock [s].

    `simulated_s`, `wall_time_s`, `real_time_factor`
        below 1: overload has slowed simulated time down, by `slipped_s` in all
    `tick_lateness_s` and the like
        median, 99th percentile and maximum, exact to 2 %: how late a tick of the fast loop begins,
        what it takes, how late the controller begins, what it takes, from a step's due time to its
        command, from the arrival of the oldest message a step has not known of to the first command
        that does, and how late a loop beside it is that does nothing (None if there was none)
    `ticks_late_1ms_fraction`
        share of the ticks that began more than 1 ms late
    `mpc_deadline_misses`, `mpc_deadline_miss_fraction`
        steps whose command came after the next step was due
    `solver_failures`
        steps in which no safe command was found, so that the controller held still
    `channel_energy_least_j`
        below zero if the channel made energy
    """
    assert scenario.teleop is not None
    ticks, steps = board.ticks.written, board.get("steps")
    simulated = ticks * scenario.teleop.dt
    return {
        "scenario": scenario.name,
        "robot": scenario.robot.name,
        "controller_rate_hz": 1.0 / scenario.controller.dt,
        "tick_rate_hz": 1.0 / scenario.teleop.dt,
        "ticks": ticks,
        "steps": steps,
        "simulated_s": simulated,
        "wall_time_s": wall_time,
        "real_time_factor": simulated / wall_time if wall_time > 0.0 else None,
        "slipped_s": board.get("slipped"),
        **{name: _quantiles(board, kind) for kind, name in NAMES.items()},
        "ticks_late_1ms_fraction": board.times[Timed.TICK].beyond(1e-3) / max(ticks, 1),
        "mpc_deadline_misses": board.get("misses"),
        "mpc_deadline_miss_fraction": board.get("misses") / steps if steps else None,
        "solver_failures": board.get("holding"),
        "channel_energy_least_j": board.get("least_j"),
    }


def watch_numbers(watch: Watch) -> dict[str, Any]:
    """What was seen of the robot.

    `margin_violations`
        samples whose nominal clearance is below the margin by more than 1e-9 m
    `min_clearance_nominal_m`
        least of all samples, None where there is no wall
    `samples`, `samples_judged_finely`, `samples_lost`
        judged at all, judged on the surface of the body all the way through the step as `sinuous
        run` does it, and not judged, because this process was kept from running
    """
    return {
        "margin_violations": watch.violations,
        "min_clearance_nominal_m": watch.least if math.isfinite(watch.least) else None,
        "samples": watch.samples,
        "samples_judged_finely": watch.fine,
        "samples_lost": watch.lost,
    }


def _quantiles(board: Board, kind: Timed) -> dict[str, float] | None:
    times = board.times[kind]
    return times.quantiles._asdict() if times.number else None
