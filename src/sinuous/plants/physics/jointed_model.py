"""Jointed robots as MuJoCo models: rigid modules on hinges, cables as tendons through sites."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.plants.physics.body import BODY_AFFINITY, BODY_TYPE
from sinuous.plants.physics.engine import require_mujoco
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.jointed_cables import hole_angles, hole_offsets
from sinuous.robots.jointed_kernels import CABLES
from sinuous.robots.mechanics import CableMechanics

BASE, TIP = "base", "tip"
FRONT, REAR = "front", "rear"
HOLE = 0.0005  # radius at which holes are drawn [m]
CABLE = 0.0004  # and cables
PLATE = 0.001  # half the thickness at which the base plate is drawn [m]
AXES = np.eye(3)


@dataclass(frozen=True, kw_only=True, eq=False)
class JointedBody:
    """A jointed robot for MuJoCo; see `PhysicalBody`.

    The base plate is a body that the insertion stage moves; module i is a body whose origin is
    the centre of joint i, with the two hinges of the joint in the robot's order.
    """

    robot: JointedRobot

    @property
    def tip_body(self) -> str:
        """Name of the body whose origin is the tip."""
        return TIP

    @property
    def mechanics(self) -> CableMechanics:
        """Of all cables."""
        return self.robot.mechanics.cables

    @property
    def cables(self) -> IntArray:
        """Which of the robot's actuators are cables (C,)."""
        return np.arange(self._stages, len(self.robot.actuator_names))

    @property
    def tendons(self) -> tuple[str, ...]:
        """Names of the tendons (C,)."""
        return self.robot.actuator_names[self._stages :]

    @cached_property
    def _stages(self) -> int:
        return 1 if self.robot.insertion else 0

    # --- what its numbers mean -----------------------------------------------------------

    def cable_lengths(self, lengths: Array) -> Array:
        """Lengths (..., C) [m] of whole cables: the robot counts them from the base plate, too."""
        return lengths[..., self._stages :]

    def place(self, model: Any, data: Any, lengths: Array) -> None:
        """Move the base plate to where the insertion stage is."""
        if self.robot.insertion:
            model.body_pos[data.body(BASE).id] = self._base(lengths)

    def pose(self, model: Any, data: Any, c: Array) -> None:
        """Put the robot into a configuration (n,), at rest."""
        self.place(model, data, c)
        data.qpos[:] = c[self._stages :]
        data.qvel[:] = 0.0

    def shape(self, data: Any) -> tuple[Array, Array]:
        """Guarded points (S, 3) in the world [m]; tip pose (4, 4)."""
        c = np.array(data.qpos)
        if self.robot.insertion:
            T = self.robot.T_w_b
            travel = (data.body(BASE).xpos - T[:3, 3]) @ T[:3, :3] @ self.robot.AXIS
            c = np.concatenate([[travel], c])
        return self.robot.shape(c)

    def _base(self, lengths: Array) -> Array:
        """Where the base plate is in the world (3,) [m]; insertion is the first actuator."""
        T = self.robot.T_w_b
        travel = lengths[0] if self.robot.insertion else 0.0
        return T[:3, 3] + travel * (T[:3, :3] @ self.robot.AXIS)

    # --- the model -----------------------------------------------------------------------

    @cached_property
    def spec(self) -> Any:
        """The model (MjSpec), not compiled."""
        mujoco, robot = require_mujoco(), self.robot
        spec = mujoco.MjSpec()
        spec.modelname = robot.name
        spec.compiler.degree = False
        spec.compiler.balanceinertia = False
        body = spec.worldbody.add_body(name=BASE, pos=self._base(robot.home))
        mujoco.mju_mat2Quat(body.quat, robot.T_w_b[:3, :3].ravel())
        self._add_cylinder(body, "base plate", -PLATE, PLATE, touches=False)
        self._add_holes(body, 0, REAR, 0.0)
        place = robot.plate_offset  # of the first joint; then from joint to joint
        for i in range(1, robot.joints + 1):
            body = body.add_body(name=f"module {i}", pos=(0.0, place, 0.0))
            self._add_module(body, i)
            place = robot.link_length
        self._add_tip(body)
        for k in range(1, robot.joints + 1):
            for j in range(CABLES):
                self._add_tendon(spec, k, j)
        return spec

    def _add_module(self, body: Any, i: int) -> None:
        robot, mechanics = self.robot, self.robot.mechanics
        for axis, angle in zip(robot.orders[i - 1].axes, robot.orders[i - 1].angles, strict=True):
            body.add_joint(
                name=f"joint {i} {angle}",
                axis=AXES[axis],
                damping=(mechanics.joint_damping, 0.0, 0.0),
                armature=mechanics.joint_armature,
            )
        front, rear = robot.plate_offset, robot.plate_offset + robot.tube_length
        # A thin tube; its endplates add to the mass alone.
        across = mechanics.module_mass * (robot.radius**2 / 2.0 + robot.tube_length**2 / 12.0)
        body.explicitinertial = True
        body.mass, body.ipos = mechanics.module_mass, (0.0, 0.5 * (front + rear), 0.0)
        body.inertia = (across, mechanics.module_mass * robot.radius**2, across)
        self._add_cylinder(body, f"tube {i}", front, rear, touches=True)
        self._add_holes(body, i, FRONT, front)
        self._add_holes(body, i, REAR, rear)

    def _add_cylinder(
        self, body: Any, name: str, start: float, end: float, *, touches: bool
    ) -> None:
        """A body of the modules' radius along y, from start to end [m]."""
        body.add_geom(
            name=name,
            type=require_mujoco().mjtGeom.mjGEOM_CYLINDER,
            fromto=(0.0, start, 0.0, 0.0, end, 0.0),
            size=(self.robot.radius, 0.0, 0.0),
            mass=0.0,
            contype=BODY_TYPE,
            conaffinity=BODY_AFFINITY if touches else 0,
            rgba=(0.6, 0.6, 0.65, 0.5),
        )

    def _add_tip(self, last: Any) -> None:
        """The massless body at the tip; a tool reaches there from the last plate."""
        plate = np.array([0.0, self.robot.plate_offset + self.robot.tube_length, 0.0])
        tool = self.robot.tool
        offset = np.array(tool.offset) if tool else np.zeros(3)
        if tool and np.any(offset):
            last.add_geom(
                name="tool",
                type=require_mujoco().mjtGeom.mjGEOM_CAPSULE,
                fromto=np.concatenate([plate, plate + offset]),
                size=(tool.radius, 0.0, 0.0),
                mass=0.0,
                contype=BODY_TYPE,
                conaffinity=BODY_AFFINITY,
            )
        last.add_body(name=TIP, pos=plate + offset)

    # --- cables --------------------------------------------------------------------------

    @cached_property
    def _holes(self) -> Array:
        """Of every module's cables in the plane of a plate (N, 3, 3) [m]."""
        angles = hole_angles(self.robot.joints, self.robot.holes)
        return hole_offsets(angles, self.robot.radius)

    def _add_holes(self, body: Any, plate: int, side: str, y: float) -> None:
        """Of all cables that pass the plate, which lies at y [m] in the frame of its body."""
        for k in range(max(plate, 1), self.robot.joints + 1):
            for j in range(CABLES):
                place = self._holes[k - 1, j] + (0.0, y, 0.0)
                body.add_site(name=_hole(plate, side, k, j), pos=place, size=(HOLE, 0.0, 0.0))

    def _add_tendon(self, spec: Any, k: int, j: int) -> None:
        """Cable j of module k: from the base plate to the module's rear plate (7)."""
        tendon = spec.add_tendon(name=self.tendons[CABLES * (k - 1) + j], width=CABLE)
        tendon.wrap_site(_hole(0, REAR, k, j))
        for plate in range(1, k + 1):
            tendon.wrap_site(_hole(plate, FRONT, k, j))
            tendon.wrap_site(_hole(plate, REAR, k, j))


def _hole(plate: int, side: str, k: int, j: int) -> str:
    return f"plate {plate} {side} hole {k} {j + 1}"
