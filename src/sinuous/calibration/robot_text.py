"""The robot file that a calibration writes: the nominal one with what was found in its place."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.calibration.found import WIDTH, Estimate
from sinuous.calibration.problem import Problem

MM, DEG = 1e3, 180.0 / np.pi
# Digits of what is written: finer than any interval.
DIGITS = 7


def robot_text(
    nominal: Mapping[str, Any], problem: Problem, found: Mapping[str, Estimate], *,
    x: Array, motors: Sequence[str], about: str,
) -> str:  # fmt: skip
    """Return the text of a robot file.

    Arguments:
        nominal: the top table of the nominal robot's file
        problem: what was fitted
        found: with intervals
        x: parameters
        motors: names of the motors, in the order of the recording
        about: what it was fitted to
    """
    table = {
        key: value for key, value in nominal.items() if key not in ("segment", "fitted", "tool")
    }
    table["name"] = f"{nominal['name']}_fitted"
    table["cable_convention"] = "motor"
    segments = [_segment(each, problem, found, j) for j, each in enumerate(nominal["segment"])]
    radius = (
        problem.robot.tool.radius if problem.robot.tool else problem.robot.segments[-1].body_radius
    )
    table["segment"] = segments
    table["tool"] = {
        "offset_mm": _numbers(MM * found["marker"].value),
        "radius_mm": _number(MM * radius),
    }
    table["fitted"] = _fitted(problem, found, x, motors, about)
    notes = _notes(found)
    head = "# Written by sinuous calibrate. Intervals are 95 %, from the spread of the errors."
    return f"{head}\n\n{_dump(table, notes)}"


def _segment(
    nominal: Mapping[str, Any], problem: Problem, found: Mapping[str, Estimate], j: int
) -> dict[str, Any]:
    changed = ("cable_angles", "effective_pitch")
    kept = {k: v for k, v in nominal.items() if not k.startswith(changed)}
    angles = np.rad2deg(problem.robot.segments[j].cable_angles + found["effective_turn"].value[j])
    return kept | {
        "cable_angles_deg": _numbers(angles),
        "effective_pitch_mm": _number(MM * found["effective_pitch"].value[j]),
    }


def _fitted(
    problem: Problem, found: Mapping[str, Estimate], x: Array, motors: Sequence[str], about: str
) -> dict[str, Any]:
    model, T = problem.model(x), problem.base_pose(x)
    return {
        "about": about,
        "motors": [motors[k] for k in problem.identified.motors],
        "directions": problem.identified.directions.astype(int).tolist(),
        "slack_mm": _numbers(MM * model.slack),
        "hole_radius_mm": _numbers(MM * found["hole_radius"].value),
        "hole_angle_deg": _numbers(np.rad2deg(found["hole_angle"].value)),
        "twist_deg": _numbers(np.rad2deg(model.twist)),
        "stiffness_ratio": _numbers(model.stiffness),
        "friction_1_m": _numbers(model.friction),
        "rest_bend_deg": [_numbers(np.rad2deg(rest)) for rest in model.rest],
        "play_mm": _number(MM * model.play),
        "base_position_mm": _numbers(MM * T[:3, 3]),
        "base_axes": [[float(value) for value in line] for line in T[:3, :3]],
    }


def _notes(found: Mapping[str, Estimate]) -> dict[str, str]:
    """Comments behind keys: what they mean, and how sure they are."""

    def within(name: str, scale: float, unit: str) -> str:
        std = WIDTH * scale * found[name].std
        return f"+- {', '.join(f'{value:.2g}' for value in std)} {unit}"

    return {
        "hole_angle_deg": f"on the first segment: {within('hole_angle', DEG, 'deg')}",
        "twist_deg": f"of the holes of each segment: {within('twist', DEG, 'deg')}",
        "effective_pitch_mm": f"what kinematics reckon with: {within('effective_pitch', MM, 'mm')}",
        "offset_mm": f"of the marker: {within('marker', MM, 'mm')}",
        "slack_mm": "pull from which a cable is taut on the straight robot; below zero it is "
        f"pretension: {within('slack', MM, 'mm')}",
        "hole_radius_mm": f"sizes of spools included: {within('hole_radius', MM, 'mm')}",
        "stiffness_ratio": f"cable stiffness over EI [1/m^3]: {within('stiffness_ratio', 1.0, '')}",
        "friction_1_m": f"moment over EI that holds a segment: {within('friction', 1.0, '1/m')}",
        "rest_bend_deg": f"without cables: {within('rest_bend', DEG, 'deg')}",
        "play_mm": f"dead band between motor and cable: {within('play', MM, 'mm')}",
        "base_position_mm": f"in the tracker's frame: {within('base_position', MM, 'mm')}",
        "base_axes": f"columns are its x, y, z there: {within('base_rotation', DEG, 'deg')}",
        "directions": "1: larger readings pull",
    }


def _number(value: float) -> float:
    return float(f"{value:.{DIGITS}g}")


def _numbers(values: Array) -> list[float]:
    return [_number(float(value)) for value in values]


def _dump(table: Mapping[str, Any], notes: Mapping[str, str], at: str = "") -> str:
    """Plain values first, then tables, then lists of tables."""
    plain, rest = list[str](), list[str]()
    for key, value in table.items():
        name = f"{at}{_key(key)}"
        if isinstance(value, Mapping):
            rest.append(f"[{name}]\n{_dump(value, notes, f'{name}.')}")
        elif isinstance(value, list) and value and isinstance(value[0], Mapping):
            rest += [f"[[{name}]]\n{_dump(each, notes, f'{name}.')}" for each in value]
        else:
            note = f"  # {notes[key]}" if key in notes else ""
            plain.append(f"{_key(key)} = {_value(value)}{note}")
    return "\n".join([*plain, "", *rest] if rest else [*plain, ""])


def _key(key: str) -> str:
    return key if key.replace("_", "").replace("-", "").isalnum() else json.dumps(key)


def _value(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_value(each) for each in value)}]"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    return repr(value)
