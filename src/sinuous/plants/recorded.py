"""A robot that was recorded: its tracker and encoders, played back."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from sinuous.arrays import Array
from sinuous.csv_table import read_columns
from sinuous.files import read_text
from sinuous.measurement import Measurement
from sinuous.plants.plant import Truth
from sinuous.quantities import Quantity
from sinuous.robots.centreline import Centreline
from sinuous.robots.robot import Robot

AXES = ("x", "y", "z")
# Times of a clock that counts from 1970 are no finer [s].
ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class Record:
    """What was recorded of a robot, row by row.

    Arguments:
        times: increasing (K,) [s]
        tips: where the tip, or a coil beyond it, was in the world (K, 3) [m]
        lengths: of the actuators by the encoders (K, P) [m]

    Raises:
        ValueError: if there is no row, the shapes differ, or something is not finite
    """

    times: Array
    tips: Array
    lengths: Array

    def __post_init__(self) -> None:
        count = len(self.times)
        if count == 0 or self.tips.shape != (count, 3) or len(self.lengths) != count:
            raise ValueError("a record needs a row or more of time, tip and lengths")
        if not all(np.all(np.isfinite(v)) for v in (self.times, self.tips, self.lengths)):
            raise ValueError("a record must be finite")
        if np.any(np.diff(self.times) <= 0.0):
            raise ValueError("the times of a record must increase")


def read_record_csv(path: str | Path, robot: Robot) -> Record:
    """Return what a CSV file says of a robot.

    The header names the columns t, x, y and z and every actuator, with their units and with
    underscores for spaces: `t_s,x_mm,y_mm,z_mm,segment_1_cable_1_mm,segment_1_backbone_mm`. A
    length is the whole length, as the robot file counts it, and not its change from home. Columns
    may be in any order; others are passed over.

    Raises:
        InputError: naming row and column, if something is missing, not a finite number, or the
            times do not increase
    """
    actuators = [name.replace(" ", "_") for name in robot.actuator_names]
    columns = {"t": Quantity.DURATION} | dict.fromkeys((*AXES, *actuators), Quantity.LENGTH)
    found = read_columns(
        read_text(path),
        file=str(path),
        columns=columns,
        example=f"t_s,x_mm,y_mm,z_mm,{','.join(f'{name}_mm' for name in actuators)}",
    )
    return Record(
        times=found["t"],
        tips=np.stack([found[axis] for axis in AXES], axis=1),
        lengths=np.stack([found[name] for name in actuators], axis=1),
    )


class RecordedPlant:
    """Plays a record back, whatever rates it is given, to try controllers offline.

    It starts at the first row. At any time it yields the last row at or before, with its age,
    and holds the last one beyond the end.

    Nobody saw the whole body. What it calls its truth is the model's shape at the recorded
    lengths, shifted so that its tip is the recorded one: by the square of the arc length's share,
    which leaves the base and its direction as they are.

    Arguments:
        robot: the model of the robot that was recorded
        record: what was recorded
        coil: where the recorded tip was measured, in the frame of the tip [m]

    Raises:
        ValueError: if the record has not as many actuators as the robot
    """

    def __init__(
        self, robot: Robot, record: Record, *, coil: tuple[float, float, float] = (0.0, 0.0, 0.0)
    ) -> None:
        if record.lengths.shape[1] != len(robot.actuator_names):
            raise ValueError(f"a record of this robot has {len(robot.actuator_names)} actuators")
        self.robot, self.record = robot, record
        self._coil, self._line = np.array(coil), Centreline(robot=robot)
        self._since_first, self._elapsed, self._row = record.times - record.times[0], 0.0, 0
        self.truth = self._look(0)

    @property
    def finished(self) -> bool:
        """Whether the last row has been reached."""
        return self._row == len(self.record.times) - 1

    def step(self, rates: Array, dt: float) -> Measurement:
        """Let dt [s] pass and measure; the rates (P,) are not heard."""
        self._elapsed += dt
        rows = np.searchsorted(self._since_first, self._elapsed + ROUNDING, side="right")
        if rows - 1 != self._row:
            self._row = int(rows) - 1
            self.truth = self._look(self._row)
        return Measurement(
            tip=self.record.tips[self._row],
            lengths=self.record.lengths[self._row],
            coil=self._coil,
            age=max(self._elapsed - float(self._since_first[self._row]), 0.0),
        )

    def _look(self, row: int) -> Truth:
        lengths = self.record.lengths[row]
        c = self.robot.configuration(lengths)
        points, T_w_t = self.robot.points(c), self.robot.tip_pose(c)
        shift = self.record.tips[row] - T_w_t[:3, :3] @ self._coil - points[-1]
        arc = np.cumsum(np.concatenate([[0.0], self._line.model(c).lengths]))
        T_w_t[:3, 3] += shift
        return Truth(
            points=points + ((arc / arc[-1]) ** 2)[:, None] * shift, T_w_t=T_w_t, lengths=lengths
        )
