"""Builds what a scenario's tables name, and blames the scenario for what is wrong with it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NoReturn, TypeVar

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.control.geometric_ik import GeometricIK
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.saturation import unbent
from sinuous.errors import InputError
from sinuous.files import did_you_mean, read_path_csv
from sinuous.geometry.mesh import read_mesh
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.plant import Plant
from sinuous.plants.recorded import RecordedPlant, read_record_csv
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.robot import Robot
from sinuous.robots.robot_file import load_robot, preset_names
from sinuous.scenario.path import Leg, timed_path, waypoints
from sinuous.scenario.plant_tables import PlantTable, RecordedTable
from sinuous.scenario.plants import plant_of
from sinuous.scenario.tables import PathTable, RobotChoice, ZoneTable
from sinuous.scenario.teleop import Teleoperation
from sinuous.scenario.teleop_tables import TeleopTable
from sinuous.teleop.trace import Trace

T = TypeVar("T")

MM_PER_M = 1e3  # messages speak of millimetres
LENGTH_TOLERANCE = 1e-9  # [m] by which a start may exceed a limit: rounding of its decimals


@dataclass(frozen=True, kw_only=True)
class Source:
    """Where a scenario comes from; builds what its tables name."""

    file: str
    folder: Path

    def at(self, name: str) -> Path:
        """The path of a file that the scenario names."""
        return self.folder / name

    def robot_name(self, name: str) -> str | Path:
        """A preset stays a name; what is a path becomes relative to the scenario."""
        is_path = name.endswith(".toml") or len(Path(name).parts) != 1
        return self.at(name) if is_path else name

    def robot(self, choice: RobotChoice) -> Robot:
        """The robot with its base where the scenario puts it."""
        name = self.robot_name(choice.file)
        if isinstance(name, Path):
            self.found("robot.file", name)
        elif name not in preset_names():
            raise InputError(
                file=self.file,
                field="robot.file",
                expected="a preset or the path of a robot file ending in .toml",
                found=f'"{name}"',
                remedy=did_you_mean(name, preset_names(), what="presets"),
            )
        try:
            robot = load_robot(name, limits=choice.limits)
        except InputError as error:
            if error.field == f"limits.{choice.limits}":  # a choice that the robot file lacks
                self.blame("robot.limits", error)
            raise
        T_w_b = np.eye(4)
        T_w_b[:3, :3] = Rotation.from_euler("xyz", choice.base_rotation).as_matrix()
        T_w_b[:3, 3] = choice.base_position
        return robot.at(T_w_b)

    def start(self, robot: Robot, lengths: tuple[float, ...] | None) -> Array | None:
        """The configuration of the actuator lengths to start from."""
        if lengths is None:
            return None
        field, count = "robot.start_lengths", len(robot.actuator_names)
        if len(lengths) != count:
            raise InputError(
                file=self.file,
                field=field,
                expected=f"{count} lengths, one for each actuator",
                found=str(len(lengths)),
                remedy=f"The actuators are {', '.join(robot.actuator_names)}.",
            )
        c = robot.configuration(np.array(lengths))
        # The sum rule (19) may change them a little: what counts is where the robot ends up.
        excess = np.max(
            np.abs(robot.lengths(c) - np.clip(robot.lengths(c), *robot.length_limits.T))
        )
        if excess > LENGTH_TOLERANCE:
            raise InputError(
                file=self.file,
                field=field,
                expected="lengths within the robot's limits",
                found=f"a start {excess * MM_PER_M:.3g} mm beyond them",
                remedy="See the limits with: sinuous check ROBOT.",
            )
        return c

    def posed(self, robot: Robot, place: Array) -> Array:
        """The configuration by geometric inverse kinematics with the tip at a place (3,) [m]."""
        try:
            if not isinstance(robot, JointedRobot):
                raise ValueError("robot must be one of rigid modules")
            c = GeometricIK(robot).solve_one(place).c
        except ValueError as error:
            raise InputError(
                file=self.file,
                field="robot.file",
                expected="a robot that geometric inverse kinematics can solve",
                found=f"{robot.name}: {error}",
                remedy='Name another robot, or set control.law = "mpc".',
            ) from error
        return unbent(robot, c, robot.home)

    def zone(self, table: ZoneTable | None) -> SafeZone:
        """The room of the mesh, less the keep-outs."""
        if table is None:
            return SafeZone.unbounded()
        mesh, name = self.mesh("zone.mesh", table.mesh, table.unit)
        zone = self.blamed(
            "zone.mesh",
            lambda: SafeZone.from_mesh(
                mesh, name=name, cap=table.cap, entrance=table.entrance, approach=table.approach
            ),
        )
        for number, path in enumerate(table.keep_out):
            zone = self.minus(zone, f"zone.keep_out[{number}]", path, table.unit)
        return zone

    def minus(self, zone: SafeZone, field: str, path: str, unit: str) -> SafeZone:
        """The zone less the inside of a mesh."""
        mesh, name = self.mesh(field, path, unit)
        return self.blamed(field, lambda: zone.minus(mesh, name=name))

    def mesh(self, field: str, name: str, unit: str) -> tuple[trimesh.Trimesh, str]:
        """A mesh in metres and what to call it."""
        path = self.at(name)
        self.found(field, path)
        vertices, faces = self.blamed(field, lambda: read_mesh(path, unit=unit))
        return trimesh.Trimesh(vertices, faces, process=False), path.name

    def path(self, table: PathTable) -> tuple[Leg, ...]:
        """The legs of the path."""
        if table.csv is None:
            assert table.waypoints is not None
            return waypoints(table.waypoints, max_steps=table.max_steps)
        path = self.at(table.csv)
        self.found("path.csv", path)
        times, points = read_path_csv(path)
        return timed_path(times, points, max_steps=table.max_steps)

    def recorded(
        self, robot: Robot, table: RecordedTable | None
    ) -> Callable[[], RecordedPlant] | None:
        """What makes the plant that plays a record back, None for none."""
        if table is None:
            return None
        path = self.at(table.csv)
        self.found("plant.recorded.csv", path)
        record = read_record_csv(path, robot)
        return partial(RecordedPlant, robot, record, coil=table.coil)

    def plant(
        self, table: PlantTable, mpc: ShapeConstrainedMPC, start: Array
    ) -> Callable[[], Plant] | None:
        """What makes a plant that is more than kinematics, None for none."""
        try:
            return plant_of(table, mpc.robot, mpc.zone, start)
        except ValueError as error:
            raise InputError(
                file=self.file,
                field="plant.calibrated",
                expected=str(error),
                found=f"{mpc.robot.name}, which has none",
                remedy="Name the file that sinuous calibrate wrote in robot.file.",
            ) from error

    def teleop(
        self, table: TeleopTable | None, mpc: ShapeConstrainedMPC, start: Array, seed: int
    ) -> Teleoperation | None:
        """The operator far away, None for none."""
        if table is None:
            return None
        name, trace = None if table.link is None else table.link.trace, None
        if name is not None:
            path = self.at(name)
            self.found("teleop.link.trace", path)
            trace = Trace.load(path)
        tip = mpc.robot.tip(start)
        return Teleoperation(table=table, mpc=mpc, tip=tip, trace=trace, seed=seed)

    def found(self, field: str, path: Path) -> None:
        """Refuse a file that is not there, in the words of the scenario."""
        if not path.is_file():
            raise InputError(
                file=self.file,
                field=field,
                expected="a file",
                found=f"{'a folder' if path.is_dir() else 'nothing'} at {path}",
                remedy="Check the path; it is relative to the scenario's folder.",
            )

    def blamed(self, field: str, make: Callable[[], T]) -> T:
        """Make something; what is wrong with it is wrong with a field of this scenario."""
        try:
            return make()
        except InputError as error:
            own = error.field in ("unit", "entrance", "approach")
            self.blame(f"zone.{error.field}" if own else field, error)

    def blame(self, field: str, error: InputError) -> NoReturn:
        """Say of a field of this scenario what was found in a file that it names."""
        raise InputError(
            file=self.file,
            field=field,
            expected=error.expected,
            found=f"{error.found} ({error.file})",
            remedy=error.remedy,
        ) from error
