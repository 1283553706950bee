"""What passivity control costs where there is nothing to control: on a clean connection."""

from sinuous.bench.link_drive import drive, judge
from sinuous.bench.link_follower import place
from sinuous.bench.link_grid import Connection, Contact, Hand, SchemeName
from sinuous.bench.link_hand import ARMS, DURATION, arm
from sinuous.bench.link_rig import connect, scheme
from sinuous.bench.link_summary import number
from sinuous.bench.result import Row
from sinuous.teleop.link import LinkModel

ERRORS = ("tracking_rms_m", "force_rms_n")


def cost(name: SchemeName, connection: Connection, link: LinkModel, dt: float) -> list[Row]:
    """Errors with control by those without, nothing else being different."""
    rows = list[Row]()
    for contact in (Contact.FREE, Contact.BOX):
        for hand in ARMS:
            with_, without = (
                _errors(name, connection, link, dt, contact, hand, control=control)
                for control in (True, False)
            )
            rows.append(
                {
                    "scheme": name.value,
                    "delay_s": connection.delay,
                    "contact": contact.value,
                    "operator": hand.value,
                    **{f"{key}_without": without[key] for key in ERRORS},
                    **{key: with_[key] for key in ERRORS},
                    "ledger_min_j_without": without["ledger_min_j"],
                    "unbounded_without": without["unbounded"],
                    **{f"{key}_change": _change(with_, without, key) for key in ERRORS},
                }
            )
    return rows


def _errors(
    name: SchemeName,
    connection: Connection,
    link: LinkModel,
    dt: float,
    contact: Contact,
    hand: Hand,
    *,
    control: bool,
) -> Row:
    where = place(contact, dt)
    both = connect(
        where, scheme(name, dt), arm(ARMS[hand], 1), link, control=control, correction=False
    )
    trace = drive(both, where.follower, where.tip_w, DURATION)
    return judge(trace, dt, connection.delay, DURATION)


def _change(with_: Row, without: Row, key: str) -> float:
    """By which share an error is larger with control; rounding alone counts as no change."""
    least = 1e-9
    return (number(with_, key) + least) / (number(without, key) + least) - 1.0
