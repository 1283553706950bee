"""The peers solve our problem: same robot, same walls, same derivatives, same answer."""

from dataclasses import replace

import casadi as ca
import numpy as np
import pytest

from sinuous.bench.judge import judge
from sinuous.bench.loop import drive
from sinuous.bench.ours import Ours
from sinuous.bench.peers import ipopt, sqp
from sinuous.bench.peers.acados import acados_peer
from sinuous.bench.peers.acados_build import load
from sinuous.bench.peers.kinematics import scaling, unit
from sinuous.bench.peers.nlp import NlpController
from sinuous.bench.peers.problem import make_problem
from sinuous.bench.peers.setup import nlp_for
from sinuous.bench.peers.spline import Spline, Wall
from sinuous.bench.peers.stage import Stage
from sinuous.bench.scene import Scene, stress_scene
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone

EXACT = 1e-12  # [m] two ways to add up the same numbers
SPLINE = 3e-4  # [m] what a 2 mm grid misses near the margin: notes say 0.15 mm, kinks more
SAME_TIP = 1e-5  # [m] two solvers at rest, each within its tolerance
COARSE = 0.008  # [m] a grid for tests that do not look at walls
METHODS = {
    "ipopt": ipopt.ipopt(),
    "sqp": sqp.sqp(2, converged=True),
    "rti": sqp.sqp(2, converged=False),
    "rti, long": sqp.sqp(20, converged=False),
}


def configurations(scene: Scene, count: int) -> np.ndarray:
    rng = np.random.default_rng(5)
    spread = np.tile([0.5, 0.5, 0.01], 3)
    return scene.start + rng.uniform(-1.0, 1.0, (count, 9)) * spread


@pytest.fixture(scope="module")
def hall() -> Scene:
    """A room so wide that no wall is ever near."""
    scene = stress_scene(9, 90)
    zone = SafeZone.from_mesh(shapes.box([0.7, 0.7, 0.7]))
    target = scene.robot.tip(scene.start) + [0.01, 0.015, 0.02]
    return replace(scene, zone=zone, targets=np.tile(target, (90, 1)))


@pytest.mark.parametrize("disks", [9, 30])
def test_the_disks_are_where_the_robot_has_them(disks: int) -> None:
    scene = stress_scene(disks)
    stage, r = Stage.of(scene.robot), unit(scene.robot)
    for c in (scene.robot.home, *configurations(scene, 10)):
        found = np.array(stage.positions(c / scaling(scene.robot))).T * r
        expected = scene.robot.points(c)[scene.robot.disk_indices]
        np.testing.assert_allclose(found, expected, atol=EXACT)
        np.testing.assert_allclose(
            stage.lengths @ (c / scaling(scene.robot)) * r, scene.robot.lengths(c), atol=EXACT
        )


def test_the_spline_is_close_to_the_mesh_near_the_margin() -> None:
    scene = stress_scene(9)
    r = unit(scene.robot)
    spline = Spline.fit(scene.zone, spacing=0.002, unit=r)
    corners = scene.zone.triangles.reshape(-1, 3)
    rng = np.random.default_rng(3)
    points = rng.uniform(corners.min(axis=0), corners.max(axis=0), (20000, 3))
    exact = scene.zone.clearance(points)
    near = np.abs(exact - 0.005) < 0.002
    value = spline.interpreted().map(int(near.sum()))
    error = np.array(value(points[near].T / r)).ravel() * r - exact[near]
    assert near.sum() > 500
    assert np.abs(error).max() < SPLINE
    assert np.median(np.abs(error)) < 2e-5


def test_the_compiled_form_of_the_spline_is_casadis() -> None:
    scene = stress_scene(9)
    r = unit(scene.robot)
    spline = Spline.fit(scene.zone, spacing=COARSE, unit=r)
    local, own = Wall.local(spline), Wall.interpreted(spline)
    for point in scene.robot.points(scene.start)[1::9] / r:
        for name in ("value", "first", "second"):
            found, expected = getattr(local, name).call([point]), getattr(own, name).call([point])
            for a, b in zip(found, expected, strict=True):
                np.testing.assert_allclose(np.array(a), np.array(b), atol=1e-11)


