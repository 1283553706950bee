"""How the gains of the local controller and the offset's time constant were chosen, once."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sinuous.control.local import LocalController
from sinuous.control.offset_free import OffsetFree
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.convergence.experiment import response
from sinuous.papers.hachen2025.runs import held, sampled_targets, scenario
from sinuous.papers.workers import Workers
from sinuous.view.style import BLUE, GREEN, GREY, VERMILION, save
from sinuous.view.units import MM_PER_M

TIP_GAINS = (2.0, 5.0, 10.0, 15.0, 20.0, 30.0)  # [1/s]
BODY_GAINS = (0.0, 5.0, 15.0, 30.0)  # [1/s]
TIME_CONSTANTS = (0.1, 0.2, 0.5, 1.0, 2.0)  # [s]
SEEDS, QUICK_SEEDS = 4, 1
DURATION, REST, QUICK_DURATION = 12.0, 5.0, 7.0  # [s]
SEED = 17  # of the targets, which are not those of III-C

# What varies, the scenario, and what is fixed in it. The tracker sees the tip only; it has no
# bias here, because no gain changes what a bias does.
SWEEPS: dict[str, tuple[str, str, tuple[float, ...], tuple[str, ...]]] = {
    "tip_gain_disturbed": ("convergence", "control.local.tip_gain_per_s", TIP_GAINS, ()),
    "body_gain_disturbed": ("convergence", "control.local.body_gain_per_s", BODY_GAINS, ()),
    "tip_gain_tracked": (
        "hardware",
        "control.local.tip_gain_per_s",
        TIP_GAINS,
        ("robot.limits=simulation", "sensor.bias_mm=0", "control.offset_free.when=never"),
    ),
    "time_constant_tracked": (
        "hardware",
        "control.offset_free.time_constant_s",
        TIME_CONSTANTS,
        ("robot.limits=simulation", "sensor.bias_mm=0"),
    ),
}

Item = tuple[str, float, int, bool]


def run(workers: Workers, quick: bool) -> Data:
    """Every value of every sweep."""
    items: list[Item] = [
        (sweep, value, seed, quick)
        for sweep, (_, _, values, _) in SWEEPS.items()
        for value in (values[::3] if quick else values)
        for seed in range(QUICK_SEEDS if quick else SEEDS)
    ]
    return {
        "chosen": {
            "tip_gain_per_s": LocalController.tip_gain,
            "body_gain_per_s": LocalController.body_gain,
            "time_constant_s": OffsetFree.time_constant,
        },
        "rows": workers.map("gains", drive, items),
    }


def drive(item: Item) -> dict[str, Any]:
    """One run to a target, and what it is like at rest."""
    sweep, value, seed, quick = item
    name, key, _, fixed = SWEEPS[sweep]
    base = replace(scenario(name, *fixed, f"{key}={value}"), seed=seed)
    target = (
        sampled_targets(base.robot, seed + 1, SEED)[-1]
        if name == "convergence"
        else base.path[seed % len(base.path)].at(0.0)
    )
    recording = held(base, np.asarray(target), QUICK_DURATION if quick else DURATION, seed)
    curves, last = response(recording), recording.time > recording.time[-1] - REST
    return {
        "sweep": sweep,
        "value": value,
        "seed": seed,
        "tip_error_at_rest_m": float(np.mean(curves["real_m"][last])),
        "body_error_at_rest_m": float(np.mean(curves["body_m"][last])),
        "jitter_m": float(np.sqrt(np.sum(np.var(recording.actual_tip[last], axis=0)))),
    }


def draw(data: Data, folder: Path) -> list[Path]:
    """All sweeps, the chosen values marked."""
    return [save(folder / "gains.png", (11.0, 7.6), lambda f: _draw(f, data))]


def _draw(figure: Figure, data: Data) -> None:
    chosen, panels = data["chosen"], figure.subplots(2, 2)
    for axes, sweep, title, label, mark in (
        (panels[0, 0], "tip_gain_disturbed", "Printed disturbance, whole shape seen",
         "tip gain [1/s]", chosen["tip_gain_per_s"]),
        (panels[0, 1], "tip_gain_tracked", "Mismatch, noisy tracker at the tip",
         "tip gain [1/s]", chosen["tip_gain_per_s"]),
        (panels[1, 0], "body_gain_disturbed", "Printed disturbance, whole shape seen",
         "body gain [1/s]", chosen["body_gain_per_s"]),
        (panels[1, 1], "time_constant_tracked", "Mismatch, noisy tracker at the tip",
         "time constant of the offset [s]", chosen["time_constant_s"]),
    ):  # fmt: skip
        rows = [row for row in data["rows"] if row["sweep"] == sweep]
        values = sorted({row["value"] for row in rows})
        for key, name, color in (
            ("tip_error_at_rest_m", "tip error", VERMILION),
            ("body_error_at_rest_m", "body error", BLUE),
            ("jitter_m", "jitter of the tip", GREEN),
        ):
            means = [np.mean([r[key] for r in rows if r["value"] == v]) for v in values]
            axes.plot(values, np.array(means) * MM_PER_M, color=color, marker="o", label=name)
        axes.axvline(mark, color=GREY, linestyle=(0, (2, 2)), label="chosen")
        axes.set_ylim(bottom=0.0)
        axes.set_title(title)
        axes.set_xlabel(label)
        axes.set_ylabel("at rest [mm]")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))


TUNING = Experiment(name="tuning", title="Gains, tuned once", section="II-D", run=run, draw=draw)
