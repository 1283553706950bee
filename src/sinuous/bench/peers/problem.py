"""The nonlinear program of one step, as a CasADi expert would hand it to a solver.

The 9 coordinates per stage instead of 12 lengths with 3 sum rules: fewer variables and no
equality, which takes IPOPT as long at N = 2 and a quarter less time at N = 20. All derivatives
are written stage by stage (gradient, block Jacobian, block Hessian) and compiled together;
automatic differentiation of the whole would not see that structure.

    min  sum_k |tip(y_k) - target|^2 + w_x |L y_k|^2 + w_u |L (y_k - y_{k-1})|^2
    s.t. rates |L (y_k - y_{k-1})| <= limit,  segment lengths within limits,
         |theta|^2 <= (kappa gamma)^2,  clearance(disk) >= required     for k = 1..N

Limits that others imply are left out: disks that touch, and cable lengths, for this robot.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

import casadi as ca
import numpy as np

from sinuous.arrays import Array
from sinuous.bench.peers.kinematics import unit
from sinuous.bench.peers.spline import Wall
from sinuous.bench.peers.stage import Stage
from sinuous.bench.scene import Scene
from sinuous.robots.pcc import PccRobot

TIP, LENGTHS, RATES = 1000.0, 10.0, 10.0  # weights of (10) as printed
PRINTED_RATE = 30.0  # [Hz] of the steps in which the weight of u is stated


@dataclass(frozen=True, kw_only=True, eq=False)
class Problem:
    """The program's functions and bounds; x are the y of all stages, p is (y_0, target).

    Arguments:
        functions: value, gradient, constraints, Jacobian and both Hessians by name
        lower_x, upper_x: (n N,)
        lower_g, upper_g: ((P + M + D) N,)
    """

    functions: Mapping[str, ca.Function]
    lower_x: Array
    upper_x: Array
    lower_g: Array
    upper_g: Array

    def with_functions(self, functions: Mapping[str, ca.Function]) -> Self:
        """The same program with other functions, such as compiled ones."""
        return replace(self, functions=functions)


def make_problem(scene: Scene, wall: Wall | None, horizon: int) -> Problem:
    """Write down the program for a scene, without a wall for one that has none."""
    writer = _Writer.of(scene.robot, wall, horizon)
    robot, r = scene.robot, unit(scene.robot)
    _check_implied(robot)
    rates = robot.rate_limits * scene.dt / r
    bends, disks = len(robot.segments), 0 if wall is None else writer.stage.disks
    required = (robot.segments[0].body_radius + scene.margin) / r
    lower = np.concatenate([rates[:, 0], np.zeros(bends), np.full(disks, required)])
    upper = np.concatenate([rates[:, 1], np.full(bends + disks, np.inf)])
    shortest, longest = np.full((2, 3 * bends), np.inf)
    shortest[:] *= -1.0
    shortest[2::3] = [segment.length[0] / r for segment in robot.segments]
    longest[2::3] = [segment.length[1] / r for segment in robot.segments]
    return Problem(
        functions=writer.functions(),
        lower_x=np.tile(shortest, horizon),
        upper_x=np.tile(longest, horizon),
        lower_g=np.tile(lower, horizon),
        upper_g=np.tile(upper, horizon),
    )


def _check_implied(robot: PccRobot) -> None:
    """Make sure that the limits which are left out cannot be reached."""
    for segment in robot.segments:
        gamma, pull = np.array(segment.length), unit(robot) * segment.max_curvature
        slope, offset = segment.bend_planes[-1]
        touching = slope * gamma + offset >= segment.max_curvature * gamma
        cables = [gamma[0] * (1.0 - pull), gamma[1] * (1.0 + pull)]
        low, high = segment.cable_length
        if not (touching.all() and low <= cables[0] and cables[1] <= high + 1e-12):
            raise ValueError("the peers' problem leaves out limits that this robot can reach")


@dataclass(frozen=True, kw_only=True, eq=False)
class _Writer:
    """Writes the functions of a program."""

    stage: Stage
    wall: Wall | None
    horizon: int
    X: ca.MX  # y of all stages (n, N)
    p: ca.MX

    @classmethod
    def of(cls, robot: PccRobot, wall: Wall | None, horizon: int) -> Self:
        stage = Stage.of(robot)
        n = len(robot.coordinate_names)
        X, p = ca.MX.sym("x", n, horizon), ca.MX.sym("p", n + 3)
        return cls(stage=stage, wall=wall, horizon=horizon, X=X, p=p)

    @property
    def n(self) -> int:
        return int(self.X.shape[0])

    @property
    def target(self) -> ca.MX:
        return self.p[self.n :]

    @property
    def steps(self) -> ca.MX:
        """Changes from stage to stage (n, N)."""
        return self.X - ca.horzcat(self.p[: self.n], self.X[:, :-1])

    @property
    def weights(self) -> tuple[float, float]:
        """Of lengths and changes, with the tip's weight divided out."""
        return LENGTHS / TIP, RATES / TIP * PRINTED_RATE**2

    def functions(self) -> dict[str, ca.Function]:
        """All of them, with the names and signatures that CasADi's solvers expect."""
        f, grad = {"f": self.cost()}, {"grad_f_x": self.gradient()}
        g, jac = self.jacobian()
        weight_f, weight_g = ca.MX.sym("lam_f"), ca.MX.sym("lam_g", g.shape[0])
        dual = {"lam_f": weight_f, "lam_g": weight_g}
        exact = ca.triu(self.hessian(weight_f, weight_g, exact=True))
        gauss_newton = self.hessian(weight_f, weight_g, exact=False)
        both = {"g": g, "jac_g_x": jac}
        return {
            "f": self._function("nlp_f", f),
            "g": self._function("nlp_g", {"g": self.constraints()}),
            "grad_f": self._function("nlp_grad_f", f | grad),
            "jac_g": self._function("nlp_jac_g", both),
            "jac_fg": self._function("nlp_jac_fg", f | grad | both),
            "exact": self._function("nlp_hess_l", {"triu_hess_gamma_x_x": exact}, dual),
            "gauss_newton": self._function("nlp_gn", {"hess_gamma_x_x": gauss_newton}, dual),
        }

    def _function(
        self, name: str, outputs: dict[str, ca.MX], dual: dict[str, ca.MX] | None = None
    ) -> ca.Function:
        inputs = {"x": ca.vec(self.X), "p": self.p, **(dual or {})}
        return ca.Function(
            name, list(inputs.values()), list(outputs.values()), list(inputs), list(outputs)
        )

    def cost(self) -> ca.MX:
        tips = self.stage.tip.map(self.horizon)(self.X)
        L = ca.DM(self.stage.lengths)
        long, fast = self.weights
        return (
            ca.sumsqr(tips - self.target)
            + long * ca.sumsqr(L @ self.X)
            + fast * ca.sumsqr(L @ self.steps)
        )

    def gradient(self) -> ca.MX:
        tips, J = self.stage.tip_first.map(self.horizon)(self.X)
        metric = ca.DM(self.stage.lengths.T @ self.stage.lengths)
        long, fast = self.weights
        pull, steps, parts = metric @ self.X, metric @ self.steps, list[ca.MX]()
        for k in range(self.horizon):
            own = self._columns(J, k, self.n).T @ (tips[:, k] - self.target)
            change = steps[:, k] - steps[:, k + 1] if k + 1 < self.horizon else steps[:, k]
            parts.append(2.0 * (own + long * pull[:, k] + fast * change))
        return ca.vertcat(*parts)

    def constraints(self) -> ca.MX:
        y = ca.MX.sym("y", self.n)
        stage = ca.Function("limits", [y], [self.stage.limits(self.wall, y)])
        values = stage.map(self.horizon)(self.X)
        return ca.vec(ca.vertcat(ca.DM(self.stage.lengths) @ self.steps, values))

    def jacobian(self) -> tuple[ca.MX, ca.MX]:
        """The constraints and their Jacobian."""
        y = ca.MX.sym("y", self.n)
        value, slope = self.stage.limits_first(self.wall, y)
        stage = ca.Function("limits_first", [y], [value, slope])
        values, slopes = stage.map(self.horizon)(self.X)
        L = ca.DM(self.stage.lengths)
        g = ca.vec(ca.vertcat(L @ self.steps, values))
        count, blocks = value.shape[0], list[ca.MX]()
        for k in range(self.horizon):
            before = [ca.MX(L.shape[0] + count, self.n * max(k - 1, 0))]
            before += [ca.MX(ca.vertcat(-L, ca.DM(count, self.n)))] if k else []
            own = ca.vertcat(L, self._columns(slopes, k, self.n))
            after = ca.MX(L.shape[0] + count, self.n * (self.horizon - 1 - k))
            blocks.append(ca.horzcat(*before, own, after))
        return g, ca.vertcat(*blocks)

    def hessian(self, weight_f: ca.MX, weight_g: ca.MX, *, exact: bool) -> ca.MX:
        """Of the Lagrangian, or without all second derivatives of the robot and the walls."""
        rows = weight_g.shape[0] // self.horizon
        weights = ca.reshape(weight_g, rows, self.horizon)
        skip = len(self.stage.lengths)
        stage = self._stage_hessian(rows - skip, exact=exact)
        own = stage.map(self.horizon)(
            self.X,
            weights[skip:, :],
            ca.repmat(weight_f, 1, self.horizon),
            ca.repmat(self.target, 1, self.horizon),
        )
        blocks = [self._columns(own, k, self.n) for k in range(self.horizon)]
        return ca.diagcat(*blocks) + weight_f * self._length_hessian()

    def _stage_hessian(self, rows: int, *, exact: bool) -> ca.Function:
        n = self.n
        y, weights = ca.MX.sym("y", n), ca.MX.sym("weights", rows)
        weight_f, target = ca.MX.sym("weight_f"), ca.MX.sym("target", 3)
        points, J = self.stage.first(y)
        tip = J[-3:, :]
        total = 2.0 * weight_f * tip.T @ tip
        if exact:
            bends = len(self.stage.robot.segments)
            on_bend, on_disks = weights[:bends], weights[bends:]
            force = ca.MX(3, self.stage.disks)
            if self.wall is not None:
                gradient, second = self.wall.second.map(self.stage.disks)(points)
                force = gradient * ca.repmat(on_disks.T, 3, 1)
                walls = [
                    on_disks[i] * (second[:, 3 * i : 3 * i + 3] @ J[3 * i : 3 * i + 3, :])
                    for i in range(self.stage.disks)
                ]
                total += J.T @ ca.vertcat(*walls)
            pull = force[:, -1] + 2.0 * weight_f * (points[:, -1] - target)
            force = ca.horzcat(force[:, :-1], pull)
            total += self.stage.curvature(y, force)
            total += ca.hessian(ca.dot(on_bend, self.stage.bend(y)), y)[0]
        name = "stage_exact" if exact else "stage_gauss_newton"
        return ca.Function(name, [y, weights, weight_f, target], [ca.densify(total)])

    def _length_hessian(self) -> ca.DM:
        """Of the costs of lengths and changes: constant, block tridiagonal."""
        metric = self.stage.lengths.T @ self.stage.lengths
        long, fast = self.weights
        N = self.horizon
        twice = np.diag([2.0] * (N - 1) + [1.0]) - np.eye(N, k=1) - np.eye(N, k=-1)
        whole = np.kron(2.0 * (long * np.eye(N) + fast * twice), metric)
        return ca.sparsify(ca.DM(whole))

    @staticmethod
    def _columns(matrix: ca.MX, k: int, count: int) -> ca.MX:
        return matrix[:, k * count : (k + 1) * count]
