"""`sinuous bench ik`: the geometric solution beside common ones, on the same targets and paths."""

from collections.abc import Sequence

import numpy as np

from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.ik_drive import IKAnswers, ask, joint_motion, judge, smoothness
from sinuous.bench.ik_figure import draw
from sinuous.bench.ik_follow import FOLLOW_COLUMNS, follow
from sinuous.bench.ik_peers.heuristics import HEURISTICS
from sinuous.bench.ik_peers.least_squares import LEAST_SQUARES
from sinuous.bench.ik_peers.ours import OURS, called_from_python
from sinuous.bench.ik_peers.solver import TOLERANCE, IKSolver
from sinuous.bench.ik_tasks import STEP, IKTasks, draw_tasks
from sinuous.bench.machine import machine, versions
from sinuous.bench.result import Column, Result, Row, Table
from sinuous.control.geometric_ik import CHI, GeometricIK
from sinuous.robots.robot_file import load_jointed
from sinuous.view.units import MM_PER_M

COLD, WARM, NONE = "reference pose", "last solution", "-"

TIMES = (
    Column(key="solver", title="solver"),
    Column(key="start", title="start"),
    Column(key="median_us", title="median", form=".3f"),
    Column(key="p99_us", title="p99", form=".2f"),
    Column(key="max_us", title="max", form=".1f"),
    Column(key="solved", title="solved", form=".1%"),
    Column(key="tip_error_max_um", title="tip error", form=".1e"),
    Column(key="iterations_median", title="iterations", form=".0f"),
    Column(key="iterations_max", title="max", form=".0f"),
    Column(key="within_joint_limits", title="in limits", form=".1%"),
    Column(key="largest_bend_deg", title="bend", form=".1f"),
)
MOTION = (
    Column(key="motion_rms_rad_mm", title="motion", form=".4f"),
    Column(key="motion_max_rad_mm", title="largest", form=".4f"),
)
RATIO_COLUMNS = (
    Column(key="peer", title="peer"),
    Column(key="task", title="task"),
    Column(key="start", title="start"),
    Column(key="median", title="median", form=".1f"),
    Column(key="p99", title="p99", form=".1f"),
    Column(key="max", title="max", form=".1f"),
)
NOTES = (
    "Processor time of one target in us, one thread, all compiled the same way, each repeated in "
    "compiled code and the least of three; tolerance 1 um for the tip and for the last tube's "
    'direction times its length; "solved" and "tip error" [um] by the robot\'s own kinematics. '
    '"from Python": the same solution, called target by target.',
    'All but "5 rows" use (10): A_N is known, and the joints before it bring it there. "5 rows" '
    "are the tip's position and the last tube's direction as one task for all joints.",
    '"motion": root mean square of the change of all angles together, and the largest change of '
    'one angle, in rad per mm of the tip\'s way. "bend" in degrees; the limit is 39.1.',
    'Following at 1 kHz: speeds in mm/s; "worst rate" and "at switches" (median where k changes): '
    "rate of the worst cable by its limit if the tip were exactly on its path; "
    '"longest": time without a break above the limit [ms]; "lag": distance of the tip from its '
    "target [mm] with the cables no faster than they can.",
)


def run(quick: bool, observe: Observe) -> Result:
    """Ask every solver for the same targets and paths."""
    ik = GeometricIK(load_jointed("qin2020"))
    tasks = draw_tasks(ik, quick)
    solvers = (OURS, called_from_python(ik), *LEAST_SQUARES, *HEURISTICS)
    random, paths, series = list[Row](), list[Row](), list[Row]()
    for number, solver in enumerate(solvers):
        observe(solver.name, number, len(solvers) + 1)
        ask(solver, ik, tasks.targets[:1], tasks.start, warm=False)  # code is loaded
        random.append(_row(ik, solver, ask(solver, ik, tasks.targets, tasks.start, warm=False)))
        for warm in (False, True) if solver.starts else (False,):
            answers = [ask(solver, ik, path, tasks.start, warm=warm) for path in tasks.paths]
            joined = IKAnswers.joined(answers)
            paths.append({**_row(ik, solver, joined, warm=warm), **smoothness(joined)})
            series.append(_series(ik, paths[-1], max(answers, key=lambda each: len(each.c))))
    observe("following", len(solvers), len(solvers) + 1)
    return Result(
        what="ik",
        tables=(
            Table(name="targets", title="targets all over the disc", columns=TIMES, rows=random),
            Table(
                name="paths",
                title="straight paths, a target every mm",
                columns=(*TIMES[:6], *MOTION, *TIMES[-2:]),
                rows=paths,
            ),
            Table(
                name="ratios",
                title="time of a peer by that of sinuous",
                columns=RATIO_COLUMNS,
                rows=[*ratios(random, "targets"), *ratios(paths, "paths")],
            ),
            Table(
                name="following",
                title="following at 1 kHz",
                columns=FOLLOW_COLUMNS,
                rows=list(follow(quick)),
            ),
        ),
        about={
            "series": series,
            "solvers": {solver.name: solver.settings for solver in solvers},
            "settings": _settings(ik, tasks),
            "versions": versions(),
            "machine": machine(),
        },
        notes=NOTES,
    )


def _row(ik: GeometricIK, solver: IKSolver, answers: IKAnswers, *, warm: bool = False) -> Row:
    start = (WARM if warm else COLD) if solver.starts else NONE
    return {"solver": solver.name, "start": start, **judge(ik, answers)}


def _series(ik: GeometricIK, row: Row, answers: IKAnswers) -> Row:
    """Joint motion along a path, and the steps in which k switches, for the figure."""
    motion = joint_motion(answers) / MM_PER_M
    switches = np.flatnonzero(np.diff(ik.solve(answers.targets).first_joint))
    return {
        "solver": row["solver"],
        "start": row["start"],
        "step_mm": STEP * MM_PER_M,
        "largest_rad_mm": abs(motion).max(axis=1).tolist(),
        "switches": switches.tolist(),
    }


def _settings(ik: GeometricIK, tasks: IKTasks) -> Row:
    return {
        "robot": ik.robot.name,
        "chi_rad": CHI,
        "radius_m": ik.radius(CHI),
        "tolerance_m": TOLERANCE,
        "targets": len(tasks.targets),
        "paths": len(tasks.paths),
        "step_m": STEP,
    }


def ratios(rows: Sequence[Row], task: str) -> list[Row]:
    """Times of the peers by ours on the same task."""
    ours = next(row for row in rows if row["solver"] == OURS.name)
    return [
        {
            "peer": row["solver"],
            "task": task,
            "start": row["start"],
            **{key: _number(row, key) / _number(ours, key) for key in ("median", "p99", "max")},
        }
        for row in rows
        if row["start"] != NONE
    ]


def _number(row: Row, key: str) -> float:
    value = row[f"{key}_us"]
    assert isinstance(value, float)
    return value


IK = Benchmark(run=run, draw=draw)
