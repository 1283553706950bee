"""The connections of `sinuous bench link` as links with effects."""

from sinuous.bench.link_grid import Connection, Trouble
from sinuous.teleop.delays import Steady, UniformJitter, Varying
from sinuous.teleop.impaired import Effect, ImpairedLink
from sinuous.teleop.link import ConstantDelay, LinkModel
from sinuous.teleop.losses import BurstLoss, Duplication, Outages

BURST = 10.0  # mean length of a burst of losses, in packets of 1 ms
OUTAGES = ((0.9, 2.9), (3.4, 5.4))  # while the hand moves out, and home [s]
STEPS = (0.9, 3.2, 4.6)  # when the delay steps up, down and up [s]
HIGHER = 0.1  # by how much [s]
DOUBLED = 0.1  # share of packets that arrive twice where order is lost, too


def model(connection: Connection, seed: int, dt: float) -> LinkModel:
    """Both ways of a connection.

    Arguments:
        seed: of its luck
        dt: time of a tick [s]
    """
    if connection.is_clean:
        return ConstantDelay(delay=connection.delay, dt=dt)
    trouble, spread = connection.trouble, connection.spread
    effects: list[Effect] = [_delay(connection)]
    if spread > 0.0:
        effects.append(UniformJitter(spread))
    if connection.loss > 0.0:
        effects.append(BurstLoss.of(connection.loss, length=BURST))
    if trouble is Trouble.REORDERING:
        effects.append(Duplication(share=DOUBLED, after=spread))
    if trouble is Trouble.OUTAGES:
        effects.append(Outages(OUTAGES))
    return ImpairedLink(
        effects=tuple(effects), seed=seed, in_order=trouble is not Trouble.REORDERING, dt=dt
    )


def _delay(connection: Connection) -> Effect:
    """The delay that jitter departs from."""
    low, high = connection.delay, connection.delay + HIGHER
    if connection.trouble is not Trouble.STEPS:
        return Steady(low)
    points, now = list[tuple[float, float]](), low
    for time in STEPS:
        points.append((time, now))
        now = high if now == low else low
        points.append((time, now))
    return Varying(tuple(points))
