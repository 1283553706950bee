"""Robot files: presets against the numbers they come from, every error by its message."""

import math
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.errors import InputError
from sinuous.files import build, override, read_toml
from sinuous.robots.parts import CableConvention, Insertion, Tool
from sinuous.robots.pcc import PccRobot
from sinuous.robots.pcc_tables import PccTable
from sinuous.robots.robot_file import PRESETS, load_robot, preset_names

ROUNDING = 1e-15  # relative: a unit conversion rounds once or twice

SEGMENT: dict[str, Any] = {
    "length_mm": [40, 90],
    "disks": 10,
    "cable_angles_deg": [0, 120, 240],
    "pitch_radius_mm": 7,
    "body_radius_mm": 8,
    "disk_thickness_mm": 2,
}
ROBOT: dict[str, Any] = {
    "name": "two",
    "segment": [SEGMENT, SEGMENT | {"length_mm": 60}],
    "limits": {
        "simulation": {
            "cable_speed_mm_s": 20,
            "backbone_speed_mm_s": 10,
            "cable_length_mm": [22, 108],
        }
    },
}
STAGE = {"travel_mm": [0, 200], "radius_mm": 8}


def changed(**tables: Any) -> dict[str, Any]:
    return ROBOT | tables


def with_segment(**fields: Any) -> dict[str, Any]:
    """The robot with other fields in its second segment; None removes a field."""
    table = {key: value for key, value in (SEGMENT | fields).items() if value is not None}
    return changed(segment=[SEGMENT, table])


def with_limits(**fields: Any) -> dict[str, Any]:
    limits = ROBOT["limits"]["simulation"] | fields
    table = {key: value for key, value in limits.items() if value is not None}
    return changed(limits={"simulation": table})


def load(data: dict[str, Any], folder: Path) -> PccRobot:
    """Write the tables as a file, as a user would, and load it."""
    path = folder / "robot.toml"
    path.write_text("\n".join(f"{key} = {toml(value)}" for key, value in data.items()))
    return load_robot(path)


def toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else str(value)


def test_the_fields_arrive_in_si(tmp_path: Path) -> None:
    robot = load(
        changed(
            segment=[
                SEGMENT | {"home_length_mm": 50, "min_bend_radius_mm": 35},
                SEGMENT
                | {
                    "length_mm": 60,
                    "cable_angles_deg": [0, 90, 180, 270],
                    "pitch_radius_mm": [7, 6, 7, 6],
                    "max_curvature_1_m": 20,
                },
                SEGMENT,
            ],
            limits={
                "simulation": {
                    "cable_speed_mm_s": 20,
                    "backbone_speed_mm_s": 10,
                    "insertion_speed_mm_s": 30,
                    "cable_length_mm": [[22, 108], [40, 80], [30, 100]],
                }
            },
            guard_spacing_mm=2.5,
            insertion=STAGE | {"home_mm": 20},
            tool={"offset_mm": [0, 1, 10], "radius_mm": 1.5},
        ),
        tmp_path,
    )
    first, second, third = robot.segments
    assert (first.length, first.home_length) == ((0.04, 0.09), 0.05)
    assert first.cable_angles == pytest.approx((0.0, math.tau / 3, 2 * math.tau / 3), rel=ROUNDING)
    assert first.max_curvature == pytest.approx(1 / 0.035, rel=ROUNDING)
    assert (second.length, second.home_length) == ((0.06, 0.06), 0.06)
    assert second.pitch_radii == (0.007, 0.006, 0.007, 0.006)
    assert (second.max_curvature, third.max_curvature) == (20.0, math.inf)
    assert third.home_length == 0.065
    limits = [segment.cable_length for segment in robot.segments]
    assert limits == [(0.022, 0.108), (0.04, 0.08), (0.03, 0.1)]
    assert (robot.speed.cable, robot.speed.backbone, robot.speed.insertion) == (0.02, 0.01, 0.03)
    assert robot.insertion == Insertion(travel=(0.0, 0.2), home=0.02, radius=0.008)
    assert robot.tool == Tool(offset=(0.0, 0.001, 0.01), radius=0.0015)
    assert (robot.name, robot.spacing, robot.convention) == ("two", 0.0025, CableConvention.SEGMENT)


def test_presets_are_listed_and_load_with_both_sets_of_limits() -> None:
    assert preset_names() == ["hachen2025", "opencr_v4", "opencr_v6", "qin2020"]
    for name in preset_names():
        for limits in ("simulation", "hardware"):
            robot = load_robot(name, limits=limits)
            assert robot.name == name
            lengths = robot.lengths(robot.home)
            assert np.all(robot.length_limits[:, 0] <= lengths)
            assert np.all(lengths <= robot.length_limits[:, 1])
            assert np.all(robot.bend_slack(robot.home) > 0.0)


