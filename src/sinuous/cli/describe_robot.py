"""What a good robot file holds, as rows of a table."""

from math import degrees
from pathlib import Path

import numpy as np

from sinuous.cli.table import Rows, millimetres
from sinuous.files import read_toml
from sinuous.robots.jointed import ROUNDING, JointedRobot, contact_bend
from sinuous.robots.jointed_kernels import CABLES
from sinuous.robots.parts import Insertion, Segment
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot import Robot
from sinuous.robots.robot_file import load_robot
from sinuous.view.units import MM_PER_M


def robot(path: Path) -> Rows:
    """Rows about a robot file, for each of its sets of limits.

    Raises:
        InputError: if something is wrong with it
    """
    sets = read_toml(path).get("limits")
    names = [str(name) for name in sets] if isinstance(sets, dict) else ["simulation"]
    loaded = {name: load_robot(path, limits=name) for name in names}
    first = loaded[names[0]]
    return [
        ("name", first.name),
        *(_segments(first) if isinstance(first, PccRobot) else _modules(first)),
        ("insertion stage", _insertion(first.insertion)),
        ("tool", "none" if first.tool is None else millimetres(first.tool.offset)),
        ("coordinates", str(len(first.coordinate_names))),
        ("actuators", f"{len(first.actuator_names)}: {', '.join(first.actuator_names)}"),
        ("tip at home", millimetres(first.tip(first.home))),
        *((f"speeds, {name}", _speeds(each)) for name, each in loaded.items()),
        *((f"lengths, {name}", _lengths(each)) for name, each in loaded.items()),
    ]


def _segments(robot: PccRobot) -> Rows:
    parts = [f"{number}: {_segment(segment)}" for number, segment in enumerate(robot.segments, 1)]
    return [
        ("segments", "; ".join(parts)),
        ("cable lengths", f"counted in the {robot.convention.value}"),
    ]


def _segment(segment: Segment) -> str:
    length = " to ".join(f"{x * MM_PER_M:g}" for x in sorted({*segment.length}))
    parts = [
        f"{length} mm",
        f"{len(segment.cable_angles)} cables",
        f"{segment.disks} disks",
        f"body radius {segment.body_radius * MM_PER_M:g} mm",
    ]
    return ", ".join(parts)


def _modules(robot: JointedRobot) -> Rows:
    tube = f"{robot.tube_length * MM_PER_M:g} mm, radius {robot.radius * MM_PER_M:g} mm"
    touch = contact_bend(robot.radius, robot.plate_offset)
    further = robot.bend_limit < touch - ROUNDING
    contact = (
        f"; plates would touch at {degrees(touch):.4g} deg" if further else ", where plates touch"
    )
    orders = dict.fromkeys(order.value for order in robot.orders)  # one, if all are alike
    each = orders if len(orders) == 1 else (order.value for order in robot.orders)
    return [
        ("modules", f"{robot.joints}, {robot.link_length * MM_PER_M:g} mm from joint to joint"),
        ("tubes", f"{tube}, plates {robot.plate_offset * MM_PER_M:g} mm from the joints"),
        ("joints", f"bend up to {degrees(robot.bend_limit):.4g} deg{contact}"),
        ("order of rotation", ", ".join(each)),
        (
            "cables",
            f"{CABLES} to a module, each with its own of {robot.holes} holes in every plate",
        ),
        ("cable lengths", "counted from the base plate"),
    ]


def _insertion(stage: Insertion | None) -> str:
    if stage is None:
        return "none"
    low, high = stage.travel
    return f"{low * MM_PER_M:g} to {high * MM_PER_M:g} mm"


def _speeds(robot: PccRobot | JointedRobot) -> str:
    parts = {"cable": robot.speed.cable, "backbone": robot.speed.backbone}
    parts["insertion"] = robot.speed.insertion
    return ", ".join(f"{name} {x * MM_PER_M:g} mm/s" for name, x in parts.items() if x > 0.0)


def _lengths(robot: Robot) -> str:
    limits = robot.length_limits[np.all(np.isfinite(robot.length_limits), axis=1)]
    if not len(limits):
        return "bounded by the bends alone"
    low, high = limits[:, 0].min(), limits[:, 1].max()
    rest = "" if len(limits) == len(robot.length_limits) else "; cables by the bends alone"
    return f"{low * MM_PER_M:g} to {high * MM_PER_M:g} mm over all actuators{rest}"
