"""acados: real-time iteration with Gauss-Newton Hessian and HPIPM."""

import contextlib
import io
from dataclasses import dataclass, field
from typing import Any, Self

import casadi as ca
import numpy as np

from sinuous.arrays import Array
from sinuous.bench.loop import Outcome
from sinuous.bench.peers.acados_build import HOW, build, fresh_folder, linked, load
from sinuous.bench.peers.compile import compiler
from sinuous.bench.peers.kinematics import scaling, unit
from sinuous.bench.peers.nlp import SANE
from sinuous.bench.peers.peer import Peer
from sinuous.bench.peers.problem import LENGTHS, PRINTED_RATE, RATES, TIP
from sinuous.bench.peers.setup import GRID
from sinuous.bench.peers.silence import quiet
from sinuous.bench.peers.spline import Spline, Wall
from sinuous.bench.peers.stage import Stage
from sinuous.bench.scene import Scene

ACADOS = "acados RTI"

PENALTY = 10.0  # of clearance and bend that cannot be kept, linear, in units of cost by r
FAR = 1e4  # a bound that never holds

SETTINGS: dict[str, Any] = {
    "nlp_solver_type": "SQP_RTI",
    "hessian_approx": "GAUSS_NEWTON",
    "integrator_type": "DISCRETE",
    "qp_solver": "PARTIAL_CONDENSING_HPIPM",
    "hpipm_mode": "SPEED",
    "qp_solver_iter_max": 100,
    "print_level": 0,
}

ACADOS_TUNING = (
    "states are the 9 scaled coordinates, inputs their changes, cost NONLINEAR_LS; clearance and "
    "its Jacobian come from the same -O3 library as for CasADi's solvers",
    "HPIPM in SPEED mode without further condensing: full condensing is as fast at N = 2, "
    "qpOASES half as slow again, and condensing 20 stages to 10 or 5 gains nothing",
    "clearance and bend are soft with a linear penalty: hard ones end in QPs without a solution "
    "in a tenth of the steps at N = 20, and change nothing at N = 2",
    "times include the Python interface; solver_median_ms is what acados counts itself",
)


def acados_peer(scene: Scene, horizon: int) -> Peer:
    """The peer, or what is missing for it."""
    template, command = load(), compiler()
    if template is None or command is None:
        missing = HOW if template is None else "needs a C compiler"
        return Peer(name=ACADOS, controller=None, missing=missing)
    solver = _solver(template, command, scene, horizon)
    controller = AcadosController.of(solver, scene, horizon)
    settings = {**SETTINGS, "penalty": PENALTY}
    log = controller.log()
    return Peer(name=ACADOS, controller=controller, settings=settings, log=log, silence=quiet)


def _solver(template: Any, command: str, scene: Scene, horizon: int) -> Any:
    stage = Stage.of(scene.robot)
    name = f"peer_{stage.disks}_{horizon}"
    folder = fresh_folder(f"acados_{name}")
    r = unit(scene.robot)
    wall = Wall.local(Spline.fit(scene.zone, spacing=GRID, unit=r))
    limits = linked(*stage.limits_pair(wall, f"limits_{name}"), folder, command)
    ocp = template.AcadosOcp()
    ocp.model = _model(template, stage, limits, name)
    ocp.dims.N = horizon
    _cost(ocp, stage)
    _constraints(ocp, stage, scene)
    for key, value in SETTINGS.items():
        setattr(ocp.solver_options, key, value)
    ocp.solver_options.tf = float(horizon)  # steps of one: acados weighs stages by their time
    ocp.solver_options.model_external_shared_lib_dir = str(folder)
    ocp.solver_options.model_external_shared_lib_name = limits.name()
    ocp.code_export_directory = str(folder / "code")
    return build(template, ocp, folder)


def _model(template: Any, stage: Stage, limits: ca.Function, name: str) -> Any:
    n = len(stage.robot.coordinate_names)
    y, u, L = ca.MX.sym("y", n), ca.MX.sym("u", n), ca.DM(stage.lengths)
    model = template.AcadosModel()
    model.name, model.x, model.u, model.disc_dyn_expr = name, y, u, y + u
    model.cost_y_expr_0 = L @ u
    model.cost_y_expr = ca.vertcat(stage.tip(y), L @ y, L @ u)
    model.cost_y_expr_e = ca.vertcat(stage.tip(y), L @ y)
    model.con_h_expr = model.con_h_expr_e = limits(y)
    return model


def _cost(ocp: Any, stage: Stage) -> None:
    P, cost = len(stage.lengths), ocp.cost
    tip, long, fast = [1.0] * 3, [LENGTHS / TIP] * P, [RATES / TIP * PRINTED_RATE**2] * P
    for suffix, weights in (("_0", fast), ("", tip + long + fast), ("_e", tip + long)):
        setattr(cost, f"cost_type{suffix}", "NONLINEAR_LS")
        setattr(cost, f"W{suffix}", 2.0 * np.diag(weights))
        setattr(cost, f"yref{suffix}", np.zeros(len(weights)))


