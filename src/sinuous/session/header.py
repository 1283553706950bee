"""What is known about a run before its first step."""

import platform
from importlib.metadata import PackageNotFoundError, version

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import SafeZone
from sinuous.recording import Header
from sinuous.scenario import Scenario

PACKAGES = ("sinuous", "numpy", "scipy", "numba", "daqp", "trimesh")
"""Those whose version may change a run."""


def make_header(scenario: Scenario) -> Header:
    """The header of a run of a scenario."""
    mpc, robot = scenario.mpc, scenario.robot
    return Header(
        name=scenario.name,
        robot=scenario.robot_text or f"# {robot.name} was built in Python\n",
        scenario=scenario.text or f"# {scenario.name} was built in Python\n",
        actuator_names=robot.actuator_names,
        rate_limits=robot.rate_limits,
        margin=mpc.margin,
        dt=mpc.dt,
        seed=scenario.seed,
        versions=versions(),
        zone_triangles=_drawn(scenario.zone),
        disk_indices=robot.disk_indices,
    )


def _drawn(zone: SafeZone) -> Array:
    """The walls (T, 3, 3) [m] without what stands for an entrance: its guide and its open end."""
    return zone.triangles[~(zone.is_guide | zone.is_open)]


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that compute."""
    return {"python": platform.python_version()} | {name: _version(name) for name in PACKAGES}


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:  # run from a checkout that is not installed
        return "unknown"
