"""From parameters to tip positions: the model that is fitted."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.calibration.parameters import Parameters
from sinuous.calibration.pulls import Identified
from sinuous.robots.elastic import ElasticModel
from sinuous.robots.pcc import PccRobot

# Play that one starts from [m]: at none at all the fit would not see what a little more does.
LEAST_PLAY = 1e-5


@dataclass(frozen=True, kw_only=True, eq=False)
class Sequence:
    """Rows in time order, without a break that the robot would not remember.

    Arguments:
        pulls: by how much the motors pull the cables (T, C) [m]
        tips: measured (T, 3) [m]
        patterns: movement of each row (T,)
        own_zeros: whether these are single pulls, with zeros of their own
    """

    pulls: Array
    tips: Array
    patterns: IntArray
    own_zeros: bool


@dataclass(frozen=True, kw_only=True, eq=False)
class Problem:
    """A robot, what is fitted, and what it is fitted to.

    Arguments:
        robot: as its file says
        identified: which motor is which cable
        parameters: what is fitted
        sequences: what was recorded
    """

    robot: PccRobot
    identified: Identified
    parameters: Parameters
    sequences: tuple[Sequence, ...]

    # --- what parameters mean ------------------------------------------------------------

    @cached_property
    def _bare(self) -> PccRobot:
        return replace(self.robot, tool=None, T_w_b=np.eye(4))

    @cached_property
    def _segment(self) -> IntArray:
        counts = [len(segment.cable_angles) for segment in self.robot.segments]
        return np.repeat(np.arange(len(counts)), counts)

    @cached_property
    def lengths(self) -> Array:
        """Of the segments (J,) [m]."""
        return np.array([segment.home_length for segment in self.robot.segments])

    def hole_radii(self, x: Array) -> Array:
        """Distance of each cable from the backbone (C,) [m], spools of other sizes included."""
        nominal = np.concatenate([segment.pitch_radii for segment in self.robot.segments])
        p = self.parameters
        return nominal * np.exp(p.values(x, "log_pitch") + p.values(x, "log_spool"))

    def cable_angles(self, x: Array) -> Array:
        """Angles of the cables (C,) [rad]; those of the first segment define the base."""
        nominal = np.concatenate([segment.cable_angles for segment in self.robot.segments])
        turn = np.concatenate([[0.0], self.parameters.values(x, "turn")])
        return nominal + turn[self._segment]

    def model(self, x: Array) -> ElasticModel:
        """Statics of the robot."""
        p, lengths = self.parameters, self.lengths
        nominal = float(np.mean(np.concatenate([s.pitch_radii for s in self.robot.segments])))
        mean = float(np.mean(lengths))
        angles = self.cable_angles(x)
        around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        stiffness = float(np.exp(p.values(x, "log_stiffness")[0])) / (nominal**2 * mean)
        friction = float(np.exp(p.values(x, "log_friction")[0])) / mean
        return ElasticModel(
            lengths=lengths,
            segment=self._segment,
            holes=self.hole_radii(x)[:, None] * around,
            twist=np.concatenate([[0.0], p.values(x, "twist")]),
            stiffness=np.full(len(angles), stiffness),
            slack=p.values(x, "slack").copy(),
            rest=p.values(x, "rest_bend").reshape(-1, 2),
            friction=np.full(len(lengths), friction),
            play=max(float(p.values(x, "play")[0]), 0.0),
        )

    def base_pose(self, x: Array) -> Array:
        """Pose T_t_b of the base in the tracker's frame (4, 4)."""
        p, T = self.parameters, self.identified.T_t_b.copy()
        turned = Rotation.from_rotvec(p.values(x, "base_rotation")).as_matrix()
        T[:3, :3] = T[:3, :3] @ turned
        T[:3, 3] += p.values(x, "base_position")
        return T

    def marker(self, x: Array) -> Array:
        """Where the marker sits, in the frame of the last disk (3,) [m]."""
        nominal = np.array(self.robot.tool.offset) if self.robot.tool else np.zeros(3)
        return nominal + self.parameters.values(x, "marker")

    # --- what follows from them ----------------------------------------------------------

    def bends(self, x: Array, sequence: Sequence) -> Array:
        """Bend vectors (T, 2J) [rad]."""
        pulls = sequence.pulls
        if sequence.own_zeros:
            pulls = pulls - self.parameters.values(x, "pulls_slack")
        return self.model(x).trace(pulls)

    def tips(self, x: Array, sequence: Sequence) -> Array:
        """Tip positions (T, 3) [m] in the tracker's frame."""
        ends = self._bare.tip_pose(self.bends(x, sequence))
        T = self.base_pose(x)
        tips = ends[:, :3, 3] + ends[:, :3, :3] @ self.marker(x)
        return np.asarray(tips @ T[:3, :3].T + T[:3, 3])

    def residuals(self, x: Array) -> Array:
        """Tip errors (T, 3) [m] of all sequences, one after another."""
        return np.concatenate([self.tips(x, each) - each.tips for each in self.sequences])

    @cached_property
    def patterns(self) -> IntArray:
        """Movement of each row of all sequences (T,)."""
        return np.concatenate([sequence.patterns for sequence in self.sequences])

    @cached_property
    def own_zeros(self) -> BoolArray:
        """Which rows of all sequences are single pulls (T,)."""
        return np.concatenate([np.full(len(s.tips), s.own_zeros) for s in self.sequences])

    @cached_property
    def start(self) -> Array:
        """Parameters to start from."""
        x = self.parameters.start
        x[self.parameters.place("play")] = LEAST_PLAY
        return x
