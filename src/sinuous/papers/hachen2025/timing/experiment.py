"""III-F: the time of a step by horizon, with and without shape constraints, beside IPOPT.

The scene is that of `sinuous bench mpc`: a bent tube of 350 vertices, thirty disks, the printed
cost. IPOPT solves the same program in the same run, so that its time here beside the printed
one says how fast this machine is.
"""

from collections.abc import Iterator
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.loop import Drive, drive
from sinuous.bench.machine import machine, versions
from sinuous.bench.ours import Ours
from sinuous.bench.scene import Scene, stress_scene
from sinuous.geometry.safe_zone import SafeZone
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.timing.figures import draw
from sinuous.papers.hachen2025.timing.verdicts import INSTALLED, OURS
from sinuous.papers.workers import Workers

DISKS, VERTICES = 30, 350
STEPS, QUICK_STEPS = 240, 20
HORIZONS, QUICK_HORIZONS = tuple(range(1, 21)), (2,)

# Horizons at which others run, and how many steps: long ones take long.
PEER_STEPS = {1: STEPS, 2: STEPS, 3: STEPS, 4: STEPS, 5: STEPS, 6: STEPS, 10: 120, 20: 60}

NO_CASADI = "CasADi is not installed: pip install sinuous[bench]"

Row = dict[str, Any]


def run(workers: Workers, quick: bool) -> Data:
    """Every horizon, in this process alone: workers would take each other's time."""
    steps, horizons = (QUICK_STEPS, QUICK_HORIZONS) if quick else (STEPS, HORIZONS)
    inside = stress_scene(DISKS, steps)
    scenes = (inside, replace(inside, zone=SafeZone.unbounded()))
    rows, total = list[Row](), len(scenes) * len(horizons)
    for number, scene in enumerate(scenes):
        for done, horizon in enumerate(horizons, number * len(horizons)):
            workers.observe("time of a step", done, total)
            setting = {"constrained": bool(scene.zone.surfaces), "horizon": horizon}
            rows += [{**setting, **row} for row in measure(scene, horizon, compiles=not quick)]
    workers.observe("time of a step", total, total)
    return {
        "rows": rows,
        "steps": steps,
        "disks": DISKS,
        "vertices": VERTICES,
        "machine": machine(),
        "versions": versions(),
    }


def measure(scene: Scene, horizon: int, *, compiles: bool) -> Iterator[Row]:
    """Our steps before and after those of others, so that a busy machine is fair to all."""
    ours = Ours.of(scene, horizon, disks_only=False)
    before = drive(ours, scene)
    found = list(_others(scene, horizon, before, compiles=compiles))
    after = drive(ours, scene)
    yield {"controller": OURS, **times(before.followed_by(after)), "missing": ""}
    yield from found


def _others(scene: Scene, horizon: int, ours: Drive, *, compiles: bool) -> Iterator[Row]:
    if horizon not in PEER_STEPS:
        return
    if find_spec("casadi") is None:
        yield {"controller": INSTALLED, **nothing(), "missing": NO_CASADI}
        return
    from sinuous.papers.hachen2025.timing.peers import peers  # needs CasADi

    short = replace(scene, targets=scene.targets[: PEER_STEPS[horizon]])
    for peer in peers(short, horizon, compiles=compiles):
        if peer.controller is None:
            yield {"controller": peer.name, **nothing(), "missing": peer.missing}
            continue
        with peer.silence():
            done = drive(peer.controller, short)
        same = float(np.mean(ours.cpu[: len(done.cpu)]))
        yield {"controller": peer.name, **times(done), "ours_mean_s": same, "missing": ""}


def times(found: Drive) -> Row:
    """Processor time of a drive's steps, and what the clock on the wall said [s]."""
    return {
        "steps": len(found.cpu),
        "failures": sum(bool(outcome.failure) for outcome in found.outcomes),
        **_quantiles("", found.cpu),
        **_quantiles("wall_", found.wall),
    }


def nothing() -> Row:
    """The same of what could not run."""
    empty = np.full(1, np.nan)
    names = (*_quantiles("", empty), *_quantiles("wall_", empty))
    return {"steps": 0, "failures": 0, **dict.fromkeys(names)}


def _quantiles(prefix: str, seconds: Array) -> dict[str, float]:
    return {
        f"{prefix}mean_s": float(np.mean(seconds)),
        f"{prefix}median_s": float(np.median(seconds)),
        f"{prefix}p99_s": float(np.percentile(seconds, 99)),
        f"{prefix}max_s": float(np.max(seconds)),
    }


TIMING = Experiment(
    name="timing",
    title="Time of a step by horizon",
    section="III-F",
    run=run,
    draw=draw,
)
