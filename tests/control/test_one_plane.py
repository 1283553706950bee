"""The finding that decided the design: one plane per point is unsafe (notes B8).

The baseline is the usual real-time iteration: value and gradient of the distance at every
guarded point make one plane each, one QP, and its first step is taken whole.
"""

from dataclasses import replace

import daqp
import numpy as np

from sinuous.arrays import Array
from sinuous.control.metric import actuator_metric
from sinuous.control.mpc import MPCState, ShapeConstrainedMPC

from .loops import DENSE, Judged, drive, judge
from .scenes import START, Scene, bent_tube

# The baseline comes this much closer than the margin at least [m]; notes B8 saw 3.6 to 13 mm.
UNSAFE = 1e-3

PENALTY = 100.0  # price of a violated plane per unit of the largest gradient, as ours
SOFTNESS = 1e-2  # DAQP adds s^2 / (2 SOFTNESS) to the price of a violation s


def planes(mpc: ShapeConstrainedMPC, c: Array) -> tuple[Array, Array]:
    """A plane for every guarded point, from the distance and its gradient: slack + J delta >= 0."""
    robot = mpc.robot
    near, movable = mpc.zone.nearest(robot.points(c)), robot.movable
    jacobian = np.einsum("ki,kin->kn", near.gradient, robot.points_jacobian(c))
    slack = near.clearance - robot.required_distance(mpc.margin)
    return slack[movable], jacobian[movable]


def baseline_step(mpc: ShapeConstrainedMPC, state: MPCState, target: Array) -> MPCState:
    """One real-time iteration with one plane per point."""
    step = float(np.max(mpc.robot.rate_limits)) * mpc.dt
    by_y = step * np.linalg.inv(actuator_metric(mpc.robot))
    problem, n = mpc.problem(state, target), len(state.c)
    hard = np.isinf(problem.price)
    A, lower = [problem.A[hard]], [problem.lower[hard]]
    for i, c in enumerate(state.plan):
        slack, jacobian = planes(mpc, c)
        scaled = jacobian @ by_y
        norms = np.linalg.norm(scaled, axis=1)
        rows = np.zeros((len(slack), len(problem.f)))
        rows[:, i * n : (i + 1) * n] = scaled / norms[:, None]
        A.append(rows)
        lower.append(-slack / norms)
    count = sum(len(one) for one in lower[1:])
    upper = np.concatenate([problem.upper[hard], np.full(count, np.inf)])
    y = solve(problem.H, problem.f, np.concatenate(A), np.concatenate(lower), upper, count)
    found = state.plan + y.reshape(-1, n) @ by_y.T
    return replace(mpc.init(found[0]), plan=np.vstack([found[1:], found[-1:]]))


def solve(H: Array, f: Array, A: Array, lower: Array, upper: Array, soft: int) -> Array:
    """By DAQP, with the last rows soft."""
    sense = np.zeros(len(lower), dtype=np.int32)
    sense[len(sense) - soft :] = 8  # DAQP's code for a soft row
    model = daqp.Model()
    flag, _ = model.setup(H, f, A, upper, lower, sense)
    assert flag >= 0
    model.settings = {"iter_limit": 5000}
    price = np.full(len(sense), PENALTY * (1.0 + float(np.max(np.abs(f)))))
    softness = np.full(len(sense), SOFTNESS)
    model.soft_weights(rho_l=softness, rho_u=softness, w_l=price, w_u=price)
    y, _, flag, _ = model.solve()
    assert flag in (1, 2)  # solved; solved with soft rows violated
    return np.array(y)


def jumping_targets(scene: Scene, count: int) -> Array:
    rng = np.random.default_rng(3)
    held = scene.axis[rng.integers(8, len(scene.axis), count // 20)]
    return np.repeat(held + rng.normal(0.0, 0.03, held.shape), 20, axis=0)


def test_one_plane_per_point_violates_where_lazy_planes_do_not() -> None:
    scene = bent_tube()
    mpc = scene.mpc(2)
    targets = jumping_targets(scene, 200)
    state, least = mpc.init(START), np.inf
    dense = scene.robot.sampled(DENSE)
    for target in targets:
        state = baseline_step(mpc, state, target)
        clearance = scene.zone.clearance(dense.points(state.c)) - dense.radii
        least = min(least, float(clearance.min()) - mpc.margin)
    assert least < -UNSAFE

    _, judged = drive(mpc, mpc.init(START), list(targets), steps=1)
    assert judged.worst_margin >= 0.0


def test_the_judge_sees_a_violation() -> None:
    # The measure of all closed loops has to be able to fail.
    scene = bent_tube()
    mpc = scene.mpc()
    _, command = mpc.step(mpc.init(START), scene.axis[10])
    judged = Judged()
    bent = np.array([0.0, 0.6, 0.055, 0.0, 0.0, 0.055, 0.0, 0.0, 0.055])
    judge(mpc, scene.robot.sampled(DENSE), START, bent, command, judged)
    assert judged.worst_margin < 0.0
