"""Teleoperation of a scenario: the parts between the operator's hand and the robot's target."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.scenario.links import bounds_of, link_of, receiver_of
from sinuous.scenario.teleop_tables import (
    ForceTable,
    HandChoice,
    MappingTable,
    OperatorTable,
    SchemeChoice,
    Space,
    TeleopTable,
)
from sinuous.teleop.bilateral import Bilateral
from sinuous.teleop.boundary import BoxForce, ZoneForce
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.force import ErrorForce, ErrorForceAlong, Together, VirtualForce
from sinuous.teleop.held import HeldForce, NearForce
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.move_and_wait import MoveAndWait
from sinuous.teleop.operators import Goal, ImpedanceOperator, Operator, Prescribed
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.position_force import PositionForce
from sinuous.teleop.scheme import Scheme
from sinuous.teleop.trace import Trace
from sinuous.teleop.waves import ModifiedWaves, StandardWaves

PLANE, SPACE = ("x", "z"), ("x", "y", "z")

SETTLING = 0.5  # time that an operator gives the robot beyond the way there and back [s]


@dataclass(frozen=True, kw_only=True, eq=False)
class Teleoperation:
    """An operator's hand far away.

    Arguments:
        table: what the scenario says
        mpc: whose robot and zone it is for
        tip: where the tip starts (3,) [m]
        trace: recorded delays of the link, None for none
        seed: of what is random on the link
    """

    table: TeleopTable
    mpc: ShapeConstrainedMPC
    tip: Array
    trace: Trace | None = None
    seed: int = 0

    @property
    def dt(self) -> float:
        """Time of a tick [s]."""
        return 1.0 / self.table.rate

    @property
    def axes(self) -> tuple[str, ...]:
        """Names of the wave side's axes (A,)."""
        return PLANE if self.table.mapping.space is Space.PLANE else SPACE

    @property
    def is_free(self) -> bool:
        """Whether the operator follows the path in his own time."""
        return self.table.operator.kind is HandChoice.MOVE_AND_WAIT

    @property
    def patience(self) -> float:
        """How long everything must rest before there is nothing more to come [s]."""
        waits = self.table.operator.patience if self.is_free else 0.0
        return 2.0 * self.table.delay + waits + SETTLING

    @property
    def mapping(self) -> Mapping:
        """From the device's workspace to the world."""
        return _mapping(self.table.mapping, self.tip)

    def bilateral(self, goal: Goal, stops: Sequence[Array]) -> Bilateral[Any]:
        """Both ends and what is between them.

        Arguments:
            goal: where the hand wants to be (A,) [m], in the leader's coordinates, by time [s]
            stops: the same one by one, for an operator who moves and waits
        """
        table, mapping, protection = self.table, self.mapping, self.table.protection
        limit = table.operator.workspace
        felt, speed = bounds_of(table.limits)
        return Bilateral.connect(
            operator=_operator(table.operator, goal, stops),
            mapping=mapping,
            force=_force(table.force, mapping, self.mpc),
            scheme=_scheme(table),
            link=link_of(
                table.link, delay=table.delay, trace=self.trace, seed=self.seed, dt=self.dt
            ),
            receiver=None if protection is None else receiver_of(protection),
            control=PassivityControl() if protection and protection.enabled else None,
            felt=felt,
            speed=speed,
            device=LeaderDevice(mass=table.operator.mass, limit=inf if limit is None else limit),
            correction=table.correction
            and DriftCorrection(rate=table.correction.rate, speed=table.correction.speed),
        )


def _scheme(table: TeleopTable) -> Scheme:
    dt, waves = 1.0 / table.rate, table.waves
    match table.scheme:
        case SchemeChoice.STANDARD:
            return StandardWaves(impedance=waves.impedance, dt=dt)
        case SchemeChoice.C1:
            return ModifiedWaves.c1(impedance=waves.impedance, dt=dt)
        case SchemeChoice.C2:
            return ModifiedWaves(
                impedance=waves.impedance,
                gain=ModifiedWaves.gain if waves.gain is None else waves.gain,
                cutoff=ModifiedWaves.cutoff if waves.cutoff is None else waves.cutoff,
                dt=dt,
                allow_active=waves.allow_active,
            )
        case SchemeChoice.POSITION_FORCE:
            return PositionForce(local_damping=waves.impedance, dt=dt)


def _mapping(table: MappingTable, tip: Array) -> Mapping:
    if table.space is Space.PLANE:
        depth = float(tip[1]) if table.depth is None else table.depth
        return Mapping.plane(np.array(table.scale), depth)
    origin = tip if table.origin is None else np.array(table.origin)
    rotation = Rotation.from_euler("xyz", table.rotation).as_matrix()
    return Mapping.space(np.array(table.scale), origin, rotation)


def _operator(table: OperatorTable, goal: Goal, stops: Sequence[Array]) -> Operator[Any]:
    match table.kind:
        case HandChoice.TRAJECTORY:
            return Prescribed(goal)
        case HandChoice.IMPEDANCE:
            return ImpedanceOperator(goal, stiffness=table.stiffness, damping=table.damping)
        case HandChoice.MOVE_AND_WAIT:
            return MoveAndWait(
                stops=np.array(stops),
                moving=table.moving,
                patience=table.patience,
                tolerance=table.tolerance,
            )


def _force(table: ForceTable, mapping: Mapping, mpc: ShapeConstrainedMPC) -> VirtualForce:
    """The error's force: per axis in the paper's plane, along the error in space; then walls."""
    kind = ErrorForce if mapping.scale.size == len(PLANE) else ErrorForceAlong
    parts: list[VirtualForce] = [kind(gain=table.gain, length=table.length)]
    if table.boundary is not None:
        low, high = np.array(table.boundary).T
        parts.append(BoxForce(low=low, high=high, stiffness=table.stiffness, damping=table.damping))
    if table.zone and mpc.zone.surfaces:
        parts.append(
            ZoneForce(
                zone=mpc.zone,
                mapping=mapping,
                distance=float(mpc.robot.required_distance(mpc.margin)[-1]),
                stiffness=table.stiffness,
                damping=table.damping,
            )
        )
    if table.constraints:
        parts.append(HeldForce(mapping=mapping, stiffness=table.stiffness, damping=table.damping))
    if table.nearness > 0.0:
        parts.append(NearForce(mapping=mapping, stiffness=table.stiffness))
    return Together(tuple(parts)) if len(parts) > 1 else parts[0]
