"""Robots of segments as MuJoCo models: an elastic backbone of links, cables through its disks.

Taut cables resist twist much more than the backbone does: a gap g with cables of tension T at the
distance d has sum T d^2 / g. The engine knows nothing of that stiffness before it has turned, and
over a tick h it overshoots unless the twist is damped by half of h times that stiffness.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.plants.physics.body import BODY_AFFINITY, BODY_TYPE
from sinuous.plants.physics.engine import require_mujoco
from sinuous.plants.physics.rod_links import Link
from sinuous.plants.physics.rod_reading import RodReading
from sinuous.robots.mechanics import CableMechanics
from sinuous.robots.pcc import PccRobot

BASE, TIP = "base", "tip"
HOLE = 0.0003  # radius at which holes are drawn [m]
CABLE = 0.0002  # and cables
LONGEST_TICK = 0.01  # for which twist is damped enough [s]
TAUT = 1e-3  # stretch of all cables for which it is [m]


class _Cell(NamedTuple):
    """Where a link is: segment, gap before a disk of it, place in the gap; the first are 0."""

    segment: int
    gap: int
    place: int


@dataclass(frozen=True, kw_only=True, eq=False)
class RodBody:
    """A robot of constant-curvature segments for MuJoCo; see `PhysicalBody`.

    The backbone is cut into links, two for each gap between disks if nothing else is asked for;
    the links of a gap share one hinge for its twist. The base is a body that the insertion stage
    moves. A segment that changes its length moves its links' frames and hinges apart, and longer
    links bend more easily; its mass stays that of its home length.
    """

    robot: PccRobot

    @property
    def tip_body(self) -> str:
        """Name of the body whose origin is the tip."""
        return TIP

    @property
    def mechanics(self) -> CableMechanics:
        """Of all cables."""
        return self.robot.mechanics.cables

    @cached_property
    def reading(self) -> RodReading:
        """What the model's numbers mean."""
        return RodReading(robot=self.robot)

    @property
    def cables(self) -> IntArray:
        """Which of the robot's actuators are cables (C,)."""
        return self.reading.cables

    @property
    def tendons(self) -> tuple[str, ...]:
        """Names of the tendons (C,)."""
        return tuple(self.robot.actuator_names[k] for k in self.cables)

    # --- what its numbers mean -----------------------------------------------------------

    def cable_lengths(self, lengths: Array) -> Array:
        """Lengths (..., C) [m] of whole cables; see `RodReading.cable_lengths`."""
        return self.reading.cable_lengths(lengths)

    def place(self, model: Any, data: Any, lengths: Array) -> None:
        """Move the base to where the stage is, and give every segment its length."""
        if not self._moves:
            return
        c = self.reading.configuration(lengths)
        if self.robot.insertion:
            model.body_pos[1] = self.reading.base(c)
        h = self.reading.link_lengths(c)[self._segment]
        model.body_pos[2 : len(h) + 2, 2] = h
        joint = h[self._link]
        model.jnt_pos[:, 2] = -0.5 * joint
        model.jnt_stiffness[:] = self._compliant / joint

    def pose(self, model: Any, data: Any, c: Array) -> None:
        """Put the robot into a configuration (n,), at rest."""
        self.place(model, data, self.robot.lengths(c))
        turn = self.reading.link_bends(c)[self._segment][self._link]
        about = np.stack([-turn[:, 1], turn[:, 0], np.zeros(len(turn))], axis=1)
        data.qpos[:] = about[np.arange(len(turn)), self._axis]
        data.qvel[:] = 0.0

    def shape(self, data: Any) -> tuple[Array, Array]:
        """Guarded points (S, 3) in the world [m]; tip pose (4, 4)."""
        ours = slice(1, len(self._links) + 3)  # base, links, tip
        p, R = data.xpos[ours], data.xmat[ours].reshape(-1, 3, 3)
        T_w_t = np.eye(4)
        T_w_t[:3, :3], T_w_t[:3, 3] = R[-1], p[-1]
        return self.reading.points(p, R[:, :, 2]), T_w_t

    # --- links ---------------------------------------------------------------------------

    @property
    def _moves(self) -> bool:
        """Whether other actuators than cables do anything."""
        return len(self.cables) < len(self.robot.actuator_names)

    @cached_property
    def _cells(self) -> list[_Cell]:
        """All links from base to tip."""
        return [
            _Cell(segment, gap, place)
            for segment, each in enumerate(self.robot.segments)
            for gap in range(each.disks)
            for place in range(self._per_gap)
        ]

    @property
    def _per_gap(self) -> int:
        return self.robot.mechanics.links_per_gap

    @cached_property
    def _links(self) -> list[Link]:
        """The links at home, from base to tip."""
        mechanics, links = self.robot.mechanics, list[Link]()
        for number, cell in enumerate(self._cells):
            segment = self.robot.segments[cell.segment]
            length = segment.home_length / (self._per_gap * segment.disks)
            disk = self._is_disk(cell)
            links.append(
                Link(
                    rod=mechanics.backbone,
                    length=length,
                    reversed=number % 2 == 1,
                    twist_length=self._per_gap * length if self._twists(cell) else 0.0,
                    damping=mechanics.damping,
                    twist_damping=self._twist_damping,
                    last=number == len(self._cells) - 1,
                    disk_mass=mechanics.disk_mass if disk else 0.0,
                    disk_radius=segment.body_radius,
                )
            )
        return links

    @cached_property
    def _segment(self) -> IntArray:
        """Segment of every link."""
        return np.array([cell.segment for cell in self._cells])

    @cached_property
    def _link(self) -> IntArray:
        """Link of every hinge."""
        return np.repeat(np.arange(len(self._links)), [len(link.axes) for link in self._links])

    @cached_property
    def _axis(self) -> IntArray:
        """Axis of every hinge."""
        return np.array([axis for link in self._links for axis in link.axes])

    @cached_property
    def _compliant(self) -> Array:
        """Stiffness of every hinge times the length of its link [N m^2/rad]."""
        return np.array([k.stiffness(axis) * k.length for k in self._links for axis in k.axes])

    @cached_property
    def _twist_damping(self) -> float:
        """Of every hinge for twist [N m s/rad]: as much as taut cables need, see the module."""
        nearest = min(s.home_length / s.disks for s in self.robot.segments)
        spread = sum(np.hypot(*hole.offset) ** 2 for hole in self.reading.holes)
        return 0.5 * LONGEST_TICK * TAUT * self.mechanics.stiffness * float(spread) / nearest

    def _is_disk(self, cell: _Cell) -> bool:
        return cell.place == self._per_gap - 1

    def _twists(self, cell: _Cell) -> bool:
        """Whether it has the hinge for the twist of its gap."""
        return cell.place == self._per_gap // 2

    # --- the model -----------------------------------------------------------------------

    @cached_property
    def spec(self) -> Any:
        """The model (MjSpec), not compiled."""
        mujoco, robot = require_mujoco(), self.robot
        spec = mujoco.MjSpec()
        spec.modelname = robot.name
        spec.compiler.degree = False
        spec.compiler.balanceinertia = False
        body = spec.worldbody.add_body(name=BASE, pos=self.reading.base(robot.home))
        mujoco.mju_mat2Quat(body.quat, robot.T_w_b[:3, :3].ravel())
        self._add_holes(body, 0, 0)
        for cell, link in zip(self._cells, self._links, strict=True):
            gap = f"segment {cell.segment + 1} disk {cell.gap + 1}"
            disk = self._is_disk(cell)
            body = link.add_to(body, gap if disk else f"{gap} before {cell.place + 1}")
            if disk:
                self._add_disk(body, cell, link)
                self._add_holes(body, cell.segment, cell.gap + 1)
        self._add_tip(body)
        for number, cable in enumerate(self.reading.holes):
            self._add_tendon(spec, number, cable.segment)
        return spec

    def _add_disk(self, body: Any, cell: _Cell, link: Link) -> None:
        """What touches walls: as thick as the disk, and as long as the way to the next ones."""
        segment, reach = self.robot.segments[cell.segment], 0.5 * self._per_gap * link.length
        body.add_geom(
            type=require_mujoco().mjtGeom.mjGEOM_CYLINDER,
            fromto=(0.0, 0.0, -reach, 0.0, 0.0, 0.0 if link.last else reach),
            size=(segment.body_radius, 0.0, 0.0),
            mass=0.0,
            contype=BODY_TYPE,
            conaffinity=BODY_AFFINITY,
            rgba=(0.6, 0.6, 0.65, 0.5),
        )

    def _add_tip(self, last: Any) -> None:
        """The massless body at the tip; a tool reaches there from the last disk."""
        tool = self.robot.tool
        offset = np.array(tool.offset) if tool else np.zeros(3)
        if tool and np.any(offset):
            last.add_geom(
                name="tool",
                type=require_mujoco().mjtGeom.mjGEOM_CAPSULE,
                fromto=np.concatenate([np.zeros(3), offset]),
                size=(tool.radius, 0.0, 0.0),
                mass=0.0,
                contype=BODY_TYPE,
                conaffinity=BODY_AFFINITY,
            )
        last.add_body(name=TIP, pos=offset)

    def _add_holes(self, body: Any, segment: int, disk: int) -> None:
        """Of all cables that pass a disk; the base's is disk 0 of the first segment."""
        for number, cable in enumerate(self.reading.holes):
            if cable.segment >= segment:
                body.add_site(
                    name=_hole(segment, disk, number),
                    pos=(*cable.offset, 0.0),
                    size=(HOLE, 0.0, 0.0),
                )

    def _add_tendon(self, spec: Any, number: int, last: int) -> None:
        """A cable from the base through all disks to the last one of its segment."""
        tendon = spec.add_tendon(name=self.tendons[number], width=CABLE)
        tendon.wrap_site(_hole(0, 0, number))
        for j in range(last + 1):
            for disk in range(1, self.robot.segments[j].disks + 1):
                tendon.wrap_site(_hole(j, disk, number))


def _hole(segment: int, disk: int, number: int) -> str:
    return f"segment {segment + 1} disk {disk} hole {number + 1}"
