"""Cables that stay taut: pulled together where one of them would go slack.

Pulling all cables of a segment alike bends nothing and raises every tension. Paper B names the
loss of tension as what its model suffers from most (section V): a slack cable does nothing, while
the model counts on it.
"""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, replace
from functools import cached_property
from typing import Generic, TypeVar

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control.around import Around
from sinuous.control.controller import ControllerState
from sinuous.control.report import Command, Status
from sinuous.control.saturation import speed_share
from sinuous.measurement import Measurement
from sinuous.robots.cables import cable_rows, co_contractions

S = TypeVar("S", bound=ControllerState)

Estimate = Callable[[Array, Array], Array]
"""Tensions (C,) [N] at a configuration (n,) with cables pulled in by (C,) [m]."""


@dataclass(frozen=True, kw_only=True, eq=False)
class TautState(Generic[S]):
    """What the controller remembers between steps.

    Arguments:
        inner: state of the controller whose cables are kept taut
        pulled: by how much each group of cables is pulled in (G,) [m]
    """

    inner: S
    pulled: Array

    @property
    def c(self) -> Array:
        """Nominal configuration (n,)."""
        return self.inner.c


@dataclass(frozen=True, eq=False)
class TautCables(Around[S]):
    """Keeps every cable above a least tension, beside any controller.

    Each group of cables that bends nothing when pulled together (`robots.cables`) is pulled in
    until its least tension is the floor, and let out again when there is more than that:

        d pulled / dt = (floor - least tension) / (stiffness x time constant),  0 <= pulled <= most.

    The controller inside reads lengths without what is pulled in, so its model holds, and its
    rates have priority over the pulling, limits of length hold for what is pulled in as well, and
    while the controller holds still nothing is pulled. Tensions are those measured, else those
    estimated; without either nothing is done.

    Arguments:
        controller: any controller
        floor: least tension [N]
        stiffness: of a cable [N/m]
        time_constant: in which a tension comes to the floor [s]
        most: that a group is pulled in [m]
        estimate: of tensions, used where none are measured

    Raises:
        ValueError: if a number is not positive
    """

    _: KW_ONLY
    floor: float
    stiffness: float
    time_constant: float = 0.3
    most: float = 3e-3
    estimate: Estimate | None = None

    def __post_init__(self) -> None:
        for name in ("floor", "stiffness", "time_constant", "most"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise ValueError(f"{name} must be positive and finite, not {getattr(self, name)}")

    @cached_property
    def _cables(self) -> Array:
        """Which actuators are cables, as a matrix that picks them (C, P)."""
        return np.eye(len(self.robot.actuator_names))[cable_rows(self.robot)]

    @cached_property
    def _groups(self) -> Array:
        """Shares (G, C) of what is pulled in."""
        return co_contractions(self.robot)

    def init(self, c: ArrayLike) -> TautState[S]:
        """The state to start from, at rest at configuration c (n,), with nothing pulled in."""
        return TautState(inner=self.controller.init(c), pulled=np.zeros(len(self._groups)))

    def step(
        self, state: TautState[S], target: ArrayLike, measured: Measurement | None = None
    ) -> tuple[TautState[S], Command]:
        """One step towards target (3,) [m], given what was measured at its beginning."""
        shift = state.pulled @ self._groups
        seen = measured
        if measured is not None:
            seen = replace(measured, lengths=measured.lengths + shift @ self._cables)
        inner, command = self.controller.step(state.inner, target, seen)
        tensions = self._tensions(inner, measured, shift)
        still = command.report.status is Status.HOLDING
        if still or not len(tensions) or not np.all(np.isfinite(tensions)):
            return replace(state, inner=inner), command
        pulled = self._pulled(state.pulled, tensions, command, self._room(inner.c))
        rates = command.rates - (pulled - state.pulled) @ self._groups @ self._cables / self.dt
        return TautState(inner=inner, pulled=pulled), replace(
            command, rates=rates, tensions=tensions
        )

    def _tensions(self, inner: S, measured: Measurement | None, shift: Array) -> Array:
        """Of the cables (C,) [N]; (0,) if nothing is known of them."""
        if measured is not None and len(measured.tensions):
            return measured.tensions
        return np.zeros(0) if self.estimate is None else self.estimate(inner.c, shift)

    def _room(self, c: Array) -> Array:
        """What each group may be pulled in, so that no cable gets shorter than it may (G,) [m]."""
        room = self._cables @ (self.robot.lengths(c) - self.robot.length_limits[:, 0])
        shares = self._groups
        each = np.where(shares > 0.0, room / np.where(shares > 0.0, shares, 1.0), np.inf)
        return np.clip(np.min(each, axis=1), 0.0, self.most)

    def _pulled(self, before: Array, tensions: Array, command: Command, room: Array) -> Array:
        """What is pulled in after the step (G,) [m]."""
        least = np.min(np.where(self._groups > 0.0, tensions, np.inf), axis=1)
        speed = (self.floor - least) / (self.stiffness * self.time_constant)
        change = np.clip(before + self.dt * speed, 0.0, room) - before
        rates = -change @ self._groups @ self._cables / self.dt
        return before + speed_share(self.robot, rates, command.rates) * change
