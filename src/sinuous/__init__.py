"""Steer tendon-driven continuum robots inside a mesh without touching it.

Metres, radians and seconds everywhere.  Names are loaded when they are first used, so that
`import sinuous` costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sinuous.control.dls import DampedLeastSquares
    from sinuous.control.hierarchical import HierarchicalController
    from sinuous.control.local import LocalController
    from sinuous.control.mpc import Costs, MPCState, ShapeConstrainedMPC
    from sinuous.control.offset_free import OffsetFree, When
    from sinuous.control.projected import ProjectedTarget
    from sinuous.control.report import Command, Report, Status
    from sinuous.errors import InputError
    from sinuous.geometry import shapes
    from sinuous.geometry.mesh import check_mesh
    from sinuous.geometry.safe_zone import SafeZone
    from sinuous.measurement import Measurement
    from sinuous.plants.fibre import Fibre, ShapeSensing
    from sinuous.plants.kinematic import Disturbance, KinematicPlant
    from sinuous.plants.mismatched import Mismatch, MismatchedPlant
    from sinuous.plants.recorded import RecordedPlant, read_record_csv
    from sinuous.plants.sensors import Accuracy, ShapeTracker, Timing, TipTracker
    from sinuous.reach import Reach, reaches
    from sinuous.recording.reader import read as read_recording
    from sinuous.recording.run import Recording, Sample
    from sinuous.robots.jointed import JointedRobot
    from sinuous.robots.pcc import PccRobot
    from sinuous.robots.robot_file import load_robot
    from sinuous.scenario import Scenario, load_scenario
    from sinuous.scenario.path import Leg, follow, timed_path, waypoints
    from sinuous.session import Result, run, steps
    from sinuous.summary import summarise
    from sinuous.view import save_comparison, save_figures

_HOME = {
    "Accuracy": "sinuous.plants.sensors",
    "Command": "sinuous.control.report",
    "Costs": "sinuous.control.mpc",
    "DampedLeastSquares": "sinuous.control.dls",
    "Disturbance": "sinuous.plants.kinematic",
    "Fibre": "sinuous.plants.fibre",
    "HierarchicalController": "sinuous.control.hierarchical",
    "InputError": "sinuous.errors",
    "JointedRobot": "sinuous.robots.jointed",
    "KinematicPlant": "sinuous.plants.kinematic",
    "Leg": "sinuous.scenario.path",
    "LocalController": "sinuous.control.local",
    "MPCState": "sinuous.control.mpc",
    "Measurement": "sinuous.measurement",
    "Mismatch": "sinuous.plants.mismatched",
    "MismatchedPlant": "sinuous.plants.mismatched",
    "OffsetFree": "sinuous.control.offset_free",
    "PccRobot": "sinuous.robots.pcc",
    "ProjectedTarget": "sinuous.control.projected",
    "Reach": "sinuous.reach",
    "RecordedPlant": "sinuous.plants.recorded",
    "Recording": "sinuous.recording.run",
    "Report": "sinuous.control.report",
    "Result": "sinuous.session",
    "SafeZone": "sinuous.geometry.safe_zone",
    "Sample": "sinuous.recording.run",
    "Scenario": "sinuous.scenario",
    "ShapeConstrainedMPC": "sinuous.control.mpc",
    "ShapeSensing": "sinuous.plants.fibre",
    "ShapeTracker": "sinuous.plants.sensors",
    "Status": "sinuous.control.report",
    "Timing": "sinuous.plants.sensors",
    "TipTracker": "sinuous.plants.sensors",
    "When": "sinuous.control.offset_free",
    "check_mesh": "sinuous.geometry.mesh",
    "follow": "sinuous.scenario.path",
    "load_robot": "sinuous.robots.robot_file",
    "load_scenario": "sinuous.scenario",
    "reaches": "sinuous.reach",
    "read_record_csv": "sinuous.plants.recorded",
    "read_recording": "sinuous.recording.reader",
    "run": "sinuous.session",
    "save_comparison": "sinuous.view",
    "save_figures": "sinuous.view",
    "shapes": "sinuous.geometry.shapes",
    "steps": "sinuous.session",
    "summarise": "sinuous.summary",
    "timed_path": "sinuous.scenario.path",
    "waypoints": "sinuous.scenario.path",
}
"""The module of every public name; the imports above tell type checkers the same."""

_OTHER_NAME = {"read_recording": "read"}

__all__ = [
    "Accuracy",
    "Command",
    "Costs",
    "DampedLeastSquares",
    "Disturbance",
    "Fibre",
    "HierarchicalController",
    "InputError",
    "JointedRobot",
    "KinematicPlant",
    "Leg",
    "LocalController",
    "MPCState",
    "Measurement",
    "Mismatch",
    "MismatchedPlant",
    "OffsetFree",
    "PccRobot",
    "ProjectedTarget",
    "Reach",
    "RecordedPlant",
    "Recording",
    "Report",
    "Result",
    "SafeZone",
    "Sample",
    "Scenario",
    "ShapeConstrainedMPC",
    "ShapeSensing",
    "ShapeTracker",
    "Status",
    "Timing",
    "TipTracker",
    "When",
    "check_mesh",
    "follow",
    "load_robot",
    "load_scenario",
    "reaches",
    "read_record_csv",
    "read_recording",
    "run",
    "save_comparison",
    "save_figures",
    "shapes",
    "steps",
    "summarise",
    "timed_path",
    "waypoints",
]


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module = import_module(_HOME[name])
    value = module if name == "shapes" else getattr(module, _OTHER_NAME.get(name, name))
    globals()[name] = value  # so that the next access is an ordinary one
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
