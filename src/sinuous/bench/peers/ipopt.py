"""CasADi with IPOPT: exact Hessian, warm started in primal and dual."""

from collections.abc import Mapping
from typing import Any

from sinuous.bench.peers.nlp import Method

BARRIER = 1e-4  # where it starts
PUSH = 1e-6  # how far a warm start may be moved off its bounds

OPTIONS: Mapping[str, Any] = {
    "ipopt.linear_solver": "mumps",
    "ipopt.mumps_pivot_order": 0,
    "ipopt.mumps_permuting_scaling": 0,
    "ipopt.mumps_scaling": 0,
    "ipopt.nlp_scaling_method": "none",
    "ipopt.min_refinement_steps": 0,
    "ipopt.tol": 1e-3,
    "ipopt.mu_init": BARRIER,
    "ipopt.mu_target": 1e-5,
    "ipopt.warm_start_init_point": "yes",
    "ipopt.warm_start_bound_push": PUSH,
    "ipopt.warm_start_bound_frac": PUSH,
    "ipopt.warm_start_slack_bound_push": PUSH,
    "ipopt.warm_start_slack_bound_frac": PUSH,
    "ipopt.warm_start_mult_bound_push": PUSH,
    "ipopt.max_iter": 1000,
}

SILENT: Mapping[str, Any] = {"ipopt.print_level": 0, "ipopt.sb": "yes"}

IPOPT_TUNING = (
    "variables of the order of one, so that no scaling by the solver is needed",
    "9 coordinates: 12 lengths with their sum rules as equalities take as long at N = 2 and a "
    "third more at N = 20, with the same result",
    "gradient, Jacobian and Hessian written by hand stage by stage and compiled with -O3, "
    "buffers instead of CasADi's conversions: a third of the time of automatic derivatives",
    "tol 1e-3 is 7 um in lengths, far below the error of the spline; 1e-4 and 1e-6 move neither "
    "margins nor tip error and take up to a half longer",
    "mu_init 1e-4, mu_target 1e-5: 2 iterations in the median at N = 2; 4 with mu_init 1e-3, 12 "
    "with default settings, which ignore the warm start",
    "monotone barrier: an adaptive one is as fast in the median and slower at the tail",
    "MUMPS with AMD ordering and without scaling of its own; SPRAL takes half as long again, and "
    "the HSL solvers are not in the wheel",
    "1000 iterations allowed: a jump of the target takes up to 300 at N = 20, and a solve that is "
    "cut short there leaves nothing to start the next one from",
)


def ipopt() -> Method:
    """The method."""
    return Method(
        plugin="ipopt",
        hessian="exact",
        options=OPTIONS,
        silent=SILENT,
        accepted=("Solve_Succeeded", "Solved_To_Acceptable_Level"),
    )
