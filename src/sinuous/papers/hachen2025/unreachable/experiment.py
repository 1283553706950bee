"""III-E: targets outside the zone, and what projecting them onto it is worth.

First, targets beside the winding tube: what room is left where each controller comes to rest.
Then targets that sweep past outside zones that are not convex, as the operator of a teleoperated
robot may do: by how much the projected target jumps, and the tip with it.
"""

from itertools import pairwise
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.control.projected import ProjectedTarget
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.settling import end_of
from sinuous.papers.hachen2025.targets import outside
from sinuous.papers.hachen2025.undisturbed import DLS, DT, MPC, Place, drive, held, place, tips
from sinuous.papers.hachen2025.unreachable.figures import draw
from sinuous.papers.hachen2025.unreachable.sweeps import SPEED, SWEEPS
from sinuous.papers.workers import Workers
from sinuous.session.surface import SurfaceClearance

TUBE = "winding_tube"
SEED = 10
TARGETS, QUICK_TARGETS = 20, 1
NEAREST, FARTHEST = 0.01, 0.04  # of the targets from the wall [m]
DURATION, QUICK_DURATION = 8.0, 5.0  # of a run [s]
QUICK_SWEEPS = ("through a ridge",)

PRINTED, BEST = "DLS, printed gains", "DLS, best gains"
Law = tuple[str, bool]
"""A controller, and whether it sees the projection of the target instead."""

AT_REST: tuple[Law, ...] = (
    (MPC, False),
    *((name, False) for name in DLS),
    (PRINTED, True),
    (BEST, True),
)
SWEEPING: tuple[Law, ...] = ((MPC, False), (MPC, True), (PRINTED, True), (BEST, True))

WINDOW = 0.5  # in which a jump is looked for, beside a single step [s]
DIGITS = 6  # of the metres of shapes and paths


def run(workers: Workers, quick: bool) -> Data:
    """Every controller at every target, then every sweep."""
    here, rng = place(TUBE), np.random.default_rng(SEED)
    count, duration = (QUICK_TARGETS, QUICK_DURATION) if quick else (TARGETS, DURATION)
    targets = outside(here.zone, NEAREST, FARTHEST, count, rng)
    beside = [(law, target.tolist(), duration) for target in targets for law in AT_REST]
    passing = [(name, law) for name in (QUICK_SWEEPS if quick else SWEEPS) for law in SWEEPING]
    return {
        "place": TUBE,
        "margin_m": here.margin,
        "duration_s": duration,
        "start_points_m": here.robot.points(here.start).round(DIGITS).tolist(),
        "rest": workers.map("targets outside the zone", rest, beside),
        "speed_m_s": SPEED,
        "dt_s": DT,
        "sweeps": workers.map("targets that sweep past", sweep, passing),
    }


def rest(item: tuple[Law, list[float], float]) -> dict[str, Any]:
    """How one controller ends at one target outside the tube."""
    law, target, duration = item
    here = place(TUBE)
    way = drive(_controller(here, law), here.start, held(np.array(target), duration))
    path = tips(here.robot, way)
    end = end_of(path)
    judge = SurfaceClearance.of(here.robot, here.zone)
    return {
        "controller": law[0],
        "projected": law[1],
        "target_m": target,
        "outside_m": -float(here.zone.clearance(target)),
        "clearance_at_rest_m": judge.least(way[-1], way[-1]),
        "least_clearance_m": _least(judge, way),
        "tip_error_m": float(np.linalg.norm(path[-1] - target)),
        "extent_m": end.extent,
        "path_m": end.path,
        "points_m": here.robot.points(way[-1]).round(DIGITS).tolist(),
    }


def sweep(item: tuple[str, Law]) -> dict[str, Any]:
    """What one controller makes of one sweep."""
    name, law = item
    one = SWEEPS[name]()
    here, controller, begun = one.here, _controller(one.here, law), len(one.before)
    way = drive(controller, here.start, np.concatenate([one.before, one.line]))[begun:]
    line = np.concatenate([one.before[-1:], one.line])
    aims = line
    if isinstance(controller, ProjectedTarget):
        aims = np.array([controller.project(target) for target in line])
    path, window = tips(here.robot, way), round(WINDOW / DT)
    return {
        "sweep": name,
        "controller": law[0],
        "projected": law[1],
        "target_m": line.round(DIGITS).tolist(),
        "aim_m": aims.round(DIGITS).tolist(),
        "tip_m": path.round(DIGITS).tolist(),
        "aim_jump_m": _jump(aims, line, 1),
        "tip_jump_m": _jump(path, line, 1),
        "aim_jump_in_window_m": _jump(aims, line, window),
        "tip_jump_in_window_m": _jump(path, line, window),
        "window_s": WINDOW,
        "least_clearance_m": _least(SurfaceClearance.of(here.robot, here.zone), way),
        "margin_m": here.margin,
    }


def _controller(here: Place, law: Law) -> Any:
    name, projected = law
    controller = here.controller(name)
    return ProjectedTarget(controller) if projected else controller


def _least(judge: SurfaceClearance, way: Array) -> float:
    """Least surface clearance [m] on a way (K, n), between its steps too."""
    return min(judge.least(a, b) for a, b in pairwise(way))


def _jump(path: Array, line: Array, steps: int) -> float:
    """Most that a path (K, 3) moves in so many steps beyond what the target does then [m]."""
    moved = np.linalg.norm(path[steps:] - path[:-steps], axis=1)
    own = np.linalg.norm(line[steps:] - line[:-steps], axis=1)
    return float(np.max(moved - own))


UNREACHABLE = Experiment(
    name="unreachable",
    title="Targets outside the zone",
    section="III-E, Fig. 10",
    run=run,
    draw=draw,
)
