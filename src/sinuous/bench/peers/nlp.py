"""Any of CasADi's nonlinear solvers as a controller in closed loop."""

import contextlib
import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import casadi as ca
import numpy as np

from sinuous.arrays import Array
from sinuous.bench.loop import Outcome
from sinuous.bench.peers.kinematics import scaling, unit
from sinuous.bench.peers.problem import Problem
from sinuous.bench.scene import Scene

Options = Mapping[str, Any]

# A step this far beyond the rate limits is no solution: peers of little accuracy stay below.
SANE = 1.02

QUIET: Options = {
    "print_time": False,
    "calc_lam_p": False,
    "no_nlp_grad": True,
    "error_on_fail": False,
    "show_eval_warnings": False,
}


@dataclass(frozen=True, kw_only=True)
class Method:
    """A solver and how it is set.

    Arguments:
        plugin: CasADi's name of it
        hessian: which of the problem's Hessians it uses
        options: that decide how it solves
        silent: those that keep it quiet
        accepted: return statuses whose solution is taken
    """

    plugin: str
    hessian: str
    options: Options
    silent: Options
    accepted: tuple[str, ...]


class Solver:
    """A solver of CasADi's that reads and writes arrays in place, without its conversions.

    Arguments:
        problem: what it solves
        method: how
        loud: whether it prints what it does
    """

    def __init__(self, problem: Problem, method: Method, *, loud: bool = False) -> None:
        function = _nlpsol(problem, method, loud=loud)
        buffer, self._evaluate = _buffer(function)
        bounds = {
            "lbx": problem.lower_x.copy(),
            "ubx": problem.upper_x.copy(),
            "lbg": problem.lower_g.copy(),
            "ubg": problem.upper_g.copy(),
        }
        zero = {name: np.zeros(function.numel_in(name)) for name in function.name_in()}
        self._inputs: dict[str, Array] = zero | bounds
        self._outputs = {
            name: np.zeros(function.numel_out(name)) for name in ("x", "lam_x", "lam_g")
        }
        for name, array in self._inputs.items():
            buffer.set_arg(function.index_in(name), array.data)
        for name, array in self._outputs.items():
            buffer.set_res(function.index_out(name), array.data)
        self._buffer = buffer
        self._counted = 0.0

    def solve(self, p: Array, x: Array, lam_x: Array, lam_g: Array) -> tuple[Array, Array, Array]:
        """Solution and its multipliers of bounds and constraints, from those to start from.

        The arrays that it returns are overwritten by the next solve.
        """
        inputs, outputs = self._inputs, self._outputs
        inputs["p"][:] = p
        inputs["x0"][:] = x
        inputs["lam_x0"][:] = lam_x
        inputs["lam_g0"][:] = lam_g
        self._evaluate()
        return outputs["x"], outputs["lam_x"], outputs["lam_g"]

    def stats(self) -> Mapping[str, Any]:
        """What the solver says about the last solve."""
        try:
            return self._buffer.stats()
        except RuntimeError:  # a solver that broke off before it set a status
            return {"return_status": "Broke_Off", "iter_count": 0}

    def functions(self) -> float:
        """Time spent on functions and derivatives since the last call [s]."""
        stats = self.stats().items()
        before = self._counted
        self._counted = float(sum(t for name, t in stats if name.startswith("t_proc_nlp_")))
        return self._counted - before


def _nlpsol(problem: Problem, method: Method, *, loud: bool) -> ca.Function:
    own = problem.functions
    x, p = ca.MX.sym("x", len(problem.lower_x)), ca.MX.sym("p", own["f"].numel_in("p"))
    program = {"x": x, "p": p, "f": own["f"](x, p), "g": own["g"](x, p)}
    derivatives: dict[str, Any] = {"hess_lag": own[method.hessian]}
    if method.plugin == "ipopt":
        derivatives |= {"grad_f": own["grad_f"], "jac_g": own["jac_g"]}
    else:
        derivatives |= {"jac_fg": own["jac_fg"]}
    options = {**QUIET, **derivatives, **method.options, **({} if loud else method.silent)}
    with contextlib.redirect_stdout(io.StringIO()):  # some print a banner
        return ca.nlpsol("peer", method.plugin, program, options)


