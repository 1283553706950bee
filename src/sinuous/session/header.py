"""What is known about a run before its first step."""

import platform
from importlib.metadata import PackageNotFoundError, version

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.geometry.safe_zone import SafeZone
from sinuous.recording import Header, ZonePart
from sinuous.scenario import Scenario
from sinuous.session.by_hand import signal_names

PACKAGES = ("sinuous", "numpy", "scipy", "numba", "trimesh")
"""Those whose version may change a run."""


def make_header(scenario: Scenario) -> Header:
    """The header of a run of a scenario."""
    mpc, robot, teleop = scenario.mpc, scenario.robot, scenario.teleop
    triangles, parts = _drawn(scenario.zone)
    return Header(
        name=scenario.name,
        robot=scenario.robot_text or f"# {robot.name} was built in Python\n",
        scenario=scenario.text or f"# {scenario.name} was built in Python\n",
        actuator_names=robot.actuator_names,
        rate_limits=robot.rate_limits,
        margin=mpc.margin,
        dt=scenario.controller.dt,
        seed=scenario.seed,
        versions=versions(),
        zone_triangles=triangles,
        zone_parts=parts,
        radii=robot.radii,
        disk_indices=robot.disk_indices,
        tubes=robot.tubes,
        signals=() if teleop is None else signal_names(teleop.axes),
        tick=scenario.controller.dt if teleop is None else teleop.dt,
    )


def _drawn(zone: SafeZone) -> tuple[Array, IntArray]:
    """Every triangle (T, 3, 3) [m] that is a wall, and its `ZonePart` (T,); open ends are none."""
    parts = np.full(len(zone.triangles), int(ZonePart.WALL))
    parts[zone.is_guide] = ZonePart.GUIDE
    parts[zone.is_keep_out] = ZonePart.KEEP_OUT
    return zone.triangles[~zone.is_open], parts[~zone.is_open]


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that compute."""
    return {"python": platform.python_version()} | {name: _version(name) for name in PACKAGES}


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:  # run from a checkout that is not installed
        return "unknown"
