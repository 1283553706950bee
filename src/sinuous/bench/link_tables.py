"""The tables of `sinuous bench link` on the screen; the JSON file has every row."""

from collections.abc import Callable, Iterable, Sequence
from itertools import product

from sinuous.bench import link_summary
from sinuous.bench.link_drift import KINDS
from sinuous.bench.link_grid import Contact, Hand, SchemeName, Trouble
from sinuous.bench.link_summary import FLOOR, makes_energy, number
from sinuous.bench.link_task import Found
from sinuous.bench.result import Column, Row, Table
from sinuous.view.units import MM_PER_M, MS_PER_S


def summary(found: Found) -> Table:
    """Every scheme, with and without control."""
    return link_summary.by_scheme(found.rows)


def failures(found: Found) -> Table:
    """Where schemes fail without control."""
    return link_summary.failures(found.rows)


def searches(found: Found) -> Table:
    """The worst operators of all connections, and what they took in their cells."""
    rows = list[Row]()
    for scheme, contact in product(SchemeName, Contact):
        own = _of(found.worst, scheme=scheme, contact=contact)
        tried = _of(
            found.rows, scheme=scheme, contact=contact, operator=Hand.WORST, passivity_control=False
        )
        if own:
            worst, arm = _least(tried, "ledger_min_j"), _least(own, "arm_ledger_min_j")
            motion = next(row for row in own if connection(row) == connection(worst))
            rows.append(
                {
                    "scheme": scheme,
                    "contact": contact,
                    "of": len(own),
                    "taking": sum(number(row, "motion_w") < -TAKING for row in own),
                    "ledger_min_j": worst["ledger_min_j"],
                    "motion_hz": motion["motion_hz"],
                    "motion_on": connection(motion),
                    "arms": sum(number(row, "arm_ledger_min_j") < FLOOR for row in own),
                    "arm_ledger_min_j": arm["arm_ledger_min_j"],
                    "arm": f"{arm['arm_stiffness_n_m']:.0f}, {arm['arm_damping_n_s_m']:.1f}",
                }
            )
    return Table(
        name="searches",
        title="the worst operators, found without control",
        columns=(
            Column(key="scheme", title="scheme"),
            Column(key="contact", title="contact"),
            Column(key="of", title="searches"),
            Column(key="taking", title="below 0"),
            Column(key="ledger_min_j", title="ledger [J]", form=".3f"),
            Column(key="motion_hz", title="at [Hz]", form=".1f"),
            Column(key="motion_on", title="on"),
            Column(key="arms", title="arms"),
            Column(key="arm_ledger_min_j", title="ledger [J]", form=".3f"),
            Column(key="arm", title="N/m, N s/m"),
        ),
        rows=rows,
    )


def conspiracies(found: Found) -> Table:
    """What both ends together take out of the channel."""
    rows = list[Row]()
    for scheme in SchemeName:
        without = _of(found.pairs, scheme=scheme, passivity_control=False)
        with_ = _of(found.pairs, scheme=scheme, passivity_control=True)
        if without:
            worst = _least(without, "ledger_min_j")
            rows.append(
                {
                    "scheme": scheme,
                    "connections": len(without),
                    "active": sum(map(makes_energy, without)),
                    "ledger_min_j": worst["ledger_min_j"],
                    "forecast_j": worst["forecast_j"],
                    "on": connection(worst),
                    "active_controlled": sum(map(makes_energy, with_)),
                    "ledger_min_controlled_j": _least(with_, "ledger_min_j")["ledger_min_j"],
                }
            )
    return Table(
        name="conspiracies",
        title="both ends conspire: the worst pair of motion and force",
        columns=(
            Column(key="scheme", title="scheme"),
            Column(key="connections", title="connections"),
            Column(key="active", title="active"),
            Column(key="ledger_min_j", title="ledger [J]", form=".3f"),
            Column(key="forecast_j", title="eigenvalue [J]", form=".3f"),
            Column(key="on", title="on"),
            Column(key="active_controlled", title="active, controlled"),
            Column(key="ledger_min_controlled_j", title="ledger [J]", form=".1e"),
        ),
        rows=rows,
    )