def _buffer(function: ca.Function) -> tuple[Any, Callable[[], None]]:
    return function.buffer()  # pyright: ignore[reportReturnType]


@dataclass(frozen=True, kw_only=True, eq=False)
class NlpState:
    """Where the robot is, the shifted solution to start from, and how the last solve went.

    Arguments:
        c: configuration (n,)
        x: y of all stages (n N,)
        lam_x, lam_g: multipliers of bounds and constraints
        held: whether the robot held still
    """

    c: Array
    x: Array
    lam_x: Array
    lam_g: Array
    held: bool = False


@dataclass(frozen=True, kw_only=True, eq=False)
class NlpController:
    """Solves the program in every step, from the shifted solution of the one before.

    Arguments:
        scene: what it controls
        problem: its program
        method: how it is solved
        loud: whether the solver prints
        solver: set up
        factors: (n,) with c = factors * y
        units: of c and target (n + 3,) in the program
        rates: (P, n) change of the actuators in a step, by the largest allowed
    """

    scene: Scene
    problem: Problem
    method: Method
    loud: bool = False
    solver: Solver = field(init=False)
    factors: Array = field(init=False)
    units: Array = field(init=False)
    rates: Array = field(init=False)

    def __post_init__(self) -> None:
        solver = Solver(self.problem, self.method, loud=self.loud)
        object.__setattr__(self, "solver", solver)
        factors, r = scaling(self.scene.robot), unit(self.scene.robot)
        robot = self.scene.robot
        largest = robot.rate_limits[:, 1:] * self.scene.dt
        object.__setattr__(self, "rates", robot.lengths_jacobian(robot.home) / largest)
        object.__setattr__(self, "factors", factors)
        object.__setattr__(self, "units", np.concatenate([factors, [r, r, r]]))

    def init(self, c: Array) -> NlpState:
        """At rest at c (n,), with no multiplier."""
        self.solver.functions()
        return self._rest(np.array(c, dtype=float), held=False)

    def _rest(self, c: Array, *, held: bool) -> NlpState:
        horizon = len(self.problem.lower_x) // len(c)
        return NlpState(
            c=c,
            x=np.tile(c / self.factors, horizon),
            lam_x=np.zeros(len(self.problem.lower_x)),
            lam_g=np.zeros(len(self.problem.lower_g)),
            held=held,
        )

    def step(self, state: NlpState, target: Array) -> NlpState:
        """Solve, take the first step and shift; hold still where the solver fails."""
        n = len(state.c)
        p = np.concatenate([state.c, target]) / self.units
        x, lam_x, lam_g = self.solver.solve(p, state.x, state.lam_x, state.lam_g)
        c = x[:n] * self.factors
        accepted = self.solver.stats()["return_status"] in self.method.accepted
        if not (accepted and self._sane(state.c, c)):
            return self._rest(state.c, held=True)
        rows = len(lam_g) * n // len(x)
        return NlpState(
            c=c,
            x=_shift(x, n),
            lam_x=_shift(lam_x, n),
            lam_g=_shift(lam_g, rows),
        )

    def _sane(self, before: Array, after: Array) -> bool:
        """Whether a step may be commanded: a QP that failed unnoticed jumps or is not finite."""
        rates = self.rates @ (after - before)
        return bool(np.max(np.abs(rates)) <= SANE)  # false for nan

    def outcome(self, state: NlpState) -> Outcome:
        """What the solver says."""
        stats = self.solver.stats()
        status = str(stats["return_status"])
        return Outcome(
            iterations=int(stats["iter_count"]),
            failure=f"held still: {status}" if state.held else "",
            status=status,
            functions=self.solver.functions(),
        )

    def log(self) -> str:
        """What the solver prints in the second step, the first that starts warm."""
        loud = type(self)(scene=self.scene, problem=self.problem, method=self.method, loud=True)
        state, text = loud.init(self.scene.start), io.StringIO()
        for target in self.scene.targets[:2]:
            text = io.StringIO()
            with contextlib.redirect_stdout(text):
                state = loud.step(state, target)
        return text.getvalue()


def _shift(values: Array, count: int) -> Array:
    """One stage on, the last one twice."""
    return np.concatenate([values[count:], values[-count:]])
