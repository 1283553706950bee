"""CasADi's SQP method, once as real-time iteration and once until it converges."""

from collections.abc import Mapping
from typing import Any

from sinuous.bench.peers.nlp import Method

SILENT: Mapping[str, Any] = {
    "print_header": False,
    "print_iteration": False,
    "print_status": False,
}

SQP_TUNING = (
    "Gauss-Newton Hessian: with the exact one CasADi's regularisation adds so much that the tip "
    "lags (8.4 mm in the median instead of 2.2 at N = 2) and hardly a solve converges; adding "
    "only the walls' curvature, clipped to be convex, changed nothing",
    "CasADi SQP: up to 50 iterations with line search, with 20 the margin breaks by 1.3 mm at "
    "N = 2; up to 15 beyond N = 10, where 50 take 0.4 s",
    "CasADi SQP RTI: one iteration and the full step",
    "QP solvers of the wheel, measured: DAQP leads up to N = 10, before qpOASES and OSQP; at "
    "N = 20 OSQP with polishing is the only one that survives QPs without a solution (DAQP, "
    "qpOASES, PIQP and ProxQP return steps of metres, ipqp breaks off in a third of the steps). "
    "qrqp and fatrop fail on these QPs already at N = 2, and HPIPM cannot take their structure",
    "CasADi does not report a QP that failed, so a step more than 2 % beyond the rate limits "
    "counts as a failure",
)

DENSE = 10  # the longest horizon whose QP a dense active-set method solves faster


def sqp(horizon: int, *, converged: bool) -> Method:
    """The method, with the QP solver that is best at that horizon."""
    qp: dict[str, Any] = {"qpsol": "daqp", "qpsol_options": {"error_on_fail": False}}
    if horizon > DENSE:
        settings = {"verbose": False, "eps_abs": 1e-5, "eps_rel": 1e-5, "polish": True}
        qp = {"qpsol": "osqp", "qpsol_options": {"error_on_fail": False, "osqp": settings}}
    most = 50 if horizon <= DENSE else 15
    return Method(
        plugin="sqpmethod",
        hessian="gauss_newton",
        options={
            **qp,
            "max_iter": most if converged else 1,
            "max_iter_ls": 10 if converged else 0,
            "tol_du": 1e-3,
            "tol_pr": 1e-4,
        },
        silent=SILENT,
        accepted=("Solve_Succeeded", "Maximum_Iterations_Exceeded"),
    )
