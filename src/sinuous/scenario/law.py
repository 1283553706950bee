"""Controllers of a scenario other than the plain plan, made from its `ShapeConstrainedMPC`."""

from dataclasses import dataclass
from typing import Any

from sinuous.control.controller import Controller
from sinuous.control.dls import DampedLeastSquares
from sinuous.control.hierarchical import HierarchicalController
from sinuous.control.local import LocalController
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.offset_free import OffsetFree
from sinuous.control.projected import ProjectedTarget


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
        gain, damping: k_j and c_w of (30)
    """

    gain: float
    damping: float

    def __call__(self, mpc: ShapeConstrainedMPC) -> Controller[Any]:
        """The controller for the same robot, zone, margin and rate."""
        return DampedLeastSquares(
            mpc.robot,
            mpc.zone,
            margin=mpc.margin,
            dt=mpc.dt,
            gain=self.gain,
            damping=self.damping,
        )


@dataclass(frozen=True, kw_only=True)
class Projected:
    """A controller whose target is projected onto the zone: `ProjectedTarget`.

    Arguments:
        law: makes the controller, None for the plan itself
    """

    law: Feedback | Reference | None

    def __call__(self, mpc: ShapeConstrainedMPC) -> Controller[Any]:
        """The controller behind the projection."""
        return ProjectedTarget(mpc if self.law is None else self.law(mpc))
