"""Who else takes the time of a step in III-F; needs CasADi."""

from collections.abc import Iterator

from sinuous.bench.peers.acados import acados_peer
from sinuous.bench.peers.casadi import SQP, SQP_RTI
from sinuous.bench.peers.compile import compiler
from sinuous.bench.peers.ipopt import ipopt
from sinuous.bench.peers.nlp import Method, NlpController
from sinuous.bench.peers.peer import Peer
from sinuous.bench.peers.problem import Problem
from sinuous.bench.peers.setup import nlp_for
from sinuous.bench.peers.silence import quiet
from sinuous.bench.peers.sqp import sqp
from sinuous.bench.scene import Scene
from sinuous.papers.hachen2025.timing.verdicts import COMPILED, INSTALLED

COMPILED_AT = (2, 5)  # compiling a program takes half a minute the first time
ACADOS_AT = 2


def peers(scene: Scene, horizon: int, *, compiles: bool) -> Iterator[Peer]:
    """IPOPT at every horizon; inside walls at some also compiled, with SQP and acados.

    Arguments:
        compiles: whether programs may be compiled
    """
    plain = nlp_for(scene, horizon, machine_code=False)
    yield _peer(INSTALLED, ipopt(), scene, plain)
    if not compiles or not scene.zone.surfaces:
        return
    if horizon in COMPILED_AT:
        methods = {
            COMPILED: ipopt(),
            f"{SQP}, compiled": sqp(horizon, converged=True),
            f"{SQP_RTI}, compiled": sqp(horizon, converged=False),
        }
        native = None if compiler() is None else nlp_for(scene, horizon, machine_code=True)
        for name, method in methods.items():
            if native is None:
                yield Peer(name=name, controller=None, missing="needs a C compiler")
            else:
                yield _peer(name, method, scene, native)
    if horizon == ACADOS_AT:
        yield acados_peer(scene, horizon)


def _peer(name: str, method: Method, scene: Scene, problem: Problem) -> Peer:
    controller = NlpController(scene=scene, problem=problem, method=method)
    return Peer(name=name, controller=controller, silence=quiet)
