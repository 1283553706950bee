"""Both ends of a cell of `sinuous bench link`, and its row."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from sinuous.bench.link_drive import Trace, drive, judge
from sinuous.bench.link_follower import Place, place
from sinuous.bench.link_grid import Cell, SchemeName
from sinuous.bench.link_hand import DURATION
from sinuous.bench.link_summary import LARGEST, worst_of
from sinuous.bench.result import Row
from sinuous.teleop.bilateral import Bilateral
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import LinkModel
from sinuous.teleop.operators import Operator
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.position_force import PositionForce
from sinuous.teleop.receivers import Hold
from sinuous.teleop.scheme import Scheme
from sinuous.teleop.waves import ModifiedWaves, StandardWaves

LONGEST = 46.0  # how long what does not come to rest is watched [s]
CAP = Limits(size=LARGEST)  # of the force from afar, under passivity control
IMPEDANCE = 10.0  # b of all schemes of waves [N s/m]


def scheme(name: SchemeName, dt: float) -> Scheme:
    """The scheme of that name, with ticks of dt [s]."""
    match name:
        case SchemeName.STANDARD:
            return StandardWaves(impedance=IMPEDANCE, dt=dt)
        case SchemeName.C1:
            return ModifiedWaves.c1(impedance=IMPEDANCE, dt=dt)
        case SchemeName.C2:
            return ModifiedWaves.c2(impedance=IMPEDANCE, dt=dt)
        case SchemeName.POSITION_FORCE:
            return PositionForce(dt=dt)


def connect(
    where: Place,
    scheme: Scheme,
    operator: Operator[Any],
    link: LinkModel,
    *,
    control: bool,
    correction: bool,
) -> Bilateral[Any]:
    """Both ends; each repeats the newest wave until a newer one comes.

    Arguments:
        where: it takes place
        scheme: of the waves
        operator: whoever holds the device
        link: of both ways
        control: of passivity
        correction: of drift
    """
    both = Bilateral.connect(
        operator=operator,
        mapping=where.mapping,
        force=where.force,
        scheme=scheme,
        link=link,
        receiver=Hold(),
        control=PassivityControl() if control else None,
        correction=DriftCorrection() if correction else None,
    )
    return replace(both, leader=replace(both.leader, limits=CAP)) if control else both


def row(
    cell: Cell, operators: Sequence[Operator[Any]], link: LinkModel, dt: float, duration: float
) -> Row:
    """What a cell says: the worst of those who tried.

    Arguments:
        operators: one or more
        link: of both ways
        dt: time of a tick [s]
        duration: of a run [s]
    """
    found = list[Row]()
    for operator in operators:
        trace = _run(cell, operator, link, dt, duration)
        found.append(judge(trace, dt, cell.connection.delay, duration))
    return {**about(cell), **worst_of(found)}


def _run(cell: Cell, operator: Operator[Any], link: LinkModel, dt: float, duration: float) -> Trace:
    where = place(cell.contact, dt)
    own = scheme(cell.scheme, dt)
    both = connect(where, own, operator, link, control=cell.control, correction=cell.control)
    return drive(
        both,
        where.follower,
        where.tip_w,
        duration,
        longest=LONGEST if duration >= DURATION else 0.0,
    )


def about(cell: Cell) -> Row:
    """What a row is of."""
    connection = cell.connection
    return {
        "scheme": cell.scheme.value,
        "passivity_control": cell.control,
        "delay_s": connection.delay,
        "jitter_s": connection.spread,
        "jitter": connection.jitter,
        "loss": connection.loss,
        "trouble": connection.trouble.value,
        "operator": cell.hand.value,
        "contact": cell.contact.value,
    }
