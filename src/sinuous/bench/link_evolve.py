"""Looking for energy under passivity control, where no eigenvalue says what is worst.

With control the ports are no longer linear. The worst pairs without it are where to look: amounts
of several of them are drawn, and kept where less of what went through the channel stays in it.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.link_grid import Connection, SchemeName
from sinuous.bench.link_pairs import MOVING, TINY, Pairs, attempt, pairs
from sinuous.bench.result import Row
from sinuous.teleop.link import LinkModel

PAIRS = 6  # whose amounts are looked for
STEP, SUCCESS, FAILURE = 0.5, 1.5, 0.9  # of the amounts; its growth after each
BEGUN = 0.2  # before, no share of anything is judged [s]


def evolve(
    name: SchemeName,
    connection: Connection,
    link: LinkModel,
    dt: float,
    *,
    tries: int,
    rng: np.random.Generator,
    moving: float = MOVING,
) -> Row:
    """A (1 + 1) evolution strategy, from the worst pair on.

    Arguments:
        tries: how many runs
        rng: of what is drawn
        moving: how long both ends act [s]
    """
    family = pairs(name, link, dt, PAIRS, moving)
    best, step = np.eye(PAIRS)[0], STEP
    first = least = _try(name, link, family, best, dt)
    ledger = least.ledger
    for _ in range(tries):
        tried = best + step * np.linalg.norm(best) * rng.standard_normal(PAIRS)
        found = _try(name, link, family, tried, dt)
        ledger = min(ledger, found.ledger)
        if found.kept < least.kept:
            best, least, step = tried, found, step * SUCCESS
        else:
            step *= FAILURE
    return {
        "scheme": name.value,
        "delay_s": connection.delay,
        "jitter_s": connection.spread,
        "loss": connection.loss,
        "trouble": connection.trouble.value,
        "tries": tries,
        "kept_first": first.kept,
        "kept_least": least.kept,
        "ledger_min_j": ledger,
    }


class _Found(NamedTuple):
    """What a run came to.

    Arguments:
        kept: the least share, of the energy that has gone through either port, that the channel
            ever had in it
        ledger: the least energy of the channel [J]
    """

    kept: float
    ledger: float


def _try(name: SchemeName, link: LinkModel, family: Pairs, amounts: Array, dt: float) -> _Found:
    x, force, _ = family.mix(amounts, dt)
    trace = attempt(name, link, x, force, dt, control=True)
    power = np.abs(trace.F_m * trace.V) + np.abs(trace.F_s * trace.V_sd)
    through, begun = np.cumsum(power.sum(axis=1)) * dt, round(BEGUN / dt)
    kept = trace.energy[begun:] / np.maximum(through[begun:], TINY)
    return _Found(float(np.min(kept)), trace.least.channel)
