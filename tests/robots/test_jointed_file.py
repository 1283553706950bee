"""Files of jointed robots: what arrives, and every error by its message."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.errors import InputError
from sinuous.robots.jointed import JointedRobot, contact_bend
from sinuous.robots.parts import Insertion, JointOrder, Tool
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_jointed, load_pcc, load_robot

from .test_robot_file import ROBOT as SEGMENTED
from .test_robot_file import toml

MODULES: dict[str, Any] = {
    "count": 4,
    "holes": 12,
    "radius_mm": 30,
    "plate_offset_mm": 10,
    "tube_length_mm": 80,
}
ROBOT: dict[str, Any] = {
    "name": "arm",
    "modules": MODULES,
    "limits": {"simulation": {"cable_speed_mm_s": 150}},
}
STAGE = {"travel_mm": [0, 200], "radius_mm": 8}


def with_modules(**fields: Any) -> dict[str, Any]:
    """The robot with other fields in `[modules]`; None removes a field."""
    table = {key: value for key, value in (MODULES | fields).items() if value is not None}
    return ROBOT | {"modules": table}


def with_limits(**fields: Any) -> dict[str, Any]:
    return ROBOT | {"limits": {"simulation": ROBOT["limits"]["simulation"] | fields}}


def load(data: dict[str, Any], folder: Path) -> JointedRobot:
    """Write the tables as a file, as a user would, and load it."""
    path = folder / "robot.toml"
    path.write_text("\n".join(f"{key} = {toml(value)}" for key, value in data.items()))
    return load_jointed(path)


def test_the_fields_arrive_in_si(tmp_path: Path) -> None:
    modules = MODULES | {"joint_order": ["zx", "xz", "zx", "xz"], "max_bend_deg": 30}
    pairs = [[60, 110], [150, 210], [250, 310], [350, 410]]
    limits = {"cable_speed_mm_s": 150, "insertion_speed_mm_s": 40, "cable_length_mm": pairs}
    robot = load(
        ROBOT
        | {
            "modules": modules,
            "limits": {"simulation": limits},
            "guard_spacing_mm": 8,
            "insertion": STAGE | {"home_mm": 20},
            "tool": {"offset_mm": [0, 40, 0], "radius_mm": 5},
        },
        tmp_path,
    )
    assert (robot.name, robot.joints, robot.holes, robot.spacing) == ("arm", 4, 12, 0.008)
    assert (robot.radius, robot.plate_offset, robot.tube_length) == (0.03, 0.01, 0.08)
    assert robot.orders == (JointOrder.ZX, JointOrder.XZ) * 2
    assert robot.bend_limit == pytest.approx(math.radians(30), rel=1e-15)
    assert np.array_equal(robot.length_limits[1:], np.repeat(pairs, 3, axis=0) / 1e3)
    assert robot.insertion == Insertion(travel=(0.0, 0.2), home=0.02, radius=0.008)
    assert robot.tool == Tool(offset=(0.0, 0.04, 0.0), radius=0.005)
    assert np.array_equal(robot.rate_limits[:2], [[-0.04, 0.04], [-0.15, 0.15]])
    np.testing.assert_allclose(robot.tip(robot.home), [0.0, 0.46, 0.0], rtol=1e-14, atol=0)


def test_what_may_be_left_out(tmp_path: Path) -> None:
    robot = load(ROBOT, tmp_path)
    assert robot.orders == (JointOrder.ZX,) * 4
    assert robot.bend_limit == contact_bend(0.03, 0.01)
    assert (robot.insertion, robot.tool, robot.cable_lengths) == (None, None, ())
    assert robot.spacing == 0.003


def test_one_range_of_lengths_is_that_of_all_modules(tmp_path: Path) -> None:
    robot = load(with_limits(cable_length_mm=[50, 450]), tmp_path)
    assert np.array_equal(robot.length_limits, np.tile([0.05, 0.45], (12, 1)))


def test_a_limit_may_be_where_plates_touch(tmp_path: Path) -> None:
    """Also as a file rounds it, up to a billionth of a radian."""
    contact = contact_bend(0.03, 0.01)
    robot = load(with_modules(max_bend_rad=contact + 5e-10), tmp_path)
    assert robot.bend_limit == contact


def test_loaders_of_one_kind_refuse_the_other() -> None:
    assert isinstance(load_robot("qin2020"), JointedRobot)
    assert isinstance(load_robot("hachen2025"), PccRobot)
    with pytest.raises(InputError) as caught:
        load_pcc("qin2020")
    assert str(caught.value) == (
        "qin2020: expected a robot of segments, found one of modules. Name another robot."
    )
    with pytest.raises(InputError, match="hachen2025: expected a robot of modules, found one of"):
        load_jointed("hachen2025")


BAD: list[tuple[str, dict[str, Any], str]] = [
    (
        "no modules",
        with_modules(count=0),
        "modules.count: expected at least 1, found 0. Correct this value.",
    ),
    (
        "half a module",
        with_modules(count=2.5),
        "modules.count: expected a whole number, found 2.5. Correct this value.",
    ),
    (
        "too few holes",
        with_modules(holes=9),
        "modules.holes: expected a multiple of 3 and at least 12, 3 for the cables of each of 4 "
        "modules, found 9. Take more holes or fewer modules: cables that share a hole would rub.",
    ),
    (
        "holes that are not spread evenly over three cables",
        with_modules(holes=16),
        "modules.holes: expected a multiple of 3 and at least 12, 3 for the cables of each of 4 "
        "modules, found 16. Take more holes or fewer modules: cables that share a hole would rub.",
    ),
    (
        "no holes",
        with_modules(holes=0),
        "modules.holes: expected at least 3, found 0. Correct this value.",
    ),
    (
        "negative radius",
        with_modules(radius_mm=-30),
        "modules.radius_mm: expected more than 0, found -30. Correct this value.",
    ),
    (
        "negative tube",
        with_modules(tube_length_mm=-80),
        "modules.tube_length_mm: expected more than 0, found -80. Correct this value.",
    ),
    (
        "plates at the joint",
        with_modules(plate_offset_mm=0),
        "modules.plate_offset_mm: expected more than 0, found 0. Correct this value.",
    ),
    (
        "bends beyond contact",
        with_modules(max_bend_deg=40),
        "modules.max_bend_deg: expected at most 36.87 degrees, where the plates of this radius "
        "and offset touch, found 40. Reduce it, or leave it out for that bend.",
    ),
    (
        "no bend",
        with_modules(max_bend_deg=0),
        "modules.max_bend_deg: expected more than 0, found 0. Correct this value.",
    ),
    (
        "unknown order",
        with_modules(joint_order="yx"),
        'modules.joint_order: expected "zx" or "xz" or a list, found "yx". Correct this value.',
    ),
    (
        "an unknown order of one",
        with_modules(joint_order=["zx", "xy", "zx", "xz"]),
        'modules.joint_order[1]: expected "zx" or "xz", found "xy". Correct this value.',
    ),
    (
        "an order too few",
        with_modules(joint_order=["zx", "xz", "zx"]),
        "modules.joint_order: expected one order, or 4, one for each joint, found "
        '["zx", "xz", "zx"]. Give as many orders as modules.',
    ),
    (
        "bare radius",
        with_modules(radius=30),
        "modules.radius: expected a key of modules, found an unknown one. "
        "Write radius_mm, radius_cm or radius_m: a key carries its unit.",
    ),
    (
        "no tube",
        with_modules(tube_length_mm=None),
        "modules.tube_length: expected a value, found nothing. "
        "Add tube_length_mm, tube_length_cm or tube_length_m to modules.",
    ),
    (
        "modules as a list",
        ROBOT | {"modules": [MODULES]},
        "modules: expected a table, found [a table]. "
        "Write its header with single brackets, [modules].",
    ),
    (
        "both kinds",
        ROBOT | {"segment": SEGMENTED["segment"]},
        "expected either [[segment]] tables or a [modules] table, found both. "
        "Keep one: a robot bends along segments or at joints.",
    ),
    (
        "neither kind",
        {key: value for key, value in ROBOT.items() if key != "modules"},
        "expected either [[segment]] tables or a [modules] table, found neither. "
        "Say what bends: docs/files.md has an example of each.",
    ),
    (
        "no insertion speed",
        ROBOT | {"insertion": STAGE},
        "limits.simulation.insertion_speed: expected a speed, because there is an insertion "
        "stage, found nothing. Add insertion_speed_mm_s to [limits.simulation].",
    ),
    (
        "a backbone",
        with_limits(backbone_speed_mm_s=10),
        "limits.simulation.backbone_speed_mm_s: expected a key of limits.simulation, found an "
        "unknown one. Did you mean cable_speed_mm_s, cable_speed_m_s or cable_speed_cm_s?",
    ),
    (
        "cable limits without the home length",
        with_limits(cable_length_mm=[50, 350]),
        "limits.simulation.cable_length_mm: expected a shortest length below and a longest above "
        "400 mm, the length of module 4's cables at home, found [50, 350]. Otherwise they cannot "
        "move both ways: correct the limits, the plate offset or the tube length.",
    ),
    (
        "cable limits for too few modules",
        with_limits(cable_length_mm=[[60, 110], [150, 210]]),
        "limits.simulation.cable_length_mm: expected one pair, or 4, one for each module, found "
        "[[60, 110], [150, 210]]. Give as many pairs as modules.",
    ),
]


@pytest.mark.parametrize(
    ("data", "message"), [case[1:] for case in BAD], ids=[case[0] for case in BAD]
)
def test_bad_robot_file(tmp_path: Path, data: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as caught:
        load(data, tmp_path)
    assert str(caught.value) == f"{tmp_path / 'robot.toml'}: {message}"