def test_derivatives_written_by_hand_are_those_of_the_program() -> None:
    scene, horizon = stress_scene(9), 3
    spline = Spline.fit(scene.zone, spacing=COARSE, unit=unit(scene.robot))
    own = make_problem(scene, Wall.interpreted(spline), horizon).functions
    x, p = ca.MX.sym("x", 9 * horizon), ca.MX.sym("p", 12)
    f, g = own["f"](x, p), own["g"](x, p)
    weights = ca.MX.sym("w", g.shape[0])
    outputs = [ca.gradient(f, x), ca.jacobian(g, x)]
    outputs += [ca.hessian(1.3 * f + ca.dot(weights, g), x)[0]]
    automatic = ca.Function("automatic", [x, p, weights], outputs)
    rng = np.random.default_rng(1)
    at = configurations(scene, horizon).ravel() / np.tile(scaling(scene.robot), horizon)
    value = [at, rng.uniform(1.0, 8.0, 12), rng.normal(size=g.shape[0])]
    gradient, jacobian, hessian = (np.array(m) for m in automatic.call(value))
    found = np.array(own["exact"](value[0], value[1], 1.3, value[2]))
    np.testing.assert_allclose(np.array(own["grad_f"].call(value[:2])[1]), gradient, atol=1e-9)
    np.testing.assert_allclose(np.array(own["jac_g"].call(value[:2])[1]), jacobian, atol=1e-9)
    np.testing.assert_allclose(found, np.triu(hessian), atol=1e-8)


@pytest.mark.parametrize("name", METHODS)
def test_peers_and_ours_come_to_rest_at_the_same_place(name: str, hall: Scene) -> None:
    problem = nlp_for(hall, 2, grid=0.03, machine_code=False)
    peer = drive(NlpController(scene=hall, problem=problem, method=METHODS[name]), hall)
    ours = drive(Ours.of(hall, 2, disks_only=True), hall)
    assert not any(outcome.failure for outcome in (*peer.outcomes, *ours.outcomes))
    tips = hall.robot.tip(np.stack([peer.c[-1], ours.c[-1]]))
    assert np.linalg.norm(tips[0] - tips[1]) < SAME_TIP
    assert np.linalg.norm(peer.c[-1] - peer.c[0]) > 0.1  # it went somewhere
    assert judge(hall, peer, whole_body=False)["largest_rate_by_its_limit"] < 1.001
    assert all(outcome.functions > 0.0 for outcome in peer.outcomes)


def test_a_peer_without_a_solution_holds_still(hall: Scene) -> None:
    problem = nlp_for(hall, 2, grid=0.03, machine_code=False)
    method = replace(METHODS["ipopt"], options={"ipopt.max_iter": 0})
    found = drive(NlpController(scene=hall, problem=problem, method=method), hall)
    assert all(outcome.failure for outcome in found.outcomes)
    assert np.all(found.c == hall.start)


def test_the_log_is_what_the_solver_prints(hall: Scene) -> None:
    problem = nlp_for(hall, 2, grid=0.03, machine_code=False)
    controller = NlpController(scene=hall, problem=problem, method=METHODS["ipopt"])
    assert "EXIT: Optimal Solution Found." in controller.log()


@pytest.mark.skipif(load() is None, reason="acados is not installed")
def test_acados_takes_the_steps_of_an_rti() -> None:
    scene = stress_scene(9, 40)
    peer = acados_peer(scene, 2)
    assert peer.controller is not None
    with peer.silence():
        found = drive(peer.controller, scene)
    other = NlpController(scene=scene, problem=nlp_for(scene, 2), method=METHODS["rti"])
    np.testing.assert_allclose(found.c, drive(other, scene).c, atol=1e-3)


def test_without_acados_the_row_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sinuous.bench.peers.acados.load", lambda: None)
    peer = acados_peer(stress_scene(9, 1), 2)
    assert peer.controller is None
    assert "pip install" in peer.missing
