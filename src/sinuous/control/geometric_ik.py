"""Geometric inverse kinematics of the jointed robot, in closed form (paper A, eq. 10-15).

In the reference pose joint 1 is bent by chi, links 1 to N-1 are straight on, and the last tube is
parallel to the base's y axis (10). For a target the last joints leave this pose, as few of them
as can: joint k is the first one (11). From A_k+1 to A_N the robot is straight, and A_k+1 lies in
the plane of the reference line and A_N, on the side of its reference place (12), (notes A5).
"""

from dataclasses import KW_ONLY, dataclass
from enum import IntEnum
from functools import cached_property
from math import acos, cos, hypot, pi, radians, sin
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, ArrayLike, IntArray
from sinuous.control import geometric_ik_kernels as kernels
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.parts import JointOrder

CHI = radians(20.3)
"""Bend of joint 1 in the reference pose [rad]; not printed, representative (notes A)."""

LEAST_JOINTS = 3

# A tool's end this close to the axis of the last tube lies on it [m].
ON_AXIS = 1e-12


class IKStatus(IntEnum):
    """How a target was answered; arrays of it compare with its members."""

    REACHED = kernels.REACHED
    """The tip is on the target and no joint is bent too far."""
    UNREACHABLE = kernels.UNREACHABLE
    """The target is farther away than the robot is long; the tip is on the nearest reachable.
    Whether that one is within the joint limits, its bend says."""
    JOINT_LIMIT = kernels.JOINT_LIMIT
    """The tip would be on the target, but a joint would be bent beyond its limit."""


_STATUSES = tuple(IKStatus)


class IKSolution(NamedTuple):
    """The answer to one target."""

    c: Array  # configuration (n,)
    status: IKStatus
    target: Array  # where the tip is: the target itself or the nearest reachable (3,) [m]
    first_joint: int  # k, of the joints 1 to N
    bend: float  # of the joint that is bent most [rad]


@dataclass(frozen=True, kw_only=True, eq=False)
class IKSolutions:
    """The answers to many targets.

    Arguments:
        c: configurations (..., n)
        status: members of `IKStatus` (...,)
        targets: where the tip is: the target itself or the nearest reachable (..., 3) [m]
        first_joint: k (...,), of the joints 1 to N
        bend: of the joint that is bent most (...,) [rad]
    """

    c: Array
    status: IntArray
    targets: Array
    first_joint: IntArray
    bend: Array


