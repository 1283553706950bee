"""Figures of III-C: step responses as printed, and what they come to over all targets."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.papers.experiment import Data
from sinuous.view.curves import BENEATH
from sinuous.view.style import BLACK, BLUE, CYCLE, GREEN, GREY, ORANGE, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

ERRORS = (
    ("real_m", "real tip to target", VERMILION),
    ("nominal_m", "nominal tip to target", BLUE),
    ("local_m", "real tip to nominal tip", GREEN),
    ("body_m", "real body to nominal body", ORANGE),
)
INPUTS = (("nominal_input_m_s", "plan", BLUE), ("local_input_m_s", "local controller", GREEN))
NOT_FOR_DLS = ("nominal_m", "local_input_m_s")
"""A controller without a plan has neither."""

FIGURES = (
    ("fig5_dls", "DLS, printed gains"),
    ("fig5_dls_best_gains", "DLS, best gains"),
    ("fig6_mpc_local", "MPC + local"),
    ("fig6_mpc_alone", "MPC alone"),
    ("fig6_mpc_offset_free", "MPC offset-free"),
)


def draw(data: Data, folder: Path) -> list[Path]:
    """A step response for each controller and one figure for all targets."""
    curves = {r["controller"]: r["curves"] for r in data["rows"] if r["curves"] is not None}
    distance = data["distance_m"][data["shown"]] * MM_PER_M
    made = list[Path]()
    for name, controller in FIGURES:

        def response(figure: Figure, controller: str = controller) -> None:
            title = f"{controller}: a target {distance:.0f} mm away, with disturbances"
            _response(figure, title, curves[controller], plan=controller.startswith("MPC"))

        made.append(save(folder / f"{name}.png", (10.0, 6.6), response))
    made.append(save(folder / "all_targets.png", (11.0, 7.4), lambda f: _all(f, data["rows"])))
    return made


def _response(figure: Figure, title: str, curves: Data, *, plan: bool) -> None:
    errors, inputs = figure.subplots(2, 1, sharex=True, height_ratios=(1.6, 1.0))
    errors.set_title(title)
    _curves(errors, curves, ERRORS, plan=plan)
    errors.set_ylabel("error [mm]")
    _curves(inputs, curves, INPUTS, plan=plan)
    inputs.set_ylabel("norm of the input [mm/s]")
    inputs.set_xlabel(TIME_LABEL)
    for axes in (errors, inputs):
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.01)
        axes.legend(loc="upper right")


def _curves(axes: Axes, curves: Data, what: Sequence[tuple[str, str, str]], *, plan: bool) -> None:
    for key, label, color in what:
        if not plan and key in NOT_FOR_DLS:
            continue
        name = label if plan or key != "nominal_input_m_s" else "controller"
        values = np.array(curves[key]) * MM_PER_M
        style = BENEATH if key == "real_m" else {}
        axes.plot(curves["time_s"], values, color=color, label=name, **style)


def _all(figure: Figure, rows: Sequence[dict[str, Any]]) -> None:
    names = list(dict.fromkeys(row["controller"] for row in rows))
    figure.suptitle(f"All {len(rows) // len(names)} targets, one dot each; the line is the median")
    panels = figure.subplots(3, 1, sharex=True)
    for axes, key, label, scale in (
        (panels[0], "tip_error_at_rest_m", "tip error\nat rest [mm]", MM_PER_M),
        (panels[1], "body_error_at_rest_m", "body error\nat rest [mm]", MM_PER_M),
        (panels[2], "settling_time_s", "settling time [s]", 1.0),
    ):
        for k, name in enumerate(names):
            values = [r[key] for r in rows if r["controller"] == name and r[key] is not None]
            _dots(axes, k, scale * np.array(values), CYCLE[k % len(CYCLE)])
        axes.set_ylabel(label)
        axes.set_ylim(bottom=0.0)
    alone = [r["tip_error_from_disturbance_m"] for r in rows]
    mean = float(np.mean(alone)) * MM_PER_M
    panels[0].axhline(mean, color=GREY, linestyle=(0, (5, 3)), label="the disturbance alone")
    panels[0].legend(loc="upper right")
    panels[-1].set_xticks(range(len(names)), [name.replace(", ", ",\n") for name in names])


def _dots(axes: Axes, k: int, values: np.ndarray, color: str) -> None:
    side = 0.28 * np.linspace(-1.0, 1.0, len(values)) if len(values) > 1 else np.zeros(len(values))
    axes.plot(k + side, values, linestyle="none", marker="o", markersize=3.5, color=color)
    if len(values):
        axes.hlines(float(np.median(values)), k - 0.35, k + 0.35, color=BLACK, linewidth=2.0)
