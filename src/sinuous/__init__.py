"""Steer tendon-driven continuum robots inside a mesh without touching it.

Metres, radians and seconds everywhere.  Names are loaded when they are first used, so that
`import sinuous` costs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sinuous.calibration.calibrate import calibrate
    from sinuous.control.cable_loop import CableLoop
    from sinuous.control.dls import DampedLeastSquares
    from sinuous.control.geometric_ik import GeometricIK, IKStatus
    from sinuous.control.geometric_rates import RateLimiter
    from sinuous.control.hierarchical import HierarchicalController
    from sinuous.control.local import LocalController
    from sinuous.control.mpc import Costs, MPCState, ShapeConstrainedMPC
    from sinuous.control.offset_free import OffsetFree, When
    from sinuous.control.pid import Pid
    from sinuous.control.projected import ProjectedTarget
    from sinuous.control.report import Command, Report, Status
    from sinuous.control.tension import TautCables
    from sinuous.control.tension_estimate import BackboneTensions
    from sinuous.control.transmission import Transmission
    from sinuous.errors import InputError
    from sinuous.geometry import shapes
    from sinuous.geometry.mesh import check_mesh
    from sinuous.geometry.safe_zone import SafeZone
    from sinuous.measurement import Measurement
    from sinuous.plants.calibrated import CalibratedPlant
    from sinuous.plants.compensated import CompensatedPlant
    from sinuous.plants.fibre import Fibre, ShapeSensing
    from sinuous.plants.kinematic import Disturbance, KinematicPlant
    from sinuous.plants.mismatched import Mismatch, MismatchedPlant
    from sinuous.plants.physics.plant import PhysicsPlant
    from sinuous.plants.physics.walls import Walls
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
    from sinuous.teleop.bilateral import Bilateral
    from sinuous.teleop.boundary import BoxForce, ZoneForce
    from sinuous.teleop.delays import NormalJitter, Steady, UniformJitter, Varying
    from sinuous.teleop.drift import DriftCorrection
    from sinuous.teleop.ends import FollowerEnd, LeaderEnd
    from sinuous.teleop.force import ErrorForce, ErrorForceAlong, Together
    from sinuous.teleop.impaired import ImpairedLink
    from sinuous.teleop.leader import LeaderDevice
    from sinuous.teleop.ledger import Ledger
    from sinuous.teleop.limits import Limits
    from sinuous.teleop.link import ConstantDelay
    from sinuous.teleop.losses import BurstLoss, Duplication, Outages, RandomLoss, RandomOutages
    from sinuous.teleop.mapping import Mapping
    from sinuous.teleop.move_and_wait import MoveAndWait
    from sinuous.teleop.operators import ImpedanceOperator, Prescribed
    from sinuous.teleop.passivity import PassivityControl
    from sinuous.teleop.position_force import PositionForce
    from sinuous.teleop.ramp import Ramp
    from sinuous.teleop.receivers import Hold, Interpolated, ZeroFill
    from sinuous.teleop.trace import Trace
    from sinuous.teleop.waves import ModifiedWaves, StandardWaves
    from sinuous.view import save_comparison, save_figures

_HOME = {
    "Accuracy": "sinuous.plants.sensors",
    "BackboneTensions": "sinuous.control.tension_estimate",
    "Bilateral": "sinuous.teleop.bilateral",
    "BoxForce": "sinuous.teleop.boundary",
    "BurstLoss": "sinuous.teleop.losses",
    "CableLoop": "sinuous.control.cable_loop",
    "CalibratedPlant": "sinuous.plants.calibrated",
    "Command": "sinuous.control.report",
    "CompensatedPlant": "sinuous.plants.compensated",
    "ConstantDelay": "sinuous.teleop.link",
    "Costs": "sinuous.control.mpc",
    "DampedLeastSquares": "sinuous.control.dls",
    "Disturbance": "sinuous.plants.kinematic",
    "DriftCorrection": "sinuous.teleop.drift",
    "Duplication": "sinuous.teleop.losses",
    "ErrorForce": "sinuous.teleop.force",
    "ErrorForceAlong": "sinuous.teleop.force",
    "Fibre": "sinuous.plants.fibre",
    "FollowerEnd": "sinuous.teleop.ends",
    "GeometricIK": "sinuous.control.geometric_ik",
    "HierarchicalController": "sinuous.control.hierarchical",
    "Hold": "sinuous.teleop.receivers",
    "IKStatus": "sinuous.control.geometric_ik",
    "ImpairedLink": "sinuous.teleop.impaired",
    "ImpedanceOperator": "sinuous.teleop.operators",
    "InputError": "sinuous.errors",
    "Interpolated": "sinuous.teleop.receivers",
    "JointedRobot": "sinuous.robots.jointed",
    "KinematicPlant": "sinuous.plants.kinematic",
    "LeaderDevice": "sinuous.teleop.leader",
    "LeaderEnd": "sinuous.teleop.ends",
    "Ledger": "sinuous.teleop.ledger",
    "Leg": "sinuous.scenario.path",
    "Limits": "sinuous.teleop.limits",
    "LocalController": "sinuous.control.local",
    "MPCState": "sinuous.control.mpc",
    "Mapping": "sinuous.teleop.mapping",
    "Measurement": "sinuous.measurement",
    "Mismatch": "sinuous.plants.mismatched",
    "MismatchedPlant": "sinuous.plants.mismatched",
    "ModifiedWaves": "sinuous.teleop.waves",
    "MoveAndWait": "sinuous.teleop.move_and_wait",
    "NormalJitter": "sinuous.teleop.delays",
    "OffsetFree": "sinuous.control.offset_free",
    "Outages": "sinuous.teleop.losses",
    "PassivityControl": "sinuous.teleop.passivity",
    "PccRobot": "sinuous.robots.pcc",
    "PhysicsPlant": "sinuous.plants.physics.plant",
    "Pid": "sinuous.control.pid",
    "PositionForce": "sinuous.teleop.position_force",
    "Prescribed": "sinuous.teleop.operators",
    "ProjectedTarget": "sinuous.control.projected",
    "Ramp": "sinuous.teleop.ramp",
    "RandomLoss": "sinuous.teleop.losses",
    "RandomOutages": "sinuous.teleop.losses",
    "RateLimiter": "sinuous.control.geometric_rates",
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
    "StandardWaves": "sinuous.teleop.waves",
    "Status": "sinuous.control.report",
    "Steady": "sinuous.teleop.delays",
    "TautCables": "sinuous.control.tension",
    "Timing": "sinuous.plants.sensors",
    "TipTracker": "sinuous.plants.sensors",
    "Together": "sinuous.teleop.force",
    "Trace": "sinuous.teleop.trace",
    "Transmission": "sinuous.control.transmission",
    "UniformJitter": "sinuous.teleop.delays",
    "Varying": "sinuous.teleop.delays",
    "Walls": "sinuous.plants.physics.walls",
    "When": "sinuous.control.offset_free",
    "ZeroFill": "sinuous.teleop.receivers",
    "ZoneForce": "sinuous.teleop.boundary",
    "calibrate": "sinuous.calibration.calibrate",
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
    "BackboneTensions",
    "Bilateral",
    "BoxForce",
    "BurstLoss",
    "CableLoop",
    "CalibratedPlant",
    "Command",
    "CompensatedPlant",
    "ConstantDelay",
    "Costs",
    "DampedLeastSquares",
    "Disturbance",
    "DriftCorrection",
    "Duplication",
    "ErrorForce",
    "ErrorForceAlong",
    "Fibre",
    "FollowerEnd",
    "GeometricIK",
    "HierarchicalController",
    "Hold",
    "IKStatus",
    "ImpairedLink",
    "ImpedanceOperator",
    "InputError",
    "Interpolated",
    "JointedRobot",
    "KinematicPlant",
    "LeaderDevice",
    "LeaderEnd",
    "Ledger",
    "Leg",
    "Limits",
    "LocalController",
    "MPCState",
    "Mapping",
    "Measurement",
    "Mismatch",
    "MismatchedPlant",
    "ModifiedWaves",
    "MoveAndWait",
    "NormalJitter",
    "OffsetFree",
    "Outages",
    "PassivityControl",
    "PccRobot",
    "PhysicsPlant",
    "Pid",
    "PositionForce",
    "Prescribed",
    "ProjectedTarget",
    "Ramp",
    "RandomLoss",
    "RandomOutages",
    "RateLimiter",
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
    "StandardWaves",
    "Status",
    "Steady",
    "TautCables",
    "Timing",
    "TipTracker",
    "Together",
    "Trace",
    "Transmission",
    "UniformJitter",
    "Varying",
    "Walls",
    "When",
    "ZeroFill",
    "ZoneForce",
    "calibrate",
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
