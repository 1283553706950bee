"""What the geometric solution asks of the cables at 1 kHz, and how far the tip lags behind.

Where k switches, joints start with the root of the way (notes A5): cables saturate there. The
robot then follows with what its cables can do, see `RateLimiter`.
"""

from collections.abc import Iterator, Sequence

import numpy as np

from sinuous.arrays import Array, BoolArray
from sinuous.bench.ik_tasks import PATHS, QUICK_PATHS, SEED, straight_path
from sinuous.bench.result import Column, Row
from sinuous.control.geometric_ik import GeometricIK
from sinuous.control.geometric_rates import PathRates, RateLimiter, path_rates
from sinuous.robots.robot_file import load_jointed
from sinuous.view.units import MM_PER_M, MS_PER_S

DT = 1e-3  # [s]
SPEEDS, QUICK_SPEEDS = (0.02, 0.05, 0.1, 0.2), (0.2,)  # of the tip [m/s]
LIMITS = ("simulation", "hardware")  # of the preset's cables

FOLLOW_COLUMNS = (
    Column(key="cables", title="cables"),
    Column(key="cable_limit_mm_s", title="limit", form=".0f"),
    Column(key="tip_speed_mm_s", title="tip speed", form=".0f"),
    Column(key="ticks", title="ticks"),
    Column(key="saturated", title="saturated", form=".2%"),
    Column(key="load_max", title="worst rate", form=".2f"),
    Column(key="load_at_switch_median", title="at switches", form=".2f"),
    Column(key="longest_ms", title="longest", form=".0f"),
    Column(key="lag_max_mm", title="lag", form=".3f"),
    Column(key="lag_rms_mm", title="RMS lag", form=".4f"),
)


def follow(quick: bool) -> Iterator[Row]:
    """One row per set of limits and speed."""
    for limits in LIMITS:
        ik = GeometricIK(load_jointed("qin2020", limits=limits))
        for speed in QUICK_SPEEDS if quick else SPEEDS:
            rng = np.random.default_rng(SEED + 1)
            count = QUICK_PATHS if quick else PATHS
            paths = [straight_path(ik, rng, speed * DT) for _ in range(count)]
            yield {
                "cables": limits,
                "cable_limit_mm_s": ik.robot.speed.cable * MM_PER_M,
                "tip_speed_mm_s": speed * MM_PER_M,
                **_numbers([path_rates(ik, p, DT) for p in paths], [_lag(ik, p) for p in paths]),
            }


def _numbers(asked: Sequence[PathRates], lags: Sequence[Array]) -> Row:
    load, lag = np.concatenate([one.load for one in asked]), np.concatenate(lags) * MM_PER_M
    at_switch = np.concatenate([one.load[one.switches] for one in asked])
    return {
        "ticks": len(load),
        "switches": len(at_switch),
        "saturated": float(np.mean(load > 1.0)),
        "load_max": float(load.max()),
        "load_at_switch_median": float(np.median(at_switch)) if len(at_switch) else float("nan"),
        "longest_ms": max(_longest(one.saturated) for one in asked) * DT * MS_PER_S,
        "lag_max_mm": float(lag.max()),
        "lag_rms_mm": float(np.sqrt(np.mean(lag**2))),
    }


def _lag(ik: GeometricIK, path: Array) -> Array:
    """Distance of the tip from its target (K,) [m], its cables no faster than they can."""
    limiter, goals = RateLimiter(robot=ik.robot, dt=DT), ik.solve(path).c
    c = np.empty_like(goals)
    c[0] = goals[0]
    for k, goal in enumerate(goals[1:], 1):
        c[k], _ = limiter.step(c[k - 1], goal)
    return np.linalg.norm(ik.robot.tip(c) - path, axis=1)


def _longest(chosen: BoolArray) -> int:
    """Length of the longest run of ticks."""
    ends = np.flatnonzero(np.diff(np.concatenate([[False], chosen, [False]]).astype(np.int64)))
    return int(np.max(ends[1::2] - ends[::2], initial=0))
