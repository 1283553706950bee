"""From what somebody typed into fields of a scenario, and whether it can be used."""

import json
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sinuous.errors import InputError
from sinuous.files import build, read_toml
from sinuous.live import Recipe
from sinuous.live.act import checked
from sinuous.robots.robot_file import PRESETS, load_robot
from sinuous.scenario.tables import ScenarioTable
from sinuous.view.units import MM_PER_M

ROBOTS = tuple(sorted(path.stem for path in PRESETS.glob("*.toml")))
UNITS = ("mm", "cm", "m")
HAND_HZ = 1000.0  # the rate of the operator's side, which a controller's has to divide

Vector = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """What the panel asks for.

    Arguments:
        robot: a preset, or the path of a robot file
        mesh: path of the zone's mesh; empty for the one there is
        unit: of the mesh
        entrance: where the mesh is opened, "x, y, z" [mm]; empty for as it is
        keep_out: paths of meshes to stay out of, with commas between
        margin: to every wall [mm]
        position: of the base (x, y, z) [mm]
        rotation: of the base about fixed x, then y, then z [degrees]
    """

    robot: str
    mesh: str
    unit: str
    entrance: str
    keep_out: str
    margin: float
    position: Vector
    rotation: Vector


def table_of(text: str, file: str) -> ScenarioTable:
    """The fields of a scenario that runs."""
    return build(ScenarioTable, tomllib.loads(text), file=file)


def live_scenarios(folder: Path) -> tuple[Path, ...]:
    """Scenarios in a folder whose controller keeps step with a hand in real time."""
    return tuple(path for path in sorted(folder.glob("*.toml")) if _is_live(path))


def _is_live(path: Path) -> bool:
    try:
        table = build(ScenarioTable, read_toml(path), file=str(path))
    except InputError:
        return False  # a robot, or somebody's draft
    ticks = HAND_HZ / table.mpc.rate
    return table.plant.recorded is None and abs(ticks - round(ticks)) < 1e-9 and ticks >= 1.0


def assignments_for(wanted: Wanted, now: ScenarioTable) -> tuple[str, ...]:
    """Fields to change, as on the command line, for a scenario that runs.

    Raises:
        InputError: if the entrance is not three numbers, or the robot cannot be used
    """
    robot = wanted.robot if wanted.robot in ROBOTS else _absolute(wanted.robot)
    found = [
        f"robot.base_position_mm={_row(wanted.position)}",
        f"robot.base_rotation_deg={_row(wanted.rotation)}",
        f"mpc.margin_mm={float(wanted.margin)!r}",
    ]
    if robot != now.robot.file:
        found.append(f"robot.file={json.dumps(robot)}")
        if now.robot.start_lengths is not None:  # those of a robot with other actuators
            new = load_robot(robot, limits=now.robot.limits)
            found.append(f"robot.start_lengths_mm={_row(MM_PER_M * new.lengths(new.home))}")
    if wanted.mesh.strip():
        found += [f"zone.mesh={json.dumps(_absolute(wanted.mesh))}", f'zone.unit="{wanted.unit}"']
        outside = [_absolute(one) for one in wanted.keep_out.split(",") if one.strip()]
        found.append(f"zone.keep_out={json.dumps(outside)}")
        if wanted.entrance.strip():
            found.append(f"zone.entrance_mm={_row(point_in(wanted.entrance))}")
    return tuple(found)


def point_in(text: str) -> Vector:
    """Three numbers with commas or spaces between them.

    Raises:
        InputError: if it is anything else
    """
    try:
        x, y, z = (float(part) for part in text.replace(",", " ").split())
        if not np.all(np.isfinite((x, y, z))):
            raise ValueError
    except ValueError:
        raise InputError(
            file="a point",
            expected='three numbers in millimetres, such as "0, 0, 40"',
            found=f'"{text}"',
            remedy="Correct it.",
        ) from None
    return x, y, z


def refusal(text: str, file: str, fields: tuple[str, ...], folder: Path) -> str:
    """Why a scenario with other fields cannot run; empty if it can.

    Arguments:
        text: of the scenario that runs, its paths absolute
        file: where it came from, for the message
        fields: to change
        folder: for a copy of the text
    """
    copy = folder / "scenario.toml"
    copy.write_text(text, encoding="utf-8")
    try:
        checked(Recipe(str(copy), fields))
    except InputError as error:
        return str(error).replace(str(copy), file)
    return ""


def _absolute(text: str) -> str:
    """A path as it is meant by who types it: from where the program was started."""
    return str(Path(text.strip()).expanduser().resolve())


def _row(values: object) -> str:
    return json.dumps([round(float(value), 9) for value in np.asarray(values).ravel()])
