"""`sinuous check`: what a file holds and whether it is good."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
from rich.console import Console

from sinuous.arrays import Array
from sinuous.cli import describe, describe_robot
from sinuous.cli.arguments import Check, assignments
from sinuous.cli.codes import GOOD, NEGATIVE
from sinuous.cli.table import Rows, millimetres, print_rows
from sinuous.errors import InputError
from sinuous.files import read_toml
from sinuous.reach import Reach, reaches
from sinuous.robots.robot_file import robot_path
from sinuous.scenario import load_scenario
from sinuous.session.folder import RECORDING
from sinuous.view.units import MM_PER_M

MESHES = (".stl", ".obj", ".ply")


def check(arguments: Check) -> int:
    """Describe a file, or say whether a scenario's robot reaches a target."""
    console = Console()
    kind, rows = _kind(arguments)
    for option, fits in (("unit", "mesh"), ("target", "scenario"), ("set", "scenario")):
        if getattr(arguments, option) and kind != fits:
            raise InputError(
                file=f"--{option}",
                expected=f"a {fits} file to go with it",
                found=f"the {kind} {arguments.file}",
                remedy=f"Leave --{option} out.",
            )
    if arguments.target is not None:
        return _check_target(console, arguments, _target(arguments.target))
    print_rows(console, f"{arguments.file}: a good {kind}", rows())
    return GOOD


def _kind(arguments: Check) -> tuple[str, Callable[[], Rows]]:
    """What a file is, told by its ending and, for TOML, by its tables; and what describes it."""
    name = arguments.file
    if not name.strip():
        raise InputError(
            file="FILE", expected="a file or a preset", found="an empty name", remedy="Name one."
        )
    path, ending = Path(name), Path(name).suffix.lower()
    if ending in MESHES:
        return "mesh", lambda: describe.mesh(path, _unit(arguments))
    if ending == ".csv":
        return "path", lambda: describe.path(path)
    if ending == ".mcap":
        return "recording", lambda: describe.recording(path)
    if (path / RECORDING).is_file():
        return "recording", lambda: describe.recording(path / RECORDING)
    if ending != ".toml" and path.exists():
        raise InputError(
            file=name,
            expected="a .toml, .stl, .obj, .ply, .csv or .mcap file, or the folder of a run",
            found="a folder" if path.is_dir() else f'a file that ends in "{path.suffix}"',
            remedy="Check the path.",
        )
    toml = robot_path(name)
    tables = read_toml(toml)
    if "robot" in tables or "path" in tables:
        return "scenario", lambda: describe.scenario(path, assignments(arguments.set))
    if "segment" in tables or "modules" in tables:
        return "robot", lambda: describe_robot.robot(toml)
    raise InputError(
        file=name,
        expected="a robot with [[segment]] tables or a [modules] table, or a scenario with a "
        "[robot] table",
        found="none of them",
        remedy="See the examples in examples/.",
    )


def _unit(arguments: Check) -> str:
    if arguments.unit is None:
        raise InputError(
            file="--unit",
            expected="the unit of the numbers in the mesh file",
            found="nothing",
            remedy="Add --unit mm, --unit cm or --unit m.",
        )
    return arguments.unit


def _target(text: str) -> Array:
    try:
        values = np.array([float(part) for part in text.split(",")]) / MM_PER_M
    except ValueError:
        values = np.empty(0)
    if values.shape != (3,) or not all(map(math.isfinite, values)):
        raise InputError(
            file="--target",
            expected="three finite numbers of millimetres, X,Y,Z",
            found=f'"{text}"',
            remedy="Write it without spaces, like --target 10,-5,120.",
        )
    return values


def _check_target(console: Console, arguments: Check, target: Array) -> int:
    scenario = load_scenario(arguments.file, set=assignments(arguments.set))
    found = reaches(scenario, target)
    answer = "yes" if found.reached else "no"
    print_rows(console, f"{arguments.file}: target {millimetres(target)}", _rows(found))
    console.print(f"reachable: {answer}", highlight=False)
    return GOOD if found.reached else NEGATIVE


def _rows(found: Reach) -> Rows:
    return [
        ("distance left", f"{found.distance * MM_PER_M:.4f} mm"),
        ("tip", millimetres(found.tip)),
        ("steps", f"{found.steps}{'' if found.rested else ', without coming to rest'}"),
        ("status", found.status.value),
        *(("what stops it" if i == 0 else "", text) for i, text in enumerate(found.obstacles)),
    ]
