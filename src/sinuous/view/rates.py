"""Actuator rates between their limits: one panel per kind of actuator."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.typing import LineStyleType

from sinuous.recording import Recording
from sinuous.view.actuators import Actuator, actuator_kinds
from sinuous.view.curves import LIMIT_DASH, mark_switches, prepare
from sinuous.view.style import CYCLE, GREY, LIMIT
from sinuous.view.units import MM_PER_M

DASHES: tuple[LineStyleType, ...] = (
    "solid",
    (0, (4, 1.2)),
    (0, (1.2, 1.0)),
    (0, (5, 1.2, 1.2, 1.2)),
)
CROWDED = 4
"""A panel with more curves than this is drawn taller, with thinner lines."""


def rates_height(recording: Recording) -> float:
    """How tall the figure should be [inch]."""
    return 1.0 + 2.2 * sum(_heights(recording))


def draw_rates(figure: Figure, recording: Recording) -> None:
    """One panel per kind; the colour tells the segment or module, the dash which cable."""
    kinds = actuator_kinds(recording.header.actuator_names)
    rows = figure.subplots(
        max(len(kinds), 1), 1, sharex=True, squeeze=False, height_ratios=_heights(recording)
    )[:, 0]
    rows[0].set_title("Actuator rates and their limits")
    for axes, (kind, members) in zip(rows, kinds.items(), strict=False):
        _draw_kind(axes, recording, kind, members)
        axes.label_outer()


def _heights(recording: Recording) -> list[float]:
    kinds = actuator_kinds(recording.header.actuator_names)
    return [1.7 if len(members) > CROWDED else 1.0 for members in kinds.values()] or [1.0]


def _draw_kind(axes: Axes, recording: Recording, kind: str, members: list[Actuator]) -> None:
    if not prepare(axes, recording, f"{kind} rate [mm/s]"):
        return
    for actuator in members:
        axes.step(
            recording.time,
            recording.rates[:, actuator.index] * MM_PER_M,
            where="post",
            color=_color(actuator),
            linestyle=_dash(actuator),
            linewidth=1.2 if len(members) > CROWDED else 1.5,
        )
    limits = np.unique(recording.header.rate_limits[[a.index for a in members]]) * MM_PER_M
    for limit in limits[np.isfinite(limits)]:
        axes.axhline(float(limit), color=LIMIT, linewidth=1.2, linestyle=LIMIT_DASH)
    mark_switches(axes, recording)
    low, high = axes.get_ylim()
    axes.set_ylim(low - 0.05 * (high - low), high + 0.05 * (high - low))
    handles = _keys(kind, members)
    axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.0, 0.5))


def _keys(kind: str, members: list[Actuator]) -> list[Line2D]:
    """What colours and dashes mean: far fewer entries than curves."""
    parts = {f"{a.part} {a.segment}": _color(a) for a in members if a.segment}
    numbers: dict[int, LineStyleType] = {a.number: _dash(a) for a in members if a.number}
    keys = [Line2D([], [], color=color, label=part) for part, color in parts.items()]
    keys += [
        Line2D([], [], color=GREY, linestyle=dash, label=f"{kind} {n}")
        for n, dash in numbers.items()
    ]
    if not keys:
        keys = [Line2D([], [], color=_color(a), label=a.kind) for a in members]
    return [*keys, Line2D([], [], color=LIMIT, linewidth=1.2, linestyle=LIMIT_DASH, label="limit")]


def _color(actuator: Actuator) -> str:
    return CYCLE[(actuator.segment - 1) % len(CYCLE)] if actuator.segment else GREY


def _dash(actuator: Actuator) -> LineStyleType:
    return DASHES[(actuator.number - 1) % len(DASHES)] if actuator.number else "solid"
