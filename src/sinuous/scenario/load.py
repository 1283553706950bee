"""From a scenario file to a `Scenario`."""

import copy
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NoReturn, TypeVar, cast

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.control.mpc import Costs, ShapeConstrainedMPC
from sinuous.errors import InputError
from sinuous.files import build, did_you_mean, override, read_path_csv, read_text, read_toml
from sinuous.geometry.mesh import read_mesh
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.recorded import RecordedPlant, read_record_csv
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot, preset_names, robot_path
from sinuous.scenario.law import law_of
from sinuous.scenario.path import Leg, timed_path, waypoints
from sinuous.scenario.plant_tables import RecordedTable
from sinuous.scenario.scenario import Scenario
from sinuous.scenario.seen import disturbance_of, mismatch_of, sensor_of
from sinuous.scenario.tables import CostChoice, PathTable, RobotChoice, ScenarioTable, ZoneTable
from sinuous.scenario.teleop import Teleoperation
from sinuous.scenario.teleop_tables import TeleopTable
from sinuous.scenario.text import toml_text

T = TypeVar("T")

MM_PER_M = 1e3  # messages speak of millimetres
LENGTH_TOLERANCE = 1e-9  # [m] by which a start may exceed a limit: rounding of its decimals

_COSTS: Mapping[CostChoice, Callable[[], Costs]] = {
    CostChoice.UNBIASED: Costs,
    CostChoice.PRINTED: Costs.printed,
}


def load_scenario(path: str | Path, *, set: Iterable[str] = ()) -> Scenario:
    """Read a scenario file and build everything it names.

    Arguments:
        path: a TOML file; the paths in it are relative to its folder
        set: overrides like "mpc.horizon=5"

    Raises:
        InputError: if anything in it, or in a file it names, cannot be used
    """
    data = override(read_toml(path), set)
    table = build(ScenarioTable, data, file=str(path))
    source = _Source(file=str(path), folder=Path(path).parent)
    robot = source.robot(table.robot)
    mpc = ShapeConstrainedMPC(
        robot,
        source.zone(table.zone),
        margin=table.mpc.margin,
        dt=1.0 / table.mpc.rate,
        horizon=table.mpc.horizon,
        costs=_COSTS[table.mpc.cost](),
        tip_speed=table.mpc.tip_speed,
        budget=table.mpc.budget,
    )
    recorded = source.recorded(robot, table.plant.recorded)
    start = source.start(robot, table.robot.start_lengths)
    if recorded is not None and start is None:
        start = robot.configuration(recorded().truth.lengths)
    seen = table.sensor is not None or recorded is not None
    return Scenario(
        name=table.name,
        mpc=mpc,
        path=source.path(table.path),
        law=law_of(table.control, seen=seen),
        start=start,
        seed=table.seed,
        recover=table.recover,
        disturbance=disturbance_of(table.plant.disturbance),
        mismatch=mismatch_of(table.plant.mismatch),
        plant=recorded,
        sensor=sensor_of(table.sensor, robot),
        teleop=source.teleop(table.teleop, mpc, robot.home if start is None else start),
        file=str(path),
        text=toml_text(_absolute(data, source)),
        robot_text=read_text(robot_path(source.robot_name(table.robot.file))),
    )


@dataclass(frozen=True, kw_only=True)
class _Source:
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

    def robot(self, choice: RobotChoice) -> PccRobot:
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

    def start(self, robot: PccRobot, lengths: tuple[float, ...] | None) -> Array | None:
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
        self, robot: PccRobot, table: RecordedTable | None
    ) -> Callable[[], RecordedPlant] | None:
        """What makes the plant that plays a record back, None for none."""
        if table is None:
            return None
        path = self.at(table.csv)
        self.found("plant.recorded.csv", path)
        record = read_record_csv(path, robot)
        return partial(RecordedPlant, robot, record, coil=table.coil)

    def teleop(
        self, table: TeleopTable | None, mpc: ShapeConstrainedMPC, start: Array
    ) -> Teleoperation | None:
        """The operator far away, None for none."""
        return table and Teleoperation(table=table, mpc=mpc, tip=mpc.robot.tip(start))

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


def _absolute(data: Mapping[str, object], source: _Source) -> dict[str, object]:
    """The file's table with absolute paths, so that its copy in a recording runs anywhere."""
    result = copy.deepcopy(dict(data))
    tables = {name: cast(dict[str, object], result.get(name, {})) for name in _PATH_KEYS}
    for name, keys in _PATH_KEYS.items():
        for key in keys & tables[name].keys():
            tables[name][key] = _resolved(tables[name][key], source)
    plant = cast(dict[str, dict[str, object]], result.get("plant", {}))
    if "recorded" in plant:
        plant["recorded"]["csv"] = _resolved(plant["recorded"]["csv"], source)
    robot = tables["robot"]
    name = source.robot_name(str(robot["file"]))
    robot["file"] = name if isinstance(name, str) else str(name.resolve())
    return result


_PATH_KEYS = {"robot": set[str](), "zone": {"mesh", "keep_out"}, "path": {"csv"}}


def _resolved(value: object, source: _Source) -> object:
    if isinstance(value, list):
        return [_resolved(item, source) for item in cast(list[object], value)]
    return str(source.at(str(value)).resolve())
