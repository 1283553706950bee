"""The peers that CasADi's wheel brings along."""

from sinuous.bench.peers.compile import FLAGS, compiler
from sinuous.bench.peers.ipopt import IPOPT_TUNING, ipopt
from sinuous.bench.peers.nlp import Method, NlpController
from sinuous.bench.peers.peer import Peer
from sinuous.bench.peers.problem import Problem
from sinuous.bench.peers.setup import nlp_for
from sinuous.bench.peers.silence import quiet
from sinuous.bench.peers.sqp import SQP_TUNING, sqp
from sinuous.bench.scene import Scene

IPOPT = "CasADi IPOPT"
IPOPT_AS_INSTALLED = "CasADi IPOPT, no compiler"
SQP = "CasADi SQP"
SQP_RTI = "CasADi SQP RTI"

AS_INSTALLED_TUNING = (
    "the same program and settings, evaluated by CasADi itself: what the wheel does on a machine "
    "without a C compiler",
)
INTERPRETED = "interpreted by CasADi"

CASADI_TUNING = {
    IPOPT: IPOPT_TUNING,
    IPOPT_AS_INSTALLED: AS_INSTALLED_TUNING,
    SQP: SQP_TUNING,
    SQP_RTI: SQP_TUNING,
}


def casadi_peers(scene: Scene, horizon: int, *, machine_code: bool = True) -> list[Peer]:
    """All of them; compiling their program may take a while the first time."""
    native = machine_code and compiler() is not None
    problem = nlp_for(scene, horizon, machine_code=native)
    functions = " ".join(("cc", *FLAGS)) if native else INTERPRETED
    peers = [
        _peer(name, method, scene, problem, functions)
        for name, method in {
            IPOPT: ipopt(),
            SQP: sqp(horizon, converged=True),
            SQP_RTI: sqp(horizon, converged=False),
        }.items()
    ]
    if native:
        plain = nlp_for(scene, horizon, machine_code=False)
        peers.insert(1, _peer(IPOPT_AS_INSTALLED, ipopt(), scene, plain, INTERPRETED))
    return peers


def _peer(name: str, method: Method, scene: Scene, problem: Problem, functions: str) -> Peer:
    """One participant, with the log of one solve."""
    controller = NlpController(scene=scene, problem=problem, method=method)
    with quiet():
        log = controller.log()
    settings = {
        "functions": functions,
        "plugin": method.plugin,
        "hessian": method.hessian,
        **method.options,
    }
    return Peer(name=name, controller=controller, settings=settings, log=log, silence=quiet)
