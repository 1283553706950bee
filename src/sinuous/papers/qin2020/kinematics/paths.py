"""2.2.2: how joints and cables move while the tip goes straight."""

from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.control.geometric_ik import CHI, GeometricIK
from sinuous.control.geometric_rates import RateLimiter, path_rates
from sinuous.papers.qin2020.kinematics.disc import in_disc
from sinuous.papers.qin2020.runs import inverse
from sinuous.robots.robot_file import load_jointed

SEED = 6
COARSE = 0.0005  # between the places at which switches of k are looked for [m]
AROUND = 20  # steps to either side of a switch
SHORTEST, LONGEST = 1e-6, 1e-2  # steps [m]

ACROSS = ((0.05, 0.14), (-0.04, -0.12))  # a way through all regions of k, x and z [m]
SPEED = 0.1  # of the tip on it [m/s]
PERIODS = (1e-2, 1e-3, 1e-4, 1e-5)  # between targets [s]
SETTLING = 0.4  # time after the way [s]


def constant(chi: float) -> float:
    """C of |change of an angle| <= C sqrt(step) in the plane [rad / sqrt(m)]; see `GeometricIK`."""
    return 2.0 * np.sqrt(np.sin(chi) / inverse().robot.link_length) / np.cos(chi)


def continuity(count: int) -> dict[str, Any]:
    """The largest change of a joint angle in one step, on straight paths in the disc."""
    ik, rng = inverse(), np.random.default_rng(SEED)
    ends = ik.on_plane(in_disc(2 * count, ik.radius(CHI), rng), CHI).reshape(2, count, 3)
    steps = np.exp(rng.uniform(np.log(SHORTEST), np.log(LONGEST), count))
    found = [
        _steepest(ik, first, last, step)
        for first, last, step in zip(ends[0], ends[1], steps.tolist(), strict=True)
    ]
    changes, switches = np.array([one for one, _ in found]), sum(number for _, number in found)
    return {
        "paths": count,
        "switches": switches,
        "constant_rad_by_root_m": constant(CHI),
        "step_m": steps.tolist(),
        "change_rad": changes.tolist(),
        "largest_share": float(np.max(changes / np.sqrt(steps))) / constant(CHI),
    }


def _steepest(ik: GeometricIK, first: Array, last: Array, step: float) -> tuple[float, int]:
    """Largest change of an angle [rad] in a step [m] on a straight path, and switches of k on it.

    Steps are taken all along the path as far as there are not more than `COARSE` ones would be,
    and around every switch.
    """
    length = float(np.linalg.norm(last - first))
    way = (last - first) / length
    s = np.arange(0.0, length, COARSE)
    k = ik.solve(first + s[:, None] * way).first_joint
    at = np.flatnonzero(np.diff(k))
    low, high = s[at], s[at] + COARSE
    while np.any(high - low > 1e-3 * step):
        middle = 0.5 * (low + high)
        same = ik.solve(first + middle[:, None] * way).first_joint == k[at]
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    near = (low[:, None] + step * np.arange(-AROUND, AROUND + 1)).ravel()
    everywhere = np.arange(0.0, length, max(step, COARSE))
    starts = np.clip(np.concatenate([near, everywhere]), 0.0, max(length - step, 0.0))
    before = ik.solve(first + starts[:, None] * way).c
    after = ik.solve(first + (starts + step)[:, None] * way).c
    return float(np.max(np.abs(after - before))), len(at)


def cable_rates() -> dict[str, Any]:
    """What switches of k ask of the cables, and what a limit of their speed makes of it."""
    ik = inverse()
    period = PERIODS[1]
    path = _straight(ik, period)
    found = path_rates(ik, path, period)
    rest = np.repeat(path[-1:], round(SETTLING / period), axis=0)
    return {
        "speed_m_s": SPEED,
        "period_s": period,
        "fastest_cable_m_s": np.abs(found.rates).max(axis=1).round(5).tolist(),
        "switches_at_s": (period * np.flatnonzero(found.switches)).tolist(),
        "peak_by_period": [
            {"period_s": dt, "cable_m_s": _peak(ik, dt), "saturated_share": _saturated(ik, dt)}
            for dt in PERIODS
        ],
        "limited": [_limited(limits, np.concatenate([path, rest]), period)
                    for limits in ("simulation", "hardware")],
    }  # fmt: skip


def _straight(ik: GeometricIK, period: float) -> Array:
    first, last = ik.on_plane(ACROSS, CHI)
    length = float(np.linalg.norm(last - first))
    return first + np.arange(0.0, length, SPEED * period)[:, None] * (last - first) / length


def _peak(ik: GeometricIK, period: float) -> float:
    return float(np.max(np.abs(path_rates(ik, _straight(ik, period), period).rates)))


def _saturated(ik: GeometricIK, period: float) -> float:
    return float(np.mean(path_rates(ik, _straight(ik, period), period).saturated))


def _limited(limits: str, path: Array, period: float) -> dict[str, Any]:
    """All cables slow down together: how far the tip then lags behind."""
    robot = load_jointed("qin2020", limits=limits)
    limiter, goals = RateLimiter(robot=robot, dt=period), inverse().solve(path).c
    c, way, shares = goals[0], np.empty_like(goals), np.empty(len(goals))
    for i, goal in enumerate(goals):
        c, shares[i] = limiter.step(c, goal)
        way[i] = c
    error = np.linalg.norm(robot.tip(way) - path, axis=1)
    return {
        "limits": limits,
        "cable_speed_m_s": robot.speed.cable,
        "steps_slowed": int(np.count_nonzero(shares < 1.0)),
        "least_share": float(np.min(shares)),
        "tip_error_m": error.round(7).tolist(),
    }
