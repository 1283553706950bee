"""Frames along a body of which only points are known, carried from its base to its tip.

Where the body bends steadily, the frame turns by the least rotation that takes one direction to
the next,

    Q = I - (d + t)(d + t)' / (1 + d't) + 2 t d',

which for constant curvature is the frame of the model itself.  A universal joint turns about its
two axes, which the directions before and after it give.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.robots.chain_kernels import ARC, HINGE
from sinuous.robots.robot import Robot

NONE = 1e-12  # [m] between two points that are one


@dataclass(frozen=True, kw_only=True, eq=False)
class Joint:
    """A universal joint: its axes and the direction of what follows, in the frame before it."""

    first: Array  # (3,)
    second: Array  # (3,)
    after: Array  # (3,)

    def turned(self, R: Array, along: Array) -> Array:
        """The frame after it (3, 3), if what follows points along (3,) in the world."""
        u = R.T @ along
        across = np.cross(self.first, self.after)
        sine = float(u @ self.first) * float(
            np.sign(np.cross(self.second, self.after) @ self.first)
        )
        q1 = float(np.arctan2(u @ across, u @ self.after))
        q2 = float(np.arcsin(np.clip(sine, -1.0, 1.0)))
        return R @ _about(self.first, q1) @ _about(self.second, q2)


@dataclass(frozen=True, kw_only=True, eq=False)
class Frames:
    """How directions and frames follow from the points of a robot's body."""

    base: Array  # (3, 3)
    start: Array  # (3,) direction at the base, in the world
    bends: BoolArray  # (S,) whether a point is on an arc
    joints: dict[int, Joint]  # by the first point after it
    joint_columns: dict[int, int]  # that point, by the column of the joint's first angle

    @classmethod
    def of(cls, robot: Robot) -> Self:
        """Those of a robot."""
        chain, base = robot.chain, robot.T_w_b[:3, :3]
        joints, columns = dict[int, Joint](), dict[int, int]()
        for s in range(1, len(chain.section)):
            between = np.arange(chain.section[s - 1] + 1, chain.section[s])
            hinges = between[chain.turns[between] == HINGE]
            if len(hinges) == 2:
                first, second = chain.direction[hinges]
                joints[s] = Joint(first=first, second=second, after=chain.direction[hinges[1] + 1])
                columns[int(chain.theta_column[hinges[0]])] = s
        return cls(
            base=base,
            start=base @ chain.direction[0],
            bends=chain.turns[chain.section] == ARC,
            joints=joints,
            joint_columns=columns,
        )

    def directions(self, points: Array) -> Array:
        """Unit vectors (S, 3) along the body at its points (S, 3)."""
        steps = np.diff(points, axis=0)
        sizes = np.linalg.norm(steps, axis=1, keepdims=True)
        chords = steps / np.maximum(sizes, NONE)
        along = np.vstack([self.start, chords])
        # On an arc chords are bisected: a chord deviates by half the angle that it spans.
        middle = sizes[1:] * chords[:-1] + sizes[:-1] * chords[1:]
        last, before = chords[-1], middle[-1] / max(float(np.linalg.norm(middle[-1])), NONE)
        bisected = np.vstack([self.start, middle, 2.0 * (before @ last) * last - before])
        along = np.where(self.bends[:, None], bisected, along)
        size = np.linalg.norm(along, axis=1, keepdims=True)
        return np.where(size > NONE, along / np.maximum(size, NONE), self.start)

    def at(self, along: Array, stations: IntArray) -> Array:
        """Frames (V, 3, 3) at some points (V,), ascending, given all directions (S, 3)."""
        frame, d = self.base, self.start
        frames, done = np.empty((len(stations), 3, 3)), -1
        for i, s in enumerate(stations):
            for joint in (j for j in self.joints if done < j <= s):
                frame, d = self.joints[joint].turned(frame, along[joint]), along[joint]
            t, done = along[s], int(s)
            v = d + t
            least = np.outer(2.0 * t, d) - np.outer(v, v) / max(1.0 + float(d @ t), NONE)
            frame = frame + least @ frame
            frames[i], d = frame, t
        return frames


def _about(axis: Array, angle: float) -> Array:
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * K @ K


def towards(along: Array) -> Array:
    """Quaternions (S, 4), w first, that turn z into unit vectors (S, 3)."""
    x, y, z = along.T
    w = np.maximum(1.0 + z, NONE)
    flat = z < -1.0 + 1e-9
    q = np.stack([np.where(flat, 0.0, w), np.where(flat, 1.0, -y), np.where(flat, 0.0, x), 0.0 * x])
    return (q / np.linalg.norm(q, axis=0)).T
