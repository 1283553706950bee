"""A run in a few numbers, as `summary.json` holds them."""

import math

import numpy as np

from sinuous.arrays import Array, BoolArray
from sinuous.control.report import Status
from sinuous.recording import Recording, status_name

MARGIN_TOLERANCE = 1e-9
"""[m] below the margin by less is not a violation: rounding, a thousandth of a micrometre."""

FAILED = status_name(Status.HOLDING)
"""Status of the steps that `solver_failures` counts."""


def summarise(recording: Recording, *, wall_time: float | None = None) -> dict[str, object]:
    """The numbers of a run, ready for JSON: what is not finite, or not known, is None.

    `tip_error_rms_m`, `tip_error_final_m`
        distance from the actual tip to the target of the same step, root mean square over
        all steps and in the last one; for a target that jumps, the way there counts
    `min_clearance_nominal_m`, `min_clearance_actual_m`
        least clearance of the body surface over all steps, of the controller's model and of
        the plant; negative inside a wall, None where there is no wall
    `margin_violations`
        number of steps whose nominal clearance is below the margin by more than 1e-9 m
    `solver_failures`
        number of steps in which no safe command was found, so that the controller held still
    `solve_time_s`
        median, 99th percentile and maximum of the controller's wall-clock time per step
    `real_time_factor`
        simulated time by wall-clock time of the whole run; above 1 is faster than real time
    `teleop`
        None without an operator's hand; else `tracking_rms_m` and `tracking_max_m`, distance from
        the tip to where it should be at every tick; `felt_force_rms_n` and `felt_force_max_n`, the
        force fed back; `channel_energy_least_j`, below zero if the channel made energy;
        `fault_ticks`, in which an end held still because of a fault
    `physics`
        None unless the plant knows its cables' tensions; else `least_tension_n` and
        `slack_fraction`, share of the steps in which a cable was slack; `wall_contacts`, number of
        steps that touched a wall, `contact_force_max_n`, the largest of one contact, and
        `penetration_max_m`
    `seed`, `versions`
        what is needed to run it again

    Arguments:
        recording: one run
        wall_time: how long the run took [s]; without it the real-time factor is None
    """
    error = tip_error(recording.actual_tip, recording.target)
    simulated = float(recording.time[-1]) if len(recording) else 0.0
    return {
        "tip_error_rms_m": _finite(np.sqrt(np.mean(error**2))) if len(error) else None,
        "tip_error_final_m": _finite(error[-1]) if len(error) else None,
        "min_clearance_nominal_m": _least(recording.nominal_clearance),
        "min_clearance_actual_m": _least(recording.actual_clearance),
        "margin_violations": int(np.count_nonzero(violates_margin(recording))),
        "solver_failures": recording.status.count(FAILED),
        "solve_time_s": _times(recording.solve_time),
        "real_time_factor": _finite(simulated / wall_time) if wall_time else None,
        "teleop": _by_hand(recording) if len(recording.signals) else None,
        "physics": _physics(recording) if recording.tensions.size else None,
        "seed": recording.header.seed,
        "versions": dict(recording.header.versions),
    }


def _by_hand(recording: Recording) -> dict[str, float | int | None]:
    error = tip_error(recording.signal("tip_m"), recording.signal("desired_m"))
    felt = np.linalg.norm(recording.signal("felt_n"), axis=1)
    return {
        "tracking_rms_m": _finite(np.sqrt(np.mean(error**2))),
        "tracking_max_m": _finite(np.max(error)),
        "felt_force_rms_n": _finite(np.sqrt(np.mean(felt**2))),
        "felt_force_max_n": _finite(np.max(felt)),
        "channel_energy_least_j": _finite(min(0.0, float(np.min(recording.signal("channel_j"))))),
        "fault_ticks": int(np.count_nonzero(recording.signal("fault"))),
    }


def _physics(recording: Recording) -> dict[str, float | int | None]:
    depth, largest, _ = recording.contacts.T
    return {
        "least_tension_n": _finite(np.min(recording.tensions)),
        "slack_fraction": _finite(np.mean(np.any(recording.tensions <= 0.0, axis=1))),
        "wall_contacts": int(np.count_nonzero(largest > 0.0)),
        "contact_force_max_n": _finite(np.max(largest)),
        "penetration_max_m": _finite(max(0.0, float(np.max(depth)))),
    }


def tip_error(tip: Array, target: Array) -> Array:
    """Distance (K,) [m] between tips (K, 3) and targets (K, 3)."""
    return np.linalg.norm(tip - target, axis=-1)


def violates_margin(recording: Recording) -> BoolArray:
    """Whether the nominal body is too close to a wall (K,); an unknown clearance is, too."""
    return ~(recording.nominal_clearance >= recording.header.margin - MARGIN_TOLERANCE)


def _times(solve_time: Array) -> dict[str, float | None]:
    if not len(solve_time):
        return {"median": None, "p99": None, "max": None}
    return {
        "median": _finite(np.median(solve_time)),
        "p99": _finite(np.percentile(solve_time, 99)),
        "max": _finite(np.max(solve_time)),
    }


def _least(values: Array) -> float | None:
    return _finite(np.min(values)) if len(values) else None


def _finite(value: float | np.floating) -> float | None:
    """A plain number, or None for what JSON cannot hold."""
    return float(value) if math.isfinite(value) else None
