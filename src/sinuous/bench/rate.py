"""`sinuous bench rate`: the same controller at 1 kHz and at 30 Hz, on the same path in time."""

from collections.abc import Iterator

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.judge import judge
from sinuous.bench.loop import Drive, drive
from sinuous.bench.machine import machine, versions
from sinuous.bench.ours import Ours
from sinuous.bench.rate_figure import draw
from sinuous.bench.result import Column, Result, Row, Table
from sinuous.bench.scene import DT, STEPS, Scene, describe, stress_scene, targets
from sinuous.view.units import MM_PER_M

FAST = 0.001  # time of a step [s]
HORIZONS, QUICK_HORIZONS = (2, 5), (2,)
QUICK_STEPS = 12  # of 1/30 s
DISKS = 30

COLUMNS = (
    Column(key="rate_hz", title="rate [Hz]", form=".0f"),
    Column(key="horizon", title="N"),
    Column(key="steps", title="steps"),
    Column(key="median_ms", title="median", form=".3f"),
    Column(key="p99_ms", title="p99", form=".3f"),
    Column(key="max_ms", title="max", form=".3f"),
    Column(key="min_margin_mm", title="margin", form="+.3f"),
    Column(key="violations", title="broken"),
    Column(key="failures", title="failed"),
    Column(key="tracking_median_mm", title="tracking", form=".3f"),
    Column(key="tracking_mean_mm", title="mean", form=".3f"),
    Column(key="tracking_late_median_mm", title="late", form=".3f"),
    Column(key="tracking_late_mean_mm", title="mean", form=".3f"),
)
NOTES = (
    "Processor time of a step in ms, one thread, whole body guarded; lengths in mm, judged on the "
    "exact mesh after every step and on the way.",
    '"tracking": from the tip to where the target is at that time, every 1/30 s at both rates; '
    '"late": to where it was 1/30 s before, all that a controller at 30 Hz can know.',
)


def run(quick: bool, observe: Observe) -> Result:
    """Drive both rates at every horizon."""
    steps = QUICK_STEPS if quick else STEPS
    horizons = QUICK_HORIZONS if quick else HORIZONS
    settings = [(horizon, dt) for horizon in horizons for dt in (DT, FAST)]
    rows, series = list[Row](), list[Row]()
    for number, (horizon, dt) in enumerate(settings):
        observe(f"N = {horizon}, {1.0 / dt:.0f} Hz", number, len(settings))
        scene = stress_scene(DISKS, round(steps * DT / dt), dt)
        done = drive(Ours.of(scene, horizon, disks_only=False), scene)
        about = {"rate_hz": 1.0 / dt, "dt_s": dt, "horizon": horizon, "disks": DISKS}
        errors = dict(_errors(scene, done, steps))
        rows.append(
            {
                **about,
                **{f"{key}_median_mm": float(np.median(e)) for key, e in errors.items()},
                **{f"{key}_mean_mm": float(np.mean(e)) for key, e in errors.items()},
                **judge(scene, done, whole_body=True),
            }
        )
        series.append({**about, **{key: error.tolist() for key, error in errors.items()}})
    observe("done", len(settings), len(settings))
    return Result(
        what="rate",
        tables=(Table(name="rows", title="the stress scene", columns=COLUMNS, rows=rows),),
        about={
            "time_s": (DT * np.arange(1, steps + 1)).tolist(),
            "series_mm": series,
            "scene": {**describe(steps), "dt_s": [DT, FAST]},
            "settings": {
                "effort": "of the rate, not of the step: it means the same at both rates",
                "tip_error": "to the target that was given to the step, for every step",
            },
            "versions": versions(),
            "machine": machine(),
        },
        notes=NOTES,
    )


def _errors(scene: Scene, done: Drive, steps: int) -> Iterator[tuple[str, Array]]:
    """Errors of the tip (K,) [mm] at the ends of the steps of the slow rate."""
    times = DT * np.arange(1, steps + 1)
    tip = scene.robot.tip(done.c)
    own = scene.dt * np.arange(len(tip))
    # Tips between two steps of the fast rate lie on the straight way: 30 um apart at most.
    there = np.stack([np.interp(times, own, tip[:, k]) for k in range(3)], axis=1)
    goal = targets(steps + 1)
    for name, where in (("tracking", goal[1:]), ("tracking_late", goal[:-1])):
        yield name, np.linalg.norm(there - where, axis=1) * MM_PER_M


RATE = Benchmark(run=run, draw=draw)
