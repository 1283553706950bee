"""Robot files: a TOML of millimetres and degrees becomes a `PccRobot` in SI.

The format is declared in `robot_tables`; the presets beside this file are examples of it.
"""

from pathlib import Path

from sinuous.errors import InputError
from sinuous.files import build, did_you_mean, read_toml
from sinuous.robots.parts import Insertion, Segment, SpeedLimits, Tool
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_tables import LimitsTable, RobotTable, SegmentTable

PRESETS = Path(__file__).parent / "presets"


def load_robot(name_or_path: str | Path, *, limits: str = "simulation") -> PccRobot:
    """Return the robot of a preset or a robot file.

    Arguments:
        name_or_path: the name of a preset, or the path of a TOML file
        limits: which of the file's `[limits.NAME]` tables holds

    Raises:
        InputError: if there is no such robot, or something is wrong with its file
    """
    path = robot_path(name_or_path)
    table = build(RobotTable, read_toml(path), file=str(path))
    if limits not in table.limits:
        raise InputError(
            file=str(path),
            field=f"limits.{limits}",
            expected="a set of limits of this name",
            found="none",
            remedy=did_you_mean(limits, list(table.limits), what="sets of limits"),
        )
    return _robot(table, table.limits[limits])


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


def _robot(table: RobotTable, limits: LimitsTable) -> PccRobot:
    lengths = limits.cable_lengths(len(table.segment))
    stage, tool = table.insertion, table.tool
    return PccRobot(
        name=table.name,
        segments=tuple(map(_segment, table.segment, lengths)),
        speed=SpeedLimits(
            cable=limits.cable_speed,
            backbone=limits.backbone_speed or 0.0,  # without an actuator nobody reads it
            insertion=limits.insertion_speed or 0.0,
        ),
        convention=table.cable_convention,
        insertion=stage and Insertion(travel=stage.travel, home=stage.start, radius=stage.radius),
        tool=tool and Tool(offset=tool.offset, radius=tool.radius),
        spacing=table.guard_spacing,
    )


def _segment(table: SegmentTable, cable_length: tuple[float, float]) -> Segment:
    return Segment(
        length=table.range,
        home_length=table.home,
        disks=table.disks,
        cable_angles=table.cable_angles,
        pitch_radii=table.radii,
        body_radius=table.body_radius,
        disk_thickness=table.disk_thickness,
        max_curvature=table.curvature,
        cable_length=cable_length,
    )
