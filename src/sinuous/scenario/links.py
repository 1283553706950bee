"""Networks of a scenario, and what both ends do about them, from their tables."""

from math import isinf

from sinuous.scenario.link_tables import (
    BoundsTable,
    LinkTable,
    PassivityTable,
    ReceiverChoice,
)
from sinuous.teleop.delays import Steady, UniformJitter, Varying
from sinuous.teleop.impaired import Effect, ImpairedLink
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import ConstantDelay, LinkModel
from sinuous.teleop.losses import BurstLoss, Duplication, Outages, RandomLoss
from sinuous.teleop.receivers import Hold, Interpolated, Receiver, ZeroFill
from sinuous.teleop.trace import Trace


def link_of(
    table: LinkTable | None, *, delay: float, trace: Trace | None, seed: int, dt: float
) -> LinkModel:
    """The connection, the same kind both ways.

    Arguments:
        delay: of every packet [s]
        trace: recorded delays on top of it, None for none
        seed: of what is random
        dt: time of a tick [s]
    """
    if table is None:
        return ConstantDelay(delay=delay, dt=dt)
    effects: list[Effect] = [Steady(delay)]
    if table.course:
        effects.append(Varying(table.course))
    if trace is not None:
        effects.append(trace)
    if table.jitter > 0.0:
        effects.append(UniformJitter(table.jitter))
    if table.loss > 0.0:
        burst = table.burst
        effects.append(
            RandomLoss(table.loss) if burst is None else BurstLoss.of(table.loss, length=burst)
        )
    if table.outages:
        effects.append(Outages(table.outages))
    if table.duplication > 0.0:
        effects.append(Duplication(share=table.duplication))
    return ImpairedLink(effects=tuple(effects), seed=seed, in_order=table.in_order, dt=dt)


def receiver_of(table: PassivityTable) -> Receiver:
    """How an end fills the ticks in which no packet comes."""
    match table.receiver:
        case ReceiverChoice.ZERO:
            return ZeroFill()
        case ReceiverChoice.HOLD:
            return Hold(longest=table.hold)
        case ReceiverChoice.INTERPOLATE:
            assert table.playout is not None
            return Interpolated(delay=table.playout, longest=table.hold)


def bounds_of(table: BoundsTable | None) -> tuple[Limits | None, Limits | None]:
    """Limits of the force felt and of the desired speed, None for none."""
    if table is None:
        return None, None
    return _limits(table.force, table.force_time), _limits(table.speed, table.speed_time)


def _limits(size: float, time: float) -> Limits | None:
    if isinf(size):
        return None
    return Limits(size=size, slew=size / time if time > 0.0 else float("inf"))
