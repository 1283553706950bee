"""Who else takes the time of a step in III-F; needs CasADi."""

from collections.abc import Iterator

from sinuous.bench.peers.acados import acados_peer
from sinuous.bench.peers.compile import compiler
from sinuous.bench.peers.ipopt import ipopt
from sinuous.bench.peers.nlp import NlpController
from sinuous.bench.peers.peer import Peer
from sinuous.bench.peers.setup import nlp_for
from sinuous.bench.peers.silence import quiet
from sinuous.bench.scene import Scene
from sinuous.papers.hachen2025.timing_verdicts import COMPILED, INSTALLED

COMPILED_AT = (2, 5)  # compiling a program takes half a minute the first time
ACADOS_AT = 2


def peers(scene: Scene, horizon: int, *, compiles: bool) -> Iterator[Peer]:
    """IPOPT at every horizon; inside walls at some also compiled, and acados.

    Arguments:
        compiles: whether programs may be compiled
    """
    yield _ipopt(INSTALLED, scene, horizon, machine_code=False)
    if not compiles or not scene.zone.surfaces:
        return
    if horizon in COMPILED_AT:
        if compiler() is None:
            yield Peer(name=COMPILED, controller=None, missing="needs a C compiler")
        else:
            yield _ipopt(COMPILED, scene, horizon, machine_code=True)
    if horizon == ACADOS_AT:
        yield acados_peer(scene, horizon)


def _ipopt(name: str, scene: Scene, horizon: int, *, machine_code: bool) -> Peer:
    problem = nlp_for(scene, horizon, machine_code=machine_code)
    controller = NlpController(scene=scene, problem=problem, method=ipopt())
    return Peer(name=name, controller=controller, silence=quiet)