@dataclass(frozen=True, eq=False)
class GeometricIK:
    """Configurations of a jointed robot that put its tip on targets, in closed form.

    Targets are in the world frame. How far a target lies along the base's y axis is y0: the plane
    PTY in which the tip moves. The paper's equation of that plane, y0 = (N-1) L cos(chi) + L, also
    fixes the bend chi of joint 1 in the reference pose, so chi and y0 are one input, and it comes
    with every target: `plane` gives y0 for chi, `chi` is its inverse. The reference line then
    meets the plane of the targets in the reference point alone, where nothing is bent. That makes
    the angles continuous in all three coordinates of a target; with a chi of its own the solution
    would turn over where a target crosses the line.

    In their plane the targets that can be reached form a disc, of radius (N-1) L sin(chi) about the
    base's axis. One outside is answered with the nearest in its plane, so the depth stays what was
    asked for; only beyond the length of the robot, where no plane has a disc, the depth gives way.

    At a switch of k the robot is straight from A_k on, and the bend of joint k+1 begins with the
    square root of the way. So a step of the target changes a bend by at most C sqrt(step), with

        C = 2 sqrt(sin(chi) / L) / cos(chi)   in the plane,
        C = 2 sqrt(1 / L) / cos(chi)          in any direction,

    chi being the largest on the way. It follows from (12), with j = N - k >= 2: the slack of (11),
    4 (j-1) L^2 sin(b/2)^2 = (j L)^2 - |A_N - A_k,r|^2, has a gradient of at most 2 j L sin(chi) in
    the plane and of 2 j L at all, and b is at most 2 chi; joints k and N share that bend. The two
    angles of a joint keep the same bound where joints keep about within their limits (tested for
    chi up to 20.3 degrees); near a bend of 90 degrees a universal joint loses an axis.

    Arguments:
        robot: with three joints or more and, if it has one, a tool on the axis of the last tube
        insertion: what the stage is held at [m]; by default its home

    Raises:
        ValueError: if the robot has too few joints, a tool beside the axis or no such insertion
    """

    robot: JointedRobot
    _: KW_ONLY
    insertion: float | None = None

    def __post_init__(self) -> None:
        robot = self.robot
        if robot.joints < LEAST_JOINTS:
            raise ValueError(f"robot must have {LEAST_JOINTS} joints or more, not {robot.joints}")
        if robot.tool is not None:
            x, _, z = robot.tool.offset
            if hypot(x, z) > ON_AXIS:
                raise ValueError(
                    f"tool must end on the axis of the last tube, not {hypot(x, z)} m beside it"
                )
        if self.insertion is None:
            return
        if robot.insertion is None:
            raise ValueError("insertion must be None for a robot without a stage")
        low, high = robot.insertion.travel
        if not low <= self.insertion <= high:
            raise ValueError(f"insertion must be from {low} to {high} m, not {self.insertion}")

    @cached_property
    def arm(self) -> kernels.Arm:
        """The robot as plain numbers: what compiled code reads."""
        robot = self.robot
        held = float(robot.home[0]) if self.insertion is None else self.insertion
        held = held if robot.insertion is not None else 0.0
        lean = [0 if order is JointOrder.ZX else 2 for order in robot.orders]
        tool = 0.0 if robot.tool is None else robot.tool.offset[1]
        return kernels.Arm(
            lean=np.array(lean, dtype=np.int64),
            link=robot.link_length,
            first=robot.plate_offset + held,
            last=robot.plate_offset + robot.tube_length + tool,
            limit=robot.bend_limit,
            insertion=held,
            T_w_b=np.array(robot.T_w_b, dtype=np.float64, order="C"),
        )

    # --- the plane of the targets ------------------------------------------------------------

    @property
    def reach(self) -> float:
        """(N-1) L, from A_1 to A_N of the straight robot [m]."""
        return (self.robot.joints - 1) * self.arm.link

    def plane(self, chi: float) -> float:
        """y0 [m], along the base's y axis, of the plane that belongs to chi [rad].

        Raises:
            ValueError: if chi is not from 0 to a right angle
        """
        if not 0.0 <= chi <= pi / 2.0:
            raise ValueError(f"chi must be from 0 to a right angle, not {chi} rad")
        return self.reach * cos(chi) + self.arm.first + self.arm.last

    def chi(self, y0: float) -> float:
        """chi [rad] of the plane at y0 [m].

        Raises:
            ValueError: if the robot is too short for that plane
        """
        height = y0 - self.arm.first - self.arm.last
        if not abs(height) <= self.reach:
            raise ValueError(
                f"y0 must be at most {self.plane(0.0)} m, the robot's length, not {y0}"
            )
        return acos(height / self.reach)

    def radius(self, chi: float) -> float:
        """Radius [m] of the disc of targets that can be reached in the plane of chi [rad]."""
        return self.reach * sin(chi)

    def on_plane(self, x_z: ArrayLike, chi: float) -> Array:
        """Targets (..., 3) [m] at (x, z) (..., 2) [m] of the base in the plane of chi [rad]."""
        x_z = np.asarray(x_z, dtype=np.float64)
        T, y0 = self.arm.T_w_b, np.full(x_z.shape[:-1], self.plane(chi))
        return np.stack([x_z[..., 0], y0, x_z[..., 1]], axis=-1) @ T[:3, :3].T + T[:3, 3]

    def reference(self, chi: float) -> Array:
        """Configuration (n,) of the reference pose, joint 1 bent by chi [rad]."""
        return self.solve_one(self.on_plane([0.0, self.radius(chi)], chi)).c

    # --- solutions ---------------------------------------------------------------------------

    def solve(self, targets: ArrayLike) -> IKSolutions:
        """Answers to targets (..., 3) [m].

        Raises:
            ValueError: if a target is not three finite numbers
        """
        value = np.array(targets, dtype=np.float64, order="C")
        if value.shape[-1:] != (3,):
            raise ValueError(f"targets must be (..., 3), not {value.shape}")
        shape, flat = value.shape[:-1], value.reshape(-1, 3)
        c, nearest = np.empty((len(flat), len(self.robot.home))), np.empty_like(flat)
        status, first = np.empty(len(flat), np.int64), np.empty(len(flat), np.int64)
        bend = np.empty(len(flat))
        kernels.solve_batch(self.arm, flat, c, nearest, status, first, bend)
        if (senseless := np.flatnonzero(status == kernels.SENSELESS)).size:
            raise _senseless(flat[senseless[0]])
        return IKSolutions(
            c=c.reshape(*shape, c.shape[1]),
            status=status.reshape(shape),
            targets=nearest.reshape(*shape, 3),
            first_joint=first.reshape(shape),
            bend=bend.reshape(shape),
        )

    def solve_one(self, target: ArrayLike) -> IKSolution:
        """The answer to one target (3,) [m], for loops at 1 kHz.

        Raises:
            ValueError: if it is not three finite numbers
        """
        value = np.array(target, dtype=np.float64, order="C")
        if value.shape != (3,):
            raise ValueError(f"target must be (3,), not {value.shape}")
        c, nearest = np.empty(self._size), np.empty(3)
        status, first, bend = kernels.solve_one(self.arm, value, c, nearest)
        if status == kernels.SENSELESS:
            raise _senseless(value)
        return IKSolution(c, _STATUSES[status], nearest, first, bend)

    @cached_property
    def _size(self) -> int:
        return len(self.robot.home)


def _senseless(target: Array) -> ValueError:
    return ValueError(
        f"a target must be three finite numbers of sensible size, not {target.tolist()}"
    )