def test_hachen2025() -> None:
    robot = load_robot("hachen2025")
    assert len(robot.actuator_names) == 12
    assert robot.convention is CableConvention.SEGMENT
    for segment in robot.segments:
        assert (segment.length, segment.home_length) == ((0.04, 0.09), 0.065)
        assert segment.pitch_radii == (0.007,) * 3
        assert (segment.disks, segment.body_radius, segment.disk_thickness) == (10, 0.008, 0.002)
        assert segment.max_curvature == pytest.approx(1 / 0.035, rel=ROUNDING)
        assert segment.cable_length == (0.022, 0.108)
    assert (robot.speed.cable, robot.speed.backbone) == (0.02, 0.01)
    hardware = load_robot("hachen2025", limits="hardware").speed
    assert (hardware.cable, hardware.backbone) == (0.0045, 0.0009)


@pytest.mark.parametrize(
    ("name", "lengths"),
    [("opencr_v4", (0.06, 0.0625, 0.064)), ("opencr_v6", (0.1, 0.1, 0.022))],
)
def test_opencr(name: str, lengths: tuple[float, ...]) -> None:
    robot = load_robot(name)
    assert robot.convention is CableConvention.MOTOR
    assert len(robot.actuator_names) == 9
    assert tuple(segment.length for segment in robot.segments) == tuple((x, x) for x in lengths)
    for number, segment in enumerate(robot.segments):
        degrees = 30.0 * number + np.array([0.0, 120.0, 240.0])
        assert segment.cable_angles == pytest.approx(np.radians(degrees), rel=ROUNDING)
        assert segment.pitch_radii == (0.0045,) * 3
        assert segment.body_radius == 0.0055
    assert robot.lengths(robot.home) == pytest.approx(np.repeat(np.cumsum(lengths), 3))


@pytest.mark.parametrize("name", preset_names())
def test_every_number_of_a_preset_says_where_it_comes_from(name: str) -> None:
    table = ""
    previous = ""
    for line in (PRESETS / f"{name}.toml").read_text().splitlines():
        if line.startswith("["):
            table = line
        key = line.partition(" = ")[0]
        if "=" in line and not line.startswith("#") and key not in ("name", "about"):
            said = previous + line.partition("#")[2]
            words = ("printed", "representative", "stated", "recorded", "ours")
            assert any(word in said for word in words), f"{table} {line}"
        previous = line if line.startswith("#") else ""


def test_a_preset_can_be_changed_with_overrides() -> None:
    data = override(read_toml(PRESETS / "hachen2025.toml"), ["segment[0].body_radius_m=0.009"])
    assert build(PccTable, data, file="x").segment[0].body_radius == 0.009


