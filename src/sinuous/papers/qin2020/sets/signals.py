"""Numbers of a run's signals: how well it tracks, what is felt, and every contact."""

from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.recording import Recording
from sinuous.teleop.link import ConstantDelay

AXES = ("x", "z")
STILL = 1e-4  # by which a leader at rest may be faster than at its slowest [m/s]
APART = 0.2  # contacts that are closer to each other in time are one [s]


@dataclass(frozen=True, kw_only=True, eq=False)
class Signals:
    """Of every tick, on the follower's side (K, 2).

    Arguments:
        dt: time of a tick [s]
        late: ticks from one end to the other
        X, V: of the leader [m], [m/s]
        X_sd, X_s: desired, and of the follower [m]
        F_s, F_m: virtual force, and force on the leader [N]
    """

    dt: float
    late: int
    X: Array
    V: Array
    X_sd: Array
    X_s: Array
    F_s: Array
    F_m: Array

    @classmethod
    def of(cls, recording: Recording, delay: float) -> Self:
        """Those of a run with a delay [s]."""
        dt = recording.header.tick
        return cls(
            dt=dt,
            late=ConstantDelay(delay=delay, dt=dt).ticks,
            X=recording.signal("sent_m"),
            V=recording.signal("sent_m_s"),
            X_sd=recording.signal("desired_m"),
            X_s=recording.signal("tip_m"),
            F_s=recording.signal("virtual_n"),
            F_m=recording.signal("felt_n"),
        )

    @property
    def force_error(self) -> Array:
        """F_m less F_s of one delay before (K, 2) [N]."""
        return self.F_m - _before(self.F_s, self.late)

    def beyond(self, boundary: float) -> BoolArray:
        """Where the follower has reached the boundary, axis by axis (K, 2)."""
        return np.abs(self.X_s) >= boundary

    def errors(self, where: BoolArray) -> dict[str, float]:
        """Root mean squares over the ticks (K,) that are asked for.

        The leader is compared as it was one delay before, because that is what the follower can
        know. Forces are compared at the leader.
        """
        X = _before(self.X, self.late)
        X[: self.late] = self.X[0]
        return {
            "force_n": _rms(self.force_error[where]),
            "tracking_m": _rms((self.X_sd - self.X_s)[where]),
            "desired_m": _rms((X - self.X_sd)[where]),
            "following_m": _rms((X - self.X_s)[where]),
            "following_largest_m": _largest((X - self.X_s)[where]),
            "tracking_largest_m": _largest((self.X_sd - self.X_s)[where]),
            "virtual_n": _rms(self.F_s[where]),
        }

    def largest_step(self, where: BoolArray) -> float:
        """Largest change of the virtual force on an axis in one of the ticks (K,) [N]."""
        steps = np.abs(np.diff(self.F_s, axis=0))[where[1:] & where[:-1]]
        return float(np.max(steps, initial=0.0))

    def contacts(self, boundary: float) -> list[dict[str, Any]]:
        """Every stay of the follower at or beyond a side of the boundary."""
        found = list[dict[str, Any]]()
        for axis, name in enumerate(AXES):
            for first, last in _stays(self.beyond(boundary)[:, axis], round(APART / self.dt)):
                found.append({"axis": name, **self._contact(axis, first, last, boundary)})
        return sorted(found, key=lambda contact: contact["from_s"])

    def _contact(self, axis: int, first: int, last: int, boundary: float) -> dict[str, Any]:
        F_s, F_m = self.F_s[:, axis], self.F_m[:, axis]
        side = float(np.sign(self.X_s[first, axis]))
        felt = first + self.late
        ticks = np.arange(first + self.late, last)
        speed = np.linalg.norm(self.V, axis=1)[ticks]
        at = ticks[speed <= np.min(speed) + STILL][-1]
        return {
            "side": side,
            "from_s": first * self.dt,
            "to_s": last * self.dt,
            "step_n": side * float(F_s[first] - F_s[first - 1]),
            "step_felt_n": side * float(F_m[felt] - F_m[felt - 1]),
            "step_felt_after_s": self.late * self.dt,
            "depth_m": side * float(self.X_s[at, axis]) - boundary,
            "deepest_m": float(np.max(side * self.X_s[first:last, axis])) - boundary,
            "leader_speed_m_s": float(np.linalg.norm(self.V[at])),
            "rest_virtual_n": side * float(F_s[at - self.late]),
            "rest_felt_n": side * float(F_m[at]),
            "offset_m": side * float(self.X[at, axis] - self.X_sd[at, axis]),
        }


def _stays(inside: BoolArray, apart: int) -> list[tuple[int, int]]:
    """First and last tick of every stay (K,), those that are closer joined."""
    at: IntArray = np.flatnonzero(inside)
    if not len(at):
        return []
    gaps = np.flatnonzero(np.diff(at) > apart)
    firsts, lasts = np.append(0, gaps + 1), np.append(gaps, len(at) - 1)
    return [(int(at[i]), int(at[j])) for i, j in zip(firsts, lasts, strict=True)]


def _before(signal: Array, ticks: int) -> Array:
    """A signal (K, A) as it was so many ticks before, zero before the first."""
    late = np.zeros_like(signal)
    late[ticks:] = signal[: len(signal) - ticks]
    return late


def _rms(values: Array) -> float:
    """Of the lengths of vectors (K, A); zero of none."""
    return float(np.sqrt(np.mean(np.sum(values**2, axis=1)))) if len(values) else 0.0


def _largest(values: Array) -> float:
    return float(np.max(np.linalg.norm(values, axis=1), initial=0.0))