def _constraints(ocp: Any, stage: Stage, scene: Scene) -> None:
    robot, r, cons = scene.robot, unit(scene.robot), ocp.constraints
    n, P = len(robot.coordinate_names), len(robot.actuator_names)
    rates = robot.rate_limits * scene.dt / r
    cons.C, cons.D, cons.lg, cons.ug = np.zeros((P, n)), stage.lengths, rates[:, 0], rates[:, 1]
    cons.x0 = scene.start / scaling(robot)
    required = (robot.segments[0].body_radius + scene.margin) / r
    lower = np.concatenate([np.zeros(len(robot.segments)), np.full(stage.disks, required)])
    count, gammas = len(lower), np.arange(2, n, 3)
    for suffix in ("", "_e"):
        setattr(cons, f"idxbx{suffix}", gammas)
        for k, side in enumerate("lu"):
            bounds = np.array([segment.length[k] / r for segment in robot.segments])
            setattr(cons, f"{side}bx{suffix}", bounds)
            setattr(ocp.cost, f"z{side}{suffix}", np.full(count, PENALTY))
            setattr(ocp.cost, f"Z{side}{suffix}", np.zeros(count))
        setattr(cons, f"lh{suffix}", lower)
        setattr(cons, f"uh{suffix}", np.full(count, FAR))
        setattr(cons, f"idxsh{suffix}", np.arange(count))


@dataclass(frozen=True, kw_only=True)
class AcadosState:
    """Where the robot is; acados keeps the rest.

    Arguments:
        c: configuration (n,)
        status: acados's number, 0 for success
        held: whether the robot held still
    """

    c: Array
    status: int = 0
    held: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class AcadosController:
    """Shifts the last solution, does one iteration and takes its first step."""

    solver: Any
    horizon: int
    factors: Array
    unit: float
    rates: Array  # (P, n) change of the actuators in a step, by the largest allowed
    limits: int  # how many conditions of clearance and bend a stage has
    scene: Scene = field(repr=False)

    @classmethod
    def of(cls, solver: Any, scene: Scene, horizon: int) -> Self:
        """Ready to drive."""
        robot = scene.robot
        return cls(
            solver=solver,
            horizon=horizon,
            factors=scaling(robot),
            unit=unit(robot),
            rates=robot.lengths_jacobian(robot.home) / (robot.rate_limits[:, 1:] * scene.dt),
            limits=len(robot.segments) + sum(segment.disks for segment in robot.segments),
            scene=scene,
        )

    def init(self, c: Array) -> AcadosState:
        """At rest at c (n,)."""
        return self._rest(AcadosState(c=np.array(c, dtype=float)))

    def _rest(self, state: AcadosState) -> AcadosState:
        self.solver.reset()
        # Conditions on where the robot is already could only make the problem infeasible.
        self.solver.constraints_set(0, "lh", np.full(self.limits, -FAR))
        for k in range(self.horizon + 1):
            self.solver.set(k, "x", state.c / self.factors)
        return state

    def step(self, state: AcadosState, target: Array) -> AcadosState:
        """Shift, prepare and solve; hold still where the QP has no solution."""
        solver, N = self.solver, self.horizon
        for k in range(N):
            solver.set(k, "x", solver.get(k + 1, "x"))
            solver.set(k, "u", solver.get(k + 1, "u") if k + 1 < N else np.zeros(len(state.c)))
        y = state.c / self.factors
        solver.set(0, "lbx", y)
        solver.set(0, "ubx", y)
        wanted = np.zeros(3 + 2 * len(self.rates))
        wanted[:3] = target / self.unit
        for k in range(1, N):
            solver.set(k, "yref", wanted)
        solver.set(N, "yref", wanted[: 3 + len(self.rates)])
        status = int(solver.solve())
        c = solver.get(1, "x") * self.factors
        sane = bool(np.max(np.abs(self.rates @ (c - state.c))) <= SANE)
        if status != 0 or not sane:
            return self._rest(AcadosState(c=state.c, status=status, held=True))
        return AcadosState(c=c, status=status)

    def outcome(self, state: AcadosState) -> Outcome:
        """What acados says: iterations are those of HPIPM."""
        status = f"status {state.status}"
        return Outcome(
            iterations=int(np.max(self.solver.get_stats("qp_iter"))),
            failure=f"held still: {status}" if state.held else "",
            status=status,
            functions=float(np.max(self.solver.get_stats("time_lin"))),
            solver=float(np.max(self.solver.get_stats("time_tot"))),
        )

    def log(self) -> str:
        """What acados prints about the second step, the first that starts warm."""
        state, text = self.init(self.scene.start), io.StringIO()
        for target in self.scene.targets[:2]:
            state = self.step(state, target)
        with contextlib.redirect_stdout(text):
            self.solver.print_statistics()
        return text.getvalue()
