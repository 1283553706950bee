"""From rows of the board to samples of a recording."""

import numpy as np

from sinuous.arrays import Array
from sinuous.live.board import Row
from sinuous.live.robot import STATUSES
from sinuous.recording import Sample, status_name
from sinuous.robots.robot import Robot


def sample_of(
    robot: Robot,
    row: Row,
    *,
    signals: Array,
    stiffness: float,
    nominal_clearance: float,
    actual_clearance: float,
) -> Sample:
    """What happened in a sample.

    Arguments:
        robot: that did it
        row: of the robot's side
        signals: of the ticks that belong to it (k, C)
        stiffness: of walls, as the operator's side has it [N/m]
        nominal_clearance: least clearance of the body's surface in the model [m]
        actual_clearance: that of the plant's body [m]
    """
    nominal = row["nominal"]
    return Sample(
        time=float(row["time"]),
        target=row["target"],
        configuration=row["c"],
        lengths=robot.lengths(row["c"]),
        rates=row["rates"],
        nominal_points=nominal,
        nominal_tip=nominal[-1],
        nominal_clearance=nominal_clearance,
        measured_points=row["measured"][: row["seen"]],
        measured_tip=row["measured_tip"],
        measured_lengths=row["measured_lengths"],
        local_rates=row["local"],
        clipped=float(row["clipped"]),
        offset=row["offset"],
        actual_points=row["actual"],
        actual_tip=row["actual_tip"],
        actual_clearance=actual_clearance,
        status=status_name(STATUSES[int(row["status"])]),
        solve_time=float(row["solve_time"]),
        iterations=int(row["iterations"]),
        planes=int(row["planes"]),
        step_fraction=float(row["step_fraction"]),
        active=active_names(row),
        tensions=row["tensions"][: row["known"]],
        contacts=row["contacts"],
        pushed=int(row["pushed"]),
        body_force=stiffness * row["push"],
        signals=signals,
    )


def active_names(row: Row) -> tuple[str, ...]:
    """What limits the robot, for people."""
    text = bytes(row["active"]).decode()
    return tuple(text.split("\n")) if text else ()


def pulls(row: Row) -> Array:
    """Tensions (C,) [N] of the cables, as far as the plant knows them."""
    return np.array(row["tensions"][: row["known"]])
