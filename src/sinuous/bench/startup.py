"""`sinuous bench startup`: from starting a process to help, imports and the first control step."""

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter, time

import numpy as np

from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.machine import machine, versions
from sinuous.bench.result import Column, Result, Row, Table
from sinuous.bench.startup_figure import draw
from sinuous.geometry import shapes
from sinuous.view.units import MM_PER_M

PROCESSES, QUICK_PROCESSES = 9, 1
BYTES_PER_MB = 1e6
# As wide as the tube of the README's example and as long as its straight part [m].
LENGTH, RADIUS = 0.4, 0.018

PYTHON = "python"
STEP = "first control step"
COLD = f"{STEP}, nothing compiled"
COMMANDS = {
    PYTHON: "pass",
    "import sinuous": "import sinuous",
    "sinuous --help": "from sinuous.cli import main; main(['--help'])",
}
# The README's shortest example up to the first step; it prints how long each part took, and when
# the step was done.
EXAMPLE = """
from time import perf_counter, time
began, done = perf_counter(), {}
def note(part):
    global began
    now = perf_counter()
    done[part], began = now - began, now
import sinuous as sn
sn.load_robot, sn.SafeZone, sn.ShapeConstrainedMPC, sn.KinematicPlant
note("imports_s")
robot = sn.load_robot("hachen2025")
note("robot_s")
zone = sn.SafeZone.load(PATH, unit="mm", entrance=[0, 0, 0])
note("zone_s")
mpc = sn.ShapeConstrainedMPC(robot, zone, margin=0.003, dt=1 / 30, horizon=5)
plant = sn.KinematicPlant(robot, seed=0)
state = mpc.init(robot.home)
note("controller_s")
state, command = mpc.step(state, target=[0.01, 0.0, 0.2])
note("step_s")
done["at"] = time()
import json
print(json.dumps(done))
"""
PARTS = ("python_s", "imports_s", "robot_s", "zone_s", "controller_s", "step_s")

COLUMNS = (
    Column(key="what", title="what"),
    Column(key="processes", title="processes"),
    Column(key="median_s", title="median [s]", form=".3f"),
    Column(key="least_s", title="least [s]", form=".3f"),
    Column(key="max_s", title="longest [s]", form=".3f"),
    Column(key="cache_mb", title="cache [MB]", form=".1f"),
)
PART_COLUMNS = (
    Column(key="part", title="part"),
    Column(key="median_s", title="median [s]", form=".3f"),
)
NAMES = {
    "python_s": "Python itself",
    "imports_s": "imports, compiled code found",
    "robot_s": "robot",
    "zone_s": "mesh file to zone",
    "controller_s": "grid and controller",
    "step_s": "first control step",
}
NOTES = (
    "Time on the wall of new processes, one after the other, from their start to their end or to "
    "the end of the first control step; compiled code was in the cache before the first that "
    "counts.",
)


def run(quick: bool, observe: Observe) -> Result:
    """Start processes; unless it should be quick also one that has to compile everything."""
    count = QUICK_PROCESSES if quick else PROCESSES
    total = len(COMMANDS) + (1 if quick else 2)
    with TemporaryDirectory() as folder:
        path = Path(folder) / "tube.stl"
        _tube(path)
        example = f"PATH = {str(path)!r}\n{EXAMPLE}"
        rows = list[Row]()
        for number, (name, code) in enumerate(COMMANDS.items()):
            observe(name, number, total)
            rows.append({"what": name, **_times([_whole(code) for _ in range(count)])})
        observe(STEP, len(COMMANDS), total)
        _start(example)  # compiles what is not in the cache
        steps = [_to_the_step(example) for _ in range(count)]
        rows.append({"what": STEP, **_times([parts["all_s"] for parts in steps])})
        if not quick:
            observe(COLD, total - 1, total)
            rows.append({"what": COLD, **_cold(example, Path(folder) / "cache")})
    observe("done", total, total)
    return Result(
        what="startup",
        tables=(
            Table(name="rows", title="new processes", columns=COLUMNS, rows=rows),
            Table(
                name="parts",
                title="the first control step, with compiled code in the cache",
                columns=PART_COLUMNS,
                rows=_parts(steps),
            ),
        ),
        about={
            "settings": {
                "example": "the README's shortest, one step, in a straight tube of "
                f"{RADIUS * MM_PER_M:.0f} mm radius in a binary STL file",
                "cold": "the same with an empty folder for compiled code",
            },
            "versions": versions(),
            "machine": machine(),
        },
        notes=NOTES,
    )


def _tube(path: Path) -> None:
    tube = shapes.tube([[0.0, 0.0, 0.0], [0.0, 0.0, LENGTH]], RADIUS)
    tube.apply_scale(MM_PER_M)
    tube.export(path)  # pyright: ignore[reportArgumentType]


def _start(code: str, environment: Mapping[str, str] | None = None) -> str:
    """Run code in a new process; what it prints."""
    command = [sys.executable, "-c", code]
    env = {**os.environ, **(environment or {})}
    done = subprocess.run(command, env=env, capture_output=True, text=True, check=True)
    return done.stdout


def _whole(code: str) -> float:
    """Time that a process takes [s]."""
    began = perf_counter()
    _start(code)
    return perf_counter() - began


def _to_the_step(code: str, environment: Mapping[str, str] | None = None) -> dict[str, float]:
    """Time until the first control step is done and of its parts [s]."""
    began = time()
    parts: dict[str, float] = json.loads(_start(code, environment))
    all_of_it = parts.pop("at") - began
    return {"python_s": all_of_it - sum(parts.values()), **parts, "all_s": all_of_it}


def _cold(code: str, cache: Path) -> Row:
    parts = _to_the_step(code, {"NUMBA_CACHE_DIR": str(cache)})
    files = [file for file in cache.rglob("*") if file.is_file()]
    size = sum(file.stat().st_size for file in files) / BYTES_PER_MB
    return {**_times([parts["all_s"]]), "cache_mb": size, "cache_files": len(files), **parts}


def _times(seconds: Sequence[float]) -> Row:
    return {
        "processes": len(seconds),
        "median_s": float(np.median(seconds)),
        "least_s": float(np.min(seconds)),
        "max_s": float(np.max(seconds)),
    }


def _parts(measured: Sequence[Mapping[str, float]]) -> list[Row]:
    """What the first control step spends its time on."""
    return [
        {"part": NAMES[key], "median_s": float(np.median([parts[key] for parts in measured]))}
        for key in PARTS
    ]


STARTUP = Benchmark(run=run, draw=draw)
