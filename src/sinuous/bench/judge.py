"""What a drive is worth, judged on the exact mesh whatever the controller believes."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.loop import Drive
from sinuous.bench.scene import Scene
from sinuous.session.surface import SurfaceClearance
from sinuous.view.units import MM_PER_M, MS_PER_S

# A margin broken by less is rounding of lengths around 0.1 m.
ROUNDING = 1e-12  # [m]

# Violations larger than this are also counted apart [m]: a spline on a 2 mm grid is off by as
# much, so smaller ones are no fault of the solver behind it.
SPLINE_ERROR = 2e-4


@dataclass(frozen=True, kw_only=True, eq=False)
class Margins:
    """Room beyond what is required, per step [m] (K,).

    Arguments:
        disks: of the disk centres at the end of the step
        body: of the body's surface, every 0.25 mm, at the end of the step and on the way
    """

    disks: Array
    body: Array


def margins(scene: Scene, c: Array) -> Margins:
    """Judge configurations c (K + 1, n), the start first."""
    robot, zone = scene.robot, scene.zone
    disks = robot.points(c[1:])[:, robot.disk_indices]
    room = zone.clearance(disks) - robot.radii[robot.disk_indices] - scene.margin
    surface = SurfaceClearance.of(robot, zone)
    least = [surface.least(before, after) for before, after in pairwise(c)]
    return Margins(disks=room.min(axis=1), body=np.array(least) - scene.margin)


def judge(scene: Scene, drive: Drive, *, whole_body: bool) -> dict[str, object]:
    """The numbers of a drive.

    Arguments:
        whole_body: whether the controller promises the margin for all of the body, between
            steps too, or for the disk centres at their ends
    """
    found = margins(scene, drive.c)
    promised = found.body if whole_body else found.disks
    error = np.linalg.norm(scene.robot.tip(drive.c[1:]) - scene.targets, axis=1) * MM_PER_M
    rates = np.abs(np.diff(scene.robot.lengths(drive.c), axis=0)) / scene.dt
    iterations = np.array([outcome.iterations for outcome in drive.outcomes])
    return {
        **_times("", drive.cpu),
        **_times("wall_", drive.wall),
        "min_margin_mm": float(promised.min()) * MM_PER_M,
        "violations": int(np.sum(promised < -ROUNDING)),
        "violations_beyond_0.2_mm": int(np.sum(promised < -SPLINE_ERROR)),
        "failures": sum(bool(outcome.failure) for outcome in drive.outcomes),
        "tip_error_median_mm": float(np.median(error)),
        "tip_error_mean_mm": float(np.mean(error)),
        "disk_margin_mm": float(found.disks.min()) * MM_PER_M,
        "body_margin_mm": float(found.body.min()) * MM_PER_M,
        "body_violations": int(np.sum(found.body < -ROUNDING)),
        "largest_rate_by_its_limit": float((rates / scene.robot.rate_limits[:, 1]).max()),
        "iterations_median": float(np.median(iterations)),
        "iterations_p99": float(np.percentile(iterations, 99)),
        "iterations_max": int(iterations.max()),
        "functions_median_ms": float(np.median([o.functions for o in drive.outcomes])) * MS_PER_S,
        "solver_median_ms": float(np.median([o.solver for o in drive.outcomes])) * MS_PER_S,
        "steps": len(drive.cpu),
    }


def _times(prefix: str, seconds: Array) -> dict[str, object]:
    values = seconds * MS_PER_S
    return {
        f"{prefix}median_ms": float(np.median(values)),
        f"{prefix}p99_ms": float(np.percentile(values, 99)),
        f"{prefix}max_ms": float(values.max()),
    }
