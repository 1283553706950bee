"""Where an unreachable target leaves the tip, against IPOPT from many starts.

The oracle shares nothing with the controller: kinematics written anew with the curvature and
plane of each segment, in CasADi; walls as the six planes of a box; exact second derivatives.
"""

import casadi as ca
import numpy as np

from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.report import Status
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot_file import load_robot

STARTS = 50
GAP = 5e-4  # how far the controller may stay behind the best of all starts [m]
MARGIN = 0.002
HALF = np.array([0.035, 0.03])  # of the box across [m]
FLOOR, ROOF = -0.02, 0.19
RADIUS, PITCH = 0.008, 0.007
POINTS = 30  # per segment: as dense as the controller's
STRAIGHT = 1e-9  # keeps the oracle's curvature away from 0/0


def segment(theta: ca.SX, gamma: ca.SX, u: float) -> tuple[ca.SX, ca.SX]:
    """Rotation and position at the fraction u of an arc, by angle and plane."""
    bend = ca.sqrt(ca.dot(theta, theta) + STRAIGHT**2)
    k, a = theta / bend, u * bend
    z = ca.DM([0.0, 0.0, 1.0])
    x = ca.vertcat(k, 0)
    axis = ca.cross(z, x)
    turn = ca.skew(axis)
    rotation = ca.DM.eye(3) + ca.sin(a) * turn + (1 - ca.cos(a)) * turn @ turn
    return rotation, gamma / bend * ((1 - ca.cos(a)) * x + ca.sin(a) * z)


def oracle(target: np.ndarray) -> tuple[ca.Function, np.ndarray, np.ndarray]:
    """IPOPT for the tip closest to the target, and the bounds of its constraints."""
    c = ca.SX.sym("c", 9)
    R, p = ca.DM.eye(3), ca.DM.zeros(3)
    body, limits, low, high = [], [], [], []
    for j in range(3):
        theta, gamma = c[3 * j : 3 * j + 2], c[3 * j + 2]
        for i in range(1, POINTS + 1):
            body.append(p + R @ segment(theta, gamma, i / POINTS)[1])
        turn, way = segment(theta, gamma, 1.0)
        p, R = p + R @ way, R @ turn
        holes = np.deg2rad([0.0, 120.0, 240.0])
        for hole in holes:
            limits.append(gamma - PITCH * (theta[0] * np.cos(hole) + theta[1] * np.sin(hole)))
        low += [0.022] * 3 + [0.040]
        high += [0.108] * 3 + [0.090]
        limits.append(gamma)
        limits += [ca.dot(theta, theta) - (gamma / 0.035) ** 2,
                   ca.dot(theta, theta) - ((gamma - 0.020) / RADIUS) ** 2]  # fmt: skip
        low += [-np.inf] * 2
        high += [0.0] * 2
    room = RADIUS + MARGIN
    for point in body:
        limits.append(point)
        low += [-HALF[0] + room, -HALF[1] + room, -np.inf]  # the floor is the entrance
        high += [HALF[0] - room, HALF[1] - room, ROOF - room]
    problem = {"x": c, "f": 1e4 * ca.sumsqr(p - target), "g": ca.vertcat(*limits)}
    quiet = {"ipopt.print_level": 0, "print_time": 0, "ipopt.sb": "yes", "ipopt.max_iter": 500}
    return ca.nlpsol("oracle", "ipopt", problem, quiet), np.array(low), np.array(high)


def test_the_tip_waits_where_the_best_of_many_starts_would_put_it() -> None:
    robot = load_robot("hachen2025")
    centre = [0.0, 0.0, (FLOOR + ROOF) / 2]
    box = shapes.box([2 * HALF[0], 2 * HALF[1], ROOF - FLOOR], centre=centre)
    zone = SafeZone.from_mesh(box, entrance=[0.0, 0.0, FLOOR])
    target = np.array([HALF[0] + 0.04, 0.01, 0.12])  # 40 mm beyond a wall

    solver, low, high = oracle(target)
    rng, reached = np.random.default_rng(0), []
    for _ in range(STARTS):
        start = rng.normal(0.0, 0.5, 9)
        start[2::3] = rng.uniform(0.04, 0.09, 3)
        found = solver(x0=start, lbg=low, ubg=high)
        if solver.stats()["success"]:
            c = np.array(found["x"]).ravel()
            reached.append(float(np.linalg.norm(robot.tip(c) - target)))
    assert len(reached) > STARTS / 2

    mpc = ShapeConstrainedMPC(robot, zone, margin=MARGIN)
    state = mpc.init([0.0, 0.0, 0.045] * 3)
    for _ in range(300):
        state, command = mpc.step(state, target)
    assert command.report.status is Status.BLOCKED
    ours = float(np.linalg.norm(command.report.points[-1] - target))
    assert min(reached) - 1e-6 <= ours <= min(reached) + GAP
