"""Moments of a recording, with the robot and the walls that it was made with."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Self

import numpy as np
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.files import build
from sinuous.geometry.safe_zone import SafeZone
from sinuous.geometry.surface import Surface
from sinuous.recording import Recording
from sinuous.robots.robot import Robot
from sinuous.robots.robot_file import load_robot
from sinuous.scenario.tables import ScenarioTable
from sinuous.view.page.moment import Moment
from sinuous.view.page.thinned import indexed

FORCE, AXES = "virtual_n", ("x", "y", "z")


@dataclass(frozen=True, kw_only=True, eq=False)
class Recorded:
    """A recording that can be looked at.

    Arguments:
        recording: what was recorded
        robot: that was steered
        walls: around it, None in free space
        forces: on the operator's hand at every step (K, 3) [N]
    """

    recording: Recording
    robot: Robot
    walls: SafeZone | None
    forces: Array

    @classmethod
    def of(cls, recording: Recording, *, file: str) -> Self:
        """Make robot and walls again.

        Raises:
            InputError: if nothing was recorded, or the robot cannot be made from its text
        """
        if not len(recording):
            raise InputError(
                file=file,
                expected="a recording with steps",
                found="none",
                remedy="Run it again and for longer.",
            )
        header = recording.header
        triangles = header.zone_triangles
        robot, rotation = _robot(recording, file)
        return cls(
            recording=recording,
            robot=robot,
            walls=_walls(triangles) if len(triangles) else None,
            forces=_forces(recording, rotation),
        )

    def __len__(self) -> int:
        return len(self.recording)

    def moment(self, k: int) -> Moment:
        """What there was to see at step k."""
        recording, points = self.recording, self.recording.actual_points[k]
        nearest, foot, clearance = 0, np.full(3, np.nan), float("inf")
        if self.walls is not None:
            near = self.walls.nearest(points)
            room = np.abs(near.clearance) - recording.header.radii
            room[~self.robot.movable] = np.inf  # what cannot move has no part in the clearance
            nearest = int(np.argmin(room))
            foot, clearance = near.foot[nearest], float(recording.actual_clearance[k])
        return Moment(
            target=recording.target[k],
            nominal=recording.nominal_points[k],
            actual=points,
            tensions=recording.tensions[k],
            nearest=nearest,
            wall=foot,
            clearance=clearance,
            tip_force=self.forces[k],
            pushed=int(recording.pushed[k]),
            body_force=recording.body_force[k],
        )


def _robot(recording: Recording, file: str) -> tuple[Robot, Array]:
    """The robot, and how the operator's axes are turned (3, 3)."""
    header = recording.header
    try:
        table = build(ScenarioTable, tomllib.loads(header.scenario), file=file)
        with TemporaryDirectory() as folder:
            text = Path(folder) / "robot.toml"
            text.write_text(header.robot, encoding="utf-8")
            robot = load_robot(text, limits=table.robot.limits)
    except (InputError, tomllib.TOMLDecodeError) as error:
        raise InputError(
            file=file,
            expected="a recording with the texts of its robot and scenario",
            found=f"texts that cannot be used ({error})",
            remedy="Record a run of a scenario file: what was built in Python cannot be replayed.",
        ) from error
    T_w_b = np.eye(4)
    T_w_b[:3, :3] = Rotation.from_euler("xyz", table.robot.base_rotation).as_matrix()
    T_w_b[:3, 3] = table.robot.base_position
    robot = robot.at(T_w_b)
    if len(robot.radii) != len(header.radii):
        raise InputError(
            file=file,
            expected=f"a robot with the {len(header.radii)} body points of the recording",
            found=f"{len(robot.radii)} in this version",
            remedy="Record it again with this version.",
        )
    turns = (0.0, 0.0, 0.0) if table.teleop is None else table.teleop.mapping.rotation
    return robot, Rotation.from_euler("xyz", turns).as_matrix()


def _walls(triangles: Array) -> SafeZone:
    """Something that finds the nearest of the triangles, closed or not."""
    vertices, faces = indexed(triangles)
    none = np.zeros(len(faces), dtype=np.int64)
    surface = Surface(
        name="walls",
        vertices=vertices,
        faces=faces,
        is_open=none.astype(bool),
        part=none,
        source=none,
    )
    return SafeZone(surfaces=(surface,))


def _forces(recording: Recording, rotation: Array) -> Array:
    """What the hand feels at each step (K, 3) [N]: against the force on the robot, in the world."""
    names = recording.header.signals
    axes = [a for a in AXES if f"{FORCE}_{a}" in names]
    forces = np.zeros((len(recording), 3))
    if not axes or not len(recording.signals):
        return forces
    ticks = np.round((recording.time + recording.header.dt) / recording.header.tick).astype(int)
    rows = np.clip(ticks - 1, 0, len(recording.signals) - 1)
    columns = rotation[:, [AXES.index(a) for a in axes]]
    return -recording.signal(FORCE)[rows] @ columns.T
