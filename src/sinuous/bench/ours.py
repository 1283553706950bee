"""Our controller as a participant."""

import dataclasses
from dataclasses import dataclass
from typing import Any, Self

from sinuous.arrays import Array
from sinuous.bench.loop import Outcome
from sinuous.bench.scene import Scene
from sinuous.control.mpc import Costs, MPCState, ShapeConstrainedMPC
from sinuous.control.report import Command, Status
from sinuous.robots.pcc import PccRobot


@dataclass(frozen=True, kw_only=True, eq=False)
class DisksOnly(PccRobot):
    """Guards its disk centres alone, with no allowance for what lies between (18)."""

    @classmethod
    def of(cls, robot: PccRobot) -> Self:
        """The same robot, guarded so."""
        fields: dict[str, Any] = {f.name: getattr(robot, f.name) for f in dataclasses.fields(robot)}
        longest = max(segment.length[1] / segment.disks for segment in robot.segments)
        fields["spacing"] = longest
        return cls(**fields)

    def required_distance(self, margin: float) -> Array:
        """Radius and margin [m] (S,)."""
        return self.radii + margin


@dataclass(frozen=True, kw_only=True, eq=False)
class OurState:
    """State of the controller, and what it last said."""

    mpc: MPCState
    command: Command | None = None

    @property
    def c(self) -> Array:
        """Configuration (n,)."""
        return self.mpc.c


@dataclass(frozen=True, kw_only=True, eq=False)
class Ours:
    """`ShapeConstrainedMPC` with the costs of the scene."""

    mpc: ShapeConstrainedMPC

    @classmethod
    def of(cls, scene: Scene, horizon: int, *, disks_only: bool) -> Self:
        """The controller for a scene."""
        mpc = ShapeConstrainedMPC(
            DisksOnly.of(scene.robot) if disks_only else scene.robot,
            scene.zone,
            margin=scene.margin,
            dt=scene.dt,
            horizon=horizon,
            costs=Costs.printed(),
        )
        return cls(mpc=mpc)

    def init(self, c: Array) -> OurState:
        """At rest at c (n,)."""
        return OurState(mpc=self.mpc.init(c))

    def step(self, state: OurState, target: Array) -> OurState:
        """One step."""
        after, command = self.mpc.step(state.mpc, target)
        return OurState(mpc=after, command=command)

    def outcome(self, state: OurState) -> Outcome:
        """What the report says."""
        if state.command is None:
            return Outcome(iterations=0)
        report = state.command.report
        held = report.status is Status.HOLDING
        return Outcome(
            iterations=report.iterations,
            failure=report.reason if held else "",
            status=report.status.name,
        )
