"""Controllers of others for the same task, tuned as their authors would; they need CasADi."""

from sinuous.bench.peers.acados import ACADOS, ACADOS_TUNING, acados_peer
from sinuous.bench.peers.casadi import CASADI_TUNING, casadi_peers
from sinuous.bench.peers.peer import Peer
from sinuous.bench.scene import Scene

TUNING = {**CASADI_TUNING, ACADOS: ACADOS_TUNING}
"""Why each peer is set as it is, by name."""


def all_peers(scene: Scene, horizon: int) -> list[Peer]:
    """Every peer, those too that cannot run here."""
    return [*casadi_peers(scene, horizon), acados_peer(scene, horizon)]
