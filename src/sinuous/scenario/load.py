"""From a scenario file to a `Scenario`."""

import copy
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import cast

from sinuous.control.mpc import Costs, ShapeConstrainedMPC
from sinuous.errors import InputError
from sinuous.files import build, override, read_text, read_toml
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.robot import Robot
from sinuous.robots.robot_file import robot_path
from sinuous.scenario.control_tables import LawChoice
from sinuous.scenario.law import law_of
from sinuous.scenario.plant_tables import SensorChoice
from sinuous.scenario.scenario import Scenario
from sinuous.scenario.seen import disturbance_of, mismatch_of, sensor_of
from sinuous.scenario.source import Source
from sinuous.scenario.tables import CostChoice, ScenarioTable
from sinuous.scenario.text import toml_text

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
    source = Source(file=str(path), folder=Path(path).parent)
    robot = source.robot(table.robot)
    _check_kind(table, robot, str(path))
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
    way = source.path(table.path)
    if table.control.law is LawChoice.GEOMETRIC_IK:
        posed = source.posed(robot, way[0].at(0.0))  # also shows that there is a solution
        start = posed if start is None else start
    first = robot.home if start is None else start
    plant = recorded or source.plant(table.plant, mpc, first)
    seen = table.sensor is not None or plant is not None
    return Scenario(
        name=table.name,
        mpc=mpc,
        path=way,
        law=law_of(table.control, seen=seen),
        start=start,
        seed=table.seed,
        recover=table.recover,
        disturbance=disturbance_of(table.plant.disturbance),
        mismatch=mismatch_of(table.plant.mismatch),
        encoder_step=table.plant.encoder_step,
        plant=plant,
        sensor=sensor_of(table.sensor, robot),
        teleop=source.teleop(table.teleop, mpc, first, table.seed),
        file=str(path),
        text=toml_text(_absolute(data, source)),
        robot_text=read_text(robot_path(source.robot_name(table.robot.file))),
    )


def _check_kind(table: ScenarioTable, robot: Robot, file: str) -> None:
    """Refuse parts that are for the other kind of robot."""
    jointed = isinstance(robot, JointedRobot)
    sensor = table.sensor is not None and table.sensor.kind is SensorChoice.FIBRE
    estimate = table.control.taut is not None and table.control.taut.estimate
    for wrong, field in (
        (jointed and table.plant.mismatch is not None, "plant.mismatch"),
        (jointed and sensor, "sensor.kind"),
        (jointed and estimate, "control.taut.estimate"),
    ):
        if wrong:
            raise InputError(
                file=file,
                field=field,
                expected="it with a robot of segments only",
                found=f"{robot.name}, a robot of modules",
                remedy="Take it out, or name another robot in robot.file.",
            )


def _absolute(data: Mapping[str, object], source: Source) -> dict[str, object]:
    """The file's table with absolute paths, so that its copy in a recording runs anywhere."""
    result = copy.deepcopy(dict(data))
    tables = {name: cast(dict[str, object], result.get(name, {})) for name in _PATH_KEYS}
    for name, keys in _PATH_KEYS.items():
        for key in keys & tables[name].keys():
            tables[name][key] = _resolved(tables[name][key], source)
    plant = cast(dict[str, dict[str, object]], result.get("plant", {}))
    teleop = cast(dict[str, dict[str, object]], result.get("teleop", {}))
    if "trace" in teleop.get("link", {}):
        teleop["link"]["trace"] = _resolved(teleop["link"]["trace"], source)
    if "recorded" in plant:
        plant["recorded"]["csv"] = _resolved(plant["recorded"]["csv"], source)
    robot = tables["robot"]
    name = source.robot_name(str(robot["file"]))
    robot["file"] = name if isinstance(name, str) else str(name.resolve())
    return result


_PATH_KEYS = {"robot": set[str](), "zone": {"mesh", "keep_out"}, "path": {"csv"}}


def _resolved(value: object, source: Source) -> object:
    if isinstance(value, list):
        return [_resolved(item, source) for item in cast(list[object], value)]
    return str(source.at(str(value)).resolve())