def evolution(found: Found) -> Table:
    """What a search under control came to."""
    rows = [{**row, "on": connection(row)} for row in found.evolved]
    return Table(
        name="evolution",
        title="the same under control, by evolution: least share of energy that the channel kept",
        columns=(
            Column(key="scheme", title="scheme"),
            Column(key="on", title="on"),
            Column(key="tries", title="tries"),
            Column(key="kept_first", title="before", form=".3f"),
            Column(key="kept_least", title="after", form=".3f"),
            Column(key="ledger_min_j", title="ledger [J]", form=".1e"),
        ),
        rows=rows,
    )


def drifts(found: Found) -> Table:
    """After a minute, at rest."""
    rows = list[Row]()
    for scheme, delay in product(SchemeName, _values(found.drift, "delay_s")):
        own = {row["kind"]: row for row in _of(found.drift, scheme=scheme, delay_s=delay)}
        rows.append(
            {
                "scheme": scheme,
                "delay_s": delay,
                **{kind: number(own[kind], "drift_m") * MM_PER_M for kind in KINDS},
            }
        )
    return Table(
        name="drifts",
        title="drift at rest after 60 s at 10 % loss [mm]",
        columns=(
            Column(key="scheme", title="scheme"),
            Column(key="delay_s", title="delay [s]", form="g"),
            *(Column(key=kind, title=kind, form=".2g") for kind in KINDS),
        ),
        rows=rows,
    )


def costs(found: Found) -> Table:
    """The largest change of errors, over hands and contacts."""
    rows, keys = list[Row](), ("tracking_rms_m_change", "force_rms_n_change")
    for scheme, delay in product(SchemeName, _values(found.cost, "delay_s")):
        own = _of(found.cost, scheme=scheme, delay_s=delay)
        rows.append(
            {
                "scheme": scheme,
                "delay_s": delay,
                **{key: max(number(row, key) for row in own) for key in keys},
                "least": min(number(row, key) for row in own for key in keys),
                "ledger": _least(own, "ledger_min_j_without")["ledger_min_j_without"],
            }
        )
    return Table(
        name="costs",
        title="what control changes on a clean connection, the most of all hands and contacts",
        columns=(
            Column(key="scheme", title="scheme"),
            Column(key="delay_s", title="delay [s]", form="g"),
            Column(key="tracking_rms_m_change", title="tracking", form="+.2%"),
            Column(key="force_rms_n_change", title="force", form="+.2%"),
            Column(key="least", title="least of both", form="+.2%"),
            Column(key="ledger", title="ledger without [J]", form=".1e"),
        ),
        rows=rows,
    )


def connection(row: Row) -> str:
    """A connection in words."""
    delay, jitter = (number(row, key) * MS_PER_S for key in ("delay_s", "jitter_s"))
    parts = [f"{delay:g}", f"{jitter:.0f} ms", f"{number(row, 'loss'):.0%}"]
    return " ".join([*parts] if row["trouble"] == Trouble.NONE else [*parts, str(row["trouble"])])


def _of(rows: Iterable[Row], **what: object) -> list[Row]:
    return [row for row in rows if all(row[key] == value for key, value in what.items())]


def _least(rows: Sequence[Row], key: str) -> Row:
    return min(rows, key=lambda row: number(row, key))


def _values(rows: Iterable[Row], key: str) -> list[object]:
    return list(dict.fromkeys(row[key] for row in rows))


TAKING = 1e-6  # less power than that is rounding [W]

TABLES: tuple[Callable[[Found], Table], ...] = (
    summary, failures, searches, conspiracies, evolution, drifts, costs,
)  # fmt: skip
