"""The complete controller (paper B, section II-E, eq. 29): plan, local feedback, offset."""

from dataclasses import KW_ONLY, dataclass, field, replace
from functools import cached_property

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control.local import LocalController
from sinuous.control.mpc import MPCState, ShapeConstrainedMPC
from sinuous.control.observed import Observed, is_finite, observe, remember
from sinuous.control.offset_free import OffsetFree
from sinuous.control.report import Command
from sinuous.control.saturation import attainable, speed_share
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.robots.robot import Robot


@dataclass(frozen=True, kw_only=True, eq=False)
class HierarchicalState:
    """What the controller remembers between steps.

    Arguments:
        nominal: state of the plan
        offset: of the real tip from the nominal one, as far as it was learned (3,) [m]
        past: configurations by the encoders at the end of the last steps, the newest last
    """

    nominal: MPCState
    offset: Array
    past: tuple[Array, ...] = ()

    @property
    def c(self) -> Array:
        """Nominal configuration (n,)."""
        return self.nominal.c


@dataclass(frozen=True, eq=False)
class HierarchicalController:
    """Adds feedback to a plan: u = u*[1|k] + K_loc(y*[k] - y[k]) (29).

    The plan uses a share of the actuators' speed, the local controller what the plan leaves.
    Limits that its sum would break are kept, see `attainable`; the command says how much they
    took.  Without a measurement the plan is on its own.

    A measurement that is not finite is a fault, and so is one that is too large to compute with:
    the robot holds still, and nothing is learned from it.

    Arguments:
        mpc: plans the nominal motion; its `rate_share` is replaced by what `local` leaves
        local: None to plan only
        offset_free: whether and how an offset is learned
    """

    mpc: ShapeConstrainedMPC
    _: KW_ONLY
    local: LocalController | None = field(default_factory=LocalController)
    offset_free: OffsetFree = field(default_factory=OffsetFree)

    @property
    def robot(self) -> Robot:
        """The robot as the model sees it."""
        return self.mpc.robot

    @property
    def zone(self) -> SafeZone:
        """The room it may use."""
        return self.mpc.zone

    @property
    def margin(self) -> float:
        """Least distance between the nominal body's surface and a wall [m]."""
        return self.mpc.margin

    @property
    def dt(self) -> float:
        """Time between steps [s]."""
        return self.mpc.dt

    @cached_property
    def planner(self) -> ShapeConstrainedMPC:
        """The plan's controller with its share of the speed limits."""
        share = 1.0 if self.local is None else 1.0 - self.local.share
        return replace(self.mpc, rate_share=share)

    def init(self, c: ArrayLike) -> HierarchicalState:
        """The state to start from, at rest at configuration c (n,).

        Raises:
            ValueError: if c has not the robot's coordinates
        """
        return HierarchicalState(nominal=self.planner.init(c), offset=np.zeros(3))

    def step(
        self, state: HierarchicalState, target: ArrayLike, measured: Measurement | None = None
    ) -> tuple[HierarchicalState, Command]:
        """One step towards target (3,) [m], given what was measured at its beginning."""
        if measured is None:
            return self._planned(state, target)
        if not is_finite(measured):
            return self._hold(state, "the measurement is not finite")
        try:
            with np.errstate(all="ignore"):
                after, command = self._fed_back(state, target, measured)
        except np.linalg.LinAlgError:
            return self._hold(state, "the measurement cannot be computed with")
        if not (np.all(np.isfinite(command.rates)) and np.all(np.isfinite(after.offset))):
            return self._hold(state, "the measurement cannot be computed with")
        return after, command

    def _hold(self, state: HierarchicalState, reason: str) -> tuple[HierarchicalState, Command]:
        nominal, command = self.planner.hold(state.nominal, reason)
        return replace(state, nominal=nominal, past=()), command

    def _fed_back(
        self, state: HierarchicalState, target: ArrayLike, measured: Measurement
    ) -> tuple[HierarchicalState, Command]:
        now = self.robot.configuration(measured.lengths)
        past = remember(state.past, now)
        seen = observe(self.robot, measured, past, self.dt)
        nominal_points = self.robot.points(state.c)
        offset = state.offset
        if self.offset_free.applies(has_shape=seen.has_shape):
            offset = self.offset_free.updated(offset, seen.tip - nominal_points[-1], self.dt)
        state = replace(state, offset=offset, past=past)
        after, command = self._planned(state, target)
        return after, self._corrected(command, seen, nominal_points, offset, measured.lengths)

    def _planned(
        self, state: HierarchicalState, target: ArrayLike
    ) -> tuple[HierarchicalState, Command]:
        aim = np.asarray(target, dtype=float)
        if aim.shape == state.offset.shape:  # of any other the plan says that it is no place
            aim = aim - state.offset
        nominal, command = self.planner.step(state.nominal, aim)
        return replace(state, nominal=nominal), replace(command, offset=state.offset)

    def _corrected(
        self, command: Command, seen: Observed, nominal_points: Array, offset: Array, lengths: Array
    ) -> Command:
        """The command with what the local controller adds, as far as limits allow."""
        local = np.zeros(len(lengths))
        if self.local is not None:
            # What was learned to be an offset is aimed around, not fought.
            goal = nominal_points.copy()
            goal[-1] += offset
            local = self.local.rates(self.robot, seen, goal, self.dt)
        asked = command.rates + local
        possible = command.rates + speed_share(self.robot, local, command.rates) * local
        rates = attainable(self.robot, lengths, possible, self.dt)
        size = float(np.linalg.norm(asked))
        lost = float(np.linalg.norm(asked - rates)) / size if size > 0.0 else 0.0
        return replace(command, rates=rates, local=rates - command.rates, clipped=min(lost, 1.0))
