"""Controllers other than the plain plan, made from a scenario's `ShapeConstrainedMPC`."""

from dataclasses import dataclass
from typing import Any

from sinuous.control.cable_loop import CableLoop
from sinuous.control.controller import Controller
from sinuous.control.dls import DampedLeastSquares
from sinuous.control.geometric_ik import GeometricIK
from sinuous.control.hierarchical import HierarchicalController
from sinuous.control.local import LocalController
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.offset_free import OffsetFree
from sinuous.control.pid import Pid
from sinuous.control.projected import ProjectedTarget
from sinuous.control.tension import TautCables
from sinuous.control.tension_estimate import BackboneTensions
from sinuous.control.transmission import Transmission
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot import Robot
from sinuous.scenario.control_tables import ControlTable, LawChoice, LocalTable, OffsetFreeTable


@dataclass(frozen=True, kw_only=True)
class Feedback:
    """The plan with feedback: `HierarchicalController`.

    Arguments:
        local: None for none
        offset_free: whether and how an offset is learned
    """

    local: LocalController | None
    offset_free: OffsetFree

    def __call__(self, mpc: ShapeConstrainedMPC) -> Controller[Any]:
        """The controller around this plan."""
        return HierarchicalController(mpc, local=self.local, offset_free=self.offset_free)


@dataclass(frozen=True, kw_only=True)
class Reference:
    """The reference controller in the plan's stead: `DampedLeastSquares`.

    Arguments:
        gain, damping, penalty: k_j, c_w and dh/du by dh/dx of (30)
    """

    gain: float
    damping: float
    penalty: float

    def __call__(self, mpc: ShapeConstrainedMPC) -> Controller[Any]:
        """The controller for the same robot, zone, margin and rate."""
        return DampedLeastSquares(
            mpc.robot,
            mpc.zone,
            margin=mpc.margin,
            dt=mpc.dt,
            gain=self.gain,
            damping=self.damping,
            penalty=self.penalty,
        )


@dataclass(frozen=True, kw_only=True)
class ByCables:
    """Geometric inverse kinematics and PIDs in the plan's stead: `CableLoop`.

    Arguments:
        pid, transmission: of the cables
        dt: of a tick [s]
    """

    pid: Pid
    transmission: Transmission
    dt: float

    def __call__(self, mpc: ShapeConstrainedMPC) -> Controller[Any]:
        """The controller for the same robot, zone and margin.

        Raises:
            ValueError: if the robot is none that geometric inverse kinematics can solve
        """
        if not isinstance(mpc.robot, JointedRobot):
            raise ValueError("geometric inverse kinematics needs a robot of rigid modules")
        return CableLoop(
            GeometricIK(mpc.robot),
            mpc.zone,
            margin=mpc.margin,
            pid=self.pid,
            transmission=self.transmission,
            dt=self.dt,
        )


Law = Feedback | Reference | ByCables


@dataclass(frozen=True, kw_only=True)
class Projected:
    """A controller whose target is projected onto the zone: `ProjectedTarget`.

    Arguments:
        law: makes the controller, None for the plan itself
    """

    law: Law | None

    def __call__(self, mpc: ShapeConstrainedMPC) -> Controller[Any]:
        """The controller behind the projection."""
        return ProjectedTarget(mpc if self.law is None else self.law(mpc))


@dataclass(frozen=True, kw_only=True)
class Taut:
    """A controller whose cables are kept taut: `TautCables`.

    Arguments:
        law: makes the controller, None for the plan itself
        floor: least tension [N]
        time_constant: in which it is reached [s]
        most: that cables are pulled in [m]
        estimate: whether tensions are estimated where none are measured
    """

    law: Law | Projected | None
    floor: float
    time_constant: float
    most: float
    estimate: bool

    def __call__(self, mpc: ShapeConstrainedMPC) -> Controller[Any]:
        """The controller with what keeps its cables taut.

        Raises:
            ValueError: if tensions cannot be estimated for this robot
        """
        robot = mpc.robot
        if not isinstance(robot, PccRobot | JointedRobot):
            raise ValueError("taut cables need a robot whose mechanics are known")
        return TautCables(
            mpc if self.law is None else self.law(mpc),
            floor=self.floor,
            stiffness=robot.mechanics.cables.stiffness,
            time_constant=self.time_constant,
            most=self.most,
            estimate=BackboneTensions(robot=segmented(robot)) if self.estimate else None,
        )


def segmented(robot: Robot) -> PccRobot:
    """The robot, if it is one of segments.

    Raises:
        ValueError: if it is not
    """
    if not isinstance(robot, PccRobot):
        raise ValueError("tensions are estimated by the backbone's stiffness, and joints have none")
    return robot


def law_of(table: ControlTable, *, seen: bool) -> Law | Projected | Taut | None:
    """What makes the controller, None for the plan alone.

    Arguments:
        seen: whether sensors say something of the robot that the plan does not know, so that
            the plan gets feedback even if no table says so
    """
    law, taut = _unprojected(table, seen=seen), table.taut
    law = Projected(law=law) if table.project_target else law
    if taut is None:
        return law
    return Taut(
        law=law,
        floor=taut.floor,
        time_constant=taut.time_constant,
        most=taut.most,
        estimate=taut.estimate,
    )


def _unprojected(table: ControlTable, *, seen: bool) -> Law | None:
    if table.law is LawChoice.DLS:
        return Reference(gain=table.dls.gain, damping=table.dls.damping, penalty=table.dls.penalty)
    if table.law is LawChoice.GEOMETRIC_IK:
        loop = table.cable_loop
        return ByCables(
            pid=Pid(
                proportional=loop.proportional,
                integral=loop.integral,
                derivative=loop.derivative,
                filter=loop.filter,
            ),
            transmission=Transmission(lead=loop.lead, ratio=loop.ratio, speed=loop.motor_speed),
            dt=1.0 / loop.rate,
        )
    if not seen and table.local is None and table.offset_free is None:
        return None
    local, offset = table.local or LocalTable(), table.offset_free or OffsetFreeTable()
    gains = LocalController(
        tip_gain=local.tip_gain,
        body_gain=local.body_gain,
        damping=local.damping,
        share=local.share,
    )
    return Feedback(
        local=gains if local.enabled else None,
        offset_free=OffsetFree(
            time_constant=offset.time_constant, limit=offset.limit, when=offset.when.when
        ),
    )
