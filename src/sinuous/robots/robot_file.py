"""Robot files: a TOML of millimetres and degrees becomes a robot in SI.

A file with `[[segment]]` tables is a `PccRobot`, one with a `[modules]` table a `JointedRobot`.
The formats are declared in `pcc_tables` and `jointed_tables`; the presets beside this file are
examples of them.
"""

from pathlib import Path

from sinuous.errors import InputError
from sinuous.files import build, did_you_mean, read_toml
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.jointed_tables import JointedTable
from sinuous.robots.pcc import PccRobot
from sinuous.robots.pcc_tables import PccTable

PRESETS = Path(__file__).parent / "presets"


def load_robot(name_or_path: str | Path, *, limits: str = "simulation") -> PccRobot | JointedRobot:
    """Return the robot of a preset or a robot file.

    Arguments:
        name_or_path: the name of a preset, or the path of a TOML file
        limits: which of the file's `[limits.NAME]` tables holds

    Raises:
        InputError: if there is no such robot, or something is wrong with its file
    """
    path = robot_path(name_or_path)
    table = _table(path)
    if limits not in table.limits:
        raise InputError(
            file=str(path),
            field=f"limits.{limits}",
            expected="a set of limits of this name",
            found="none",
            remedy=did_you_mean(limits, list(table.limits), what="sets of limits"),
        )
    return table.robot(limits)


def load_pcc(name_or_path: str | Path, *, limits: str = "simulation") -> PccRobot:
    """Return a robot that must be one of constant-curvature segments; see `load_robot`."""
    robot = load_robot(name_or_path, limits=limits)
    if not isinstance(robot, PccRobot):
        raise _other_kind(name_or_path, "a robot of segments", "one of modules")
    return robot


def load_jointed(name_or_path: str | Path, *, limits: str = "simulation") -> JointedRobot:
    """Return a robot that must be one of rigid modules; see `load_robot`."""
    robot = load_robot(name_or_path, limits=limits)
    if not isinstance(robot, JointedRobot):
        raise _other_kind(name_or_path, "a robot of modules", "one of segments")
    return robot


def _table(path: Path) -> PccTable | JointedTable:
    data, file = read_toml(path), str(path)
    match "segment" in data, "modules" in data:
        case True, False:
            return build(PccTable, data, file=file)
        case False, True:
            return build(JointedTable, data, file=file)
        case True, True:
            found, remedy = "both", "Keep one: a robot bends along segments or at joints."
        case _:
            found, remedy = "neither", "Say what bends: docs/files.md has an example of each."
    raise InputError(
        file=file,
        expected="either [[segment]] tables or a [modules] table",
        found=found,
        remedy=remedy,
    )


def _other_kind(name_or_path: str | Path, expected: str, found: str) -> InputError:
    return InputError(
        file=str(name_or_path), expected=expected, found=found, remedy="Name another robot."
    )


def preset_names() -> list[str]:
    """Return the names of the robots that come with the package."""
    return sorted(path.stem for path in PRESETS.glob("*.toml"))


def robot_path(name_or_path: str | Path) -> Path:
    """Return the file of a preset, or the path as it is.

    Raises:
        InputError: if it looks like the name of a preset and there is none of this name
    """
    path = Path(name_or_path)
    if isinstance(name_or_path, Path) or path.suffix == ".toml" or len(path.parts) != 1:
        return path
    if name_or_path in preset_names():
        return PRESETS / f"{name_or_path}.toml"
    raise InputError(
        file=name_or_path,
        expected="a preset or the path of a robot file ending in .toml",
        found="neither",
        remedy=did_you_mean(name_or_path, preset_names(), what="presets"),
    )