BAD: list[tuple[str, dict[str, Any], str]] = [
    (
        "no name",
        {key: value for key, value in ROBOT.items() if key != "name"},
        "name: expected a value, found nothing. Add name to the file.",
    ),
    (
        "empty name",
        changed(name=""),
        'name: expected a text that is not empty, found "". Correct this value.',
    ),
    (
        "no segment",
        changed(segment=[]),
        "segment: expected a list of at least 1, found []. Correct this value.",
    ),
    (
        "negative length",
        with_segment(length_mm=-60),
        "segment[1].length_mm: expected more than 0 or a list, found -60. Correct this value.",
    ),
    (
        "length of zero in a pair",
        with_segment(length_mm=[0, 60]),
        "segment[1].length_mm[0]: expected more than 0, found 0. Correct this value.",
    ),
    (
        "lengths swapped",
        with_segment(length_mm=[90, 40]),
        "segment[1].length_mm: expected a smaller and then a larger value, found [90, 40]. "
        "Put the smaller first; for a fixed length give a single number.",
    ),
    (
        "home outside",
        with_segment(home_length_mm=91),
        "segment[1].home_length_mm: expected a length between the shortest and the longest, "
        "found 91. Correct it, or leave it out for the middle.",
    ),
    (
        "no disks",
        with_segment(disks=0),
        "segment[1].disks: expected at least 1, found 0. Correct this value.",
    ),
    (
        "disks fill the segment",
        with_segment(disk_thickness_mm=4),
        "segment[1].disk_thickness_mm: expected 10 disks that leave room to bend in the shortest "
        "length, found 4. Take fewer or thinner disks, or a longer segment.",
    ),
    (
        "two cables",
        with_segment(cable_angles_deg=[0, 180]),
        "segment[1].cable_angles_deg: expected a list of at least 3, found [0, 180]. "
        "Correct this value.",
    ),
    (
        "cables in one plane",
        with_segment(cable_angles_deg=[0, 180, 360]),
        "segment[1].cable_angles_deg: expected cables around the backbone, not all on one line "
        "through it, found [0, 180, 360]. "
        "Spread the holes, for example 0, 120 and 240 degrees.",
    ),
    (
        "a radius too few",
        with_segment(pitch_radius_mm=[7, 7]),
        "segment[1].pitch_radius_mm: expected one number, or 3, one for each cable, found [7, 7]. "
        "Give as many radii as cable angles.",
    ),
    (
        "cables outside of the body",
        with_segment(pitch_radius_mm=[7, 8, 7]),
        "segment[1].pitch_radius_mm: expected cables inside the body, closer to the backbone than "
        "the body radius, found [7, 8, 7]. Correct the pitch radius or the body radius.",
    ),
    (
        "two bend limits",
        with_segment(min_bend_radius_mm=35, max_curvature_1_m=28),
        "segment[1].min_bend_radius_mm: expected either a least bend radius or a largest "
        "curvature, found 35. Keep one of them: one is the inverse of the other.",
    ),
    (
        "endless length",
        with_segment(length_mm=math.inf),
        "segment[1].length_mm: expected a finite number, found inf. Correct this value.",
    ),
    (
        "bare pitch radius",
        with_segment(pitch_radius=7),
        "segment[1].pitch_radius: expected a key of segment[1], found an unknown one. "
        "Write pitch_radius_mm, pitch_radius_cm or pitch_radius_m: a key carries its unit.",
    ),
    (
        "no limits",
        changed(limits={}),
        "limits: expected a table of at least 1, found a table. Correct this value.",
    ),
    (
        "a speed of zero",
        with_limits(cable_speed_mm_s=0),
        "limits.simulation.cable_speed_mm_s: expected more than 0, found 0. Correct this value.",
    ),
    (
        "no backbone speed",
        with_limits(backbone_speed_mm_s=None),
        "limits.simulation.backbone_speed: expected a speed, because a segment changes its "
        "length, found nothing. Add backbone_speed_mm_s to [limits.simulation].",
    ),
    (
        "no insertion speed",
        changed(insertion=STAGE),
        "limits.simulation.insertion_speed: expected a speed, because there is an insertion "
        "stage, found nothing. Add insertion_speed_mm_s to [limits.simulation].",
    ),
    (
        "cable limits for too many segments",
        with_limits(cable_length_mm=[[22, 108]] * 3),
        "limits.simulation.cable_length_mm: expected one pair, or 2, one for each segment, found "
        "[[22, 108], [22, 108], [22, 108]]. Give as many pairs as segments.",
    ),
    (
        "cable limits without the home length",
        with_limits(cable_length_mm=[22, 60]),
        "limits.simulation.cable_length_mm: expected a shortest length below and a longest above "
        "65 mm, the length of segment 1's cables at home, found [22, 60]. Otherwise they cannot "
        "move both ways: correct the limits, the home length or the cable convention.",
    ),
    (
        "cable limits of the other convention",
        changed(cable_convention="motor"),
        "limits.simulation.cable_length_mm: expected a shortest length below and a longest above "
        "125 mm, the length of segment 2's cables at home, found [22, 108]. Otherwise they cannot "
        "move both ways: correct the limits, the home length or the cable convention.",
    ),
    (
        "unknown convention",
        changed(cable_convention="tip"),
        'cable_convention: expected "segment" or "motor", found "tip". Correct this value.',
    ),
    (
        "travel swapped",
        changed(insertion=STAGE | {"travel_mm": [200, 0]}),
        "insertion.travel_mm: expected a smaller and then a larger value, found [200, 0]. "
        "Put the smaller first; for a fixed length give a single number.",
    ),
    (
        "stage starts outside of its travel",
        changed(insertion=STAGE | {"home_mm": 201}),
        "insertion.home_mm: expected a position within the travel, found 201. "
        "Correct it, or leave it out for the start of the travel.",
    ),
    (
        "flat tool",
        changed(tool={"offset_mm": [0, 10], "radius_mm": 1}),
        "tool.offset_mm: expected a list of at least 3, found [0, 10]. Correct this value.",
    ),
]


@pytest.mark.parametrize(
    ("data", "message"), [case[1:] for case in BAD], ids=[case[0] for case in BAD]
)
def test_bad_robot_file(tmp_path: Path, data: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as caught:
        load(data, tmp_path)
    assert str(caught.value) == f"{tmp_path / 'robot.toml'}: {message}"


def test_unknown_preset() -> None:
    with pytest.raises(InputError) as caught:
        load_robot("hachen2052")
    assert str(caught.value) == (
        "hachen2052: expected a preset or the path of a robot file ending in .toml, "
        "found neither. Did you mean hachen2025?"
    )
    with pytest.raises(
        InputError, match=r"Known presets: hachen2025, opencr_v4, opencr_v6, qin2020\."
    ):
        load_robot("snake")


def test_missing_file_and_missing_limits(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="expected a file, found nothing there"):
        load_robot(str(tmp_path / "mine.toml"))
    copy = shutil.copy(PRESETS / "hachen2025.toml", tmp_path / "mine.toml")
    with pytest.raises(InputError) as caught:
        load_robot(copy, limits="hardwear")
    assert str(caught.value) == (
        f"{copy}: limits.hardwear: expected a set of limits of this name, found none. "
        "Did you mean hardware?"
    )
