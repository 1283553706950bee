"""What many rows of `sinuous bench link` come to; aggregates report the worst."""

from collections.abc import Callable, Sequence
from itertools import product

import numpy as np

from sinuous.bench.link_grid import Contact, SchemeName, Trouble
from sinuous.bench.link_hand import FASTEST
from sinuous.bench.result import Column, Row, Table
from sinuous.view.units import MM_PER_M

LARGEST = 10.0  # force that a device of this size gives: F_max [N]
DT = 1e-3  # of a tick [s]
FLOOR = -LARGEST * FASTEST * DT  # below, a ledger is one of a channel that makes energy [J]

WORST = {
    "ledger_min_j": min,
    "drift_m": max,
    "tracking_rms_m": max,
    "force_rms_n": max,
    "peak_force_n": max,
    "operator_min_j": min,
    "follower_min_j": min,
}

CLASSES: dict[str, Callable[[Row], bool]] = {
    "clean": lambda row: row["jitter"] == row["loss"] == 0.0,
    "jitter": lambda row: row["jitter"] != 0.0 and row["loss"] == 0.0,
    "loss": lambda row: row["jitter"] == 0.0 and row["loss"] != 0.0,
    "both": lambda row: (
        row["jitter"] != 0.0 and row["loss"] != 0.0 and row["trouble"] == Trouble.NONE
    ),
    **{
        trouble.value: (lambda row, trouble=trouble: row["trouble"] == trouble)
        for trouble in Trouble
        if trouble is not Trouble.NONE
    },
}
"""Kinds of connections."""


def worst_of(rows: Sequence[Row]) -> Row:
    """The worst of each number, and whether any is unbounded."""
    found = {key: worst(number(row, key) for row in rows) for key, worst in WORST.items()}
    return {**found, "unbounded": any(row["unbounded"] for row in rows)}


def number(row: Row, key: str) -> float:
    """A number of a row."""
    value = row[key]
    assert isinstance(value, int | float)
    return float(value)


def makes_energy(row: Row) -> bool:
    """Whether its ledger fell below -F_max v_max dt."""
    return number(row, "ledger_min_j") < FLOOR


def by_scheme(rows: Sequence[Row]) -> Table:
    """One row per scheme, control and contact."""
    found = list[Row]()
    for scheme, contact, control in product(SchemeName, Contact, (False, True)):
        own = [
            row
            for row in rows
            if (row["scheme"], row["contact"], row["passivity_control"])
            == (scheme, contact, control)
        ]
        if own:
            bounded = [row for row in own if not row["unbounded"]]
            found.append(
                {
                    "scheme": scheme,
                    "contact": contact,
                    "control": "on" if control else "off",
                    "cells": len(own),
                    "active": sum(map(makes_energy, own)),
                    "unbounded": len(own) - len(bounded),
                    "ledger_min_j": min(number(row, "ledger_min_j") for row in own),
                    **(_errors(bounded) if bounded else {}),
                }
            )
    return Table(name="summary", title="all cells, the worst of each", columns=SUMMARY, rows=found)


def _errors(rows: Sequence[Row]) -> Row:
    """Medians and the worst of bounded cells."""
    found = dict[str, float]()
    for key, scale in ERRORS.items():
        values = [scale * number(row, key) for row in rows]
        name = key.replace("_m", "_mm") if scale == MM_PER_M else key
        found[f"{name}_median"], found[name] = float(np.median(values)), max(values)
    return found


ERRORS = {"drift_m": MM_PER_M, "tracking_rms_m": MM_PER_M, "force_rms_n": 1.0, "peak_force_n": 1.0}

SUMMARY = (
    Column(key="scheme", title="scheme"),
    Column(key="contact", title="contact"),
    Column(key="control", title="control"),
    Column(key="cells", title="cells"),
    Column(key="active", title="active"),
    Column(key="unbounded", title="unbounded"),
    Column(key="ledger_min_j", title="ledger [J]", form=".1e"),
    Column(key="drift_mm", title="drift [mm]", form=".1f"),
    Column(key="tracking_rms_mm_median", title="tracking", form=".1f"),
    Column(key="tracking_rms_mm", title="worst [mm]", form=".1f"),
    Column(key="force_rms_n_median", title="force", form=".2f"),
    Column(key="force_rms_n", title="worst [N]", form=".2f"),
    Column(key="peak_force_n", title="peak [N]", form=".1f"),
)


def failures(rows: Sequence[Row]) -> Table:
    """Without control: cells that make energy, and of them those that are unbounded, by kind."""
    found = list[Row]()
    for scheme, hand in product(SchemeName, dict.fromkeys(row["operator"] for row in rows)):
        own = [
            row
            for row in rows
            if (row["scheme"], row["operator"]) == (scheme, hand) and not row["passivity_control"]
        ]
        counts = {name: _count([row for row in own if of(row)]) for name, of in CLASSES.items()}
        found.append({"scheme": scheme, "operator": hand, **counts})
    columns = tuple(Column(key=name, title=name) for name in ("scheme", "operator", *CLASSES))
    return Table(
        name="failures",
        title="where schemes without control fail: cells that make energy + unbounded, of all",
        columns=columns,
        rows=found,
    )


def _count(rows: Sequence[Row]) -> str:
    if not rows:
        return "-"
    active = sum(map(makes_energy, rows))
    unbounded = sum(bool(row["unbounded"]) for row in rows)
    return f"{active}+{unbounded}/{len(rows)}"
