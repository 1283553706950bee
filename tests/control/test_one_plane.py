"""The finding that decided the design: one plane per point is unsafe (notes B8).

The baseline is the usual real-time iteration: value and gradient of the distance at every
guarded point make one plane each, one QP, and its first step is taken whole.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.control import qp
from sinuous.control.mpc import MPCState, ShapeConstrainedMPC
from sinuous.control.problem import build_problem, hard_rows
from sinuous.control.shape import Contacts, Cuts
from sinuous.control.stage import Stage

from .loops import DENSE, Judged, drive, judge
from .scenes import START, Scene, bent_tube

# The baseline comes this much closer than the margin at least [m]; notes B8 saw 3.6 to 13 mm.
UNSAFE = 1e-3


def one_plane(mpc: ShapeConstrainedMPC, stage: Stage) -> Cuts:
    """A plane for every guarded point, from the distance and its gradient."""
    near = stage.walls
    movable = np.flatnonzero(mpc.walls.movable)
    return Cuts(
        jacobian=np.einsum("ki,kin->kn", near.gradient, stage.jacobian)[movable],
        slack=(near.clearance - mpc.walls.required)[movable],
        source=movable,
        triangle=near.triangle[movable],
        normal=near.gradient[movable],
    )


def baseline_step(mpc: ShapeConstrainedMPC, state: MPCState, target: Array) -> MPCState:
    """One real-time iteration with one plane per point."""
    scale = qp.Scale(
        step=float(np.max(mpc.robot.rate_limits)) * mpc.dt,
        inverse=np.linalg.inv(np.linalg.cholesky(gram(mpc)).T),
    )
    start, predicted = mpc.stage(state.c), [mpc.stage(c) for c in state.plan]
    nothing = (Contacts.none(),) * len(predicted)
    hard = hard_rows(mpc.terms, predicted, mpc.dt)
    problem = build_problem(mpc.terms, scale, start, predicted, nothing, target, hard)
    planes = [(i, one_plane(mpc, stage)) for i, stage in enumerate(predicted)]
    solution = qp.solve(problem.with_cuts(scale, planes))
    assert not solution.failure
    found = state.plan + scale.delta(solution.y)
    plan = np.concatenate([found[1:], found[-1:]])
    return MPCState(c=found[0], plan=plan, contacts=nothing)


def gram(mpc: ShapeConstrainedMPC) -> Array:
    A = mpc.robot.lengths_jacobian(mpc.robot.home)
    return A.T @ A


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
