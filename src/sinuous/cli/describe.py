"""What good files hold, as rows of a table; bad ones raise `InputError`."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from sinuous.cli.table import Rows, millimetres
from sinuous.files import read_path_csv
from sinuous.geometry.mesh import check_mesh
from sinuous.plants.plant import Plant
from sinuous.recording import read
from sinuous.scenario import Scenario, load_scenario
from sinuous.scenario.start import check_start
from sinuous.summary import summarise
from sinuous.view.summary_table import summary_rows
from sinuous.view.units import MM_PER_M, MS_PER_S


def mesh(path: Path, unit: str) -> Rows:
    """Rows about a mesh file."""
    report = check_mesh(path, unit=unit)
    report.raise_if_unusable()
    findings = [("finding", str(finding)) for finding in report.findings]
    return [
        ("triangles", str(report.triangles)),
        ("vertices", str(report.vertices)),
        ("extents", millimetres(np.array(report.extents))),
        ("from", millimetres(np.array(report.lower))),
        ("to", millimetres(np.array(report.upper))),
        ("watertight", "yes"),
        *(findings or [("findings", "none")]),
    ]


def scenario(path: Path, overrides: list[str]) -> Rows:
    """Rows about a scenario, its robot in its zone and its start."""
    found = load_scenario(path, set=overrides)
    check_start(found)
    mpc = found.mpc
    start = found.robot.points(found.first_configuration)
    room = (found.zone.clearance(start) - found.robot.radii)[found.robot.movable]
    targets = np.array([leg.at(leg.moving) for leg in found.path])
    steps = sum(leg.steps(mpc.dt) for leg in found.path)
    return [
        ("name", found.name),
        ("robot", f"{found.robot.name}, base at {millimetres(start[0])}"),
        ("zone", _zone(len(found.zone.triangles), len(found.zone.surfaces))),
        ("margin", f"{mpc.margin * MM_PER_M:g} mm"),
        ("least clearance at the start", _room(float(np.min(room, initial=np.inf)))),
        ("plan", f"horizon {mpc.horizon}, every {mpc.dt * MS_PER_S:.4g} ms"),
        ("controller", "the plan alone" if found.law is None else str(found.law)),
        ("path", f"{len(found.path)} legs, at most {steps} steps"),
        ("targets", "; ".join(millimetres(target) for target in targets)),
        ("clearance of the targets", "; ".join(map(_room, found.zone.clearance(targets)))),
        ("plant", _plant(found)),
        ("sensor", "exact" if found.sensor is None else _instrument(found.sensor)),
        ("seed", str(found.seed)),
    ]


def _plant(found: Scenario) -> str:
    if found.plant is not None:
        return "a record, played back"
    differs = found.mismatch or found.disturbance
    return "the model" if differs is None else str(differs)


def _instrument(sensor: Callable[[Plant, int], Plant]) -> str:
    """The instrument whose method wraps a plant."""
    return str(getattr(sensor, "__self__", sensor))


def _zone(triangles: int, surfaces: int) -> str:
    if not surfaces:
        return "none: free space"
    return f"{triangles} triangles" + (f", {surfaces - 1} keep-outs" if surfaces > 1 else "")


def _room(clearance: float) -> str:
    return f"{clearance * MM_PER_M:.2f} mm" if np.isfinite(clearance) else "no wall"


def path(file: Path) -> Rows:
    """Rows about the CSV file of a path."""
    times, points = read_path_csv(file)
    step = np.linalg.norm(np.diff(points, axis=0), axis=1)
    speed = np.max(step / np.diff(times), initial=0.0)
    return [
        ("points", str(len(times))),
        ("time", f"{times[0]:g} to {times[-1]:g} s"),
        ("length", millimetres(np.array([step.sum()]))),
        ("fastest", f"{speed * MM_PER_M:.4g} mm/s"),
        ("from", millimetres(points.min(axis=0))),
        ("to", millimetres(points.max(axis=0))),
    ]


def recording(file: Path) -> Rows:
    """Rows about a recording."""
    found = read(file)
    header = found.header
    return [
        ("name", header.name),
        ("steps", f"{len(found)}, every {header.dt * MS_PER_S:.4g} ms"),
        ("complete", "yes" if found.complete else "no: it was cut off; what is there is good"),
        ("margin", f"{header.margin * MM_PER_M:g} mm"),
        *summary_rows(summarise(found)),
    ]
