"""Paper B: what `sinuous reproduce hachen2025` runs."""

from sinuous.papers.hachen2025.claims import CLAIMS
from sinuous.papers.hachen2025.convergence.experiment import CONVERGENCE
from sinuous.papers.hachen2025.hardware.experiment import HARDWARE
from sinuous.papers.hachen2025.horizons.experiment import HORIZONS_EXPERIMENT
from sinuous.papers.hachen2025.physics.hardware import HARDWARE_PHYSICS
from sinuous.papers.hachen2025.physics.loop import PHYSICS
from sinuous.papers.hachen2025.physics.tension import TENSION
from sinuous.papers.hachen2025.physics.verdicts import VERDICTS as ON_PHYSICS
from sinuous.papers.hachen2025.printed import PRINTED_READINGS
from sinuous.papers.hachen2025.shape_sensing.experiment import SHAPE_SENSING
from sinuous.papers.hachen2025.stability.experiment import STABILITY
from sinuous.papers.hachen2025.timing.experiment import TIMING
from sinuous.papers.hachen2025.tuning import TUNING
from sinuous.papers.hachen2025.unreachable.experiment import UNREACHABLE
from sinuous.papers.hachen2025.waypoints.experiment import WAYPOINTS
from sinuous.papers.reproduce import Paper

HACHEN2025 = Paper(
    name="hachen2025",
    title="M. Hachen, C. Shentu, S. Lilge, J. Burgner-Kahrs: A Non-Linear Model Predictive "
    "Task-Space Controller Satisfying Shape Constraints for Tendon-Driven Continuum Robots (2025)",
    experiments=(
        TIMING,  # first, while the other processes have nothing to do
        PRINTED_READINGS,
        TUNING,
        CONVERGENCE,
        WAYPOINTS,
        STABILITY,
        UNREACHABLE,
        HARDWARE,
        HARDWARE_PHYSICS,
        PHYSICS,
        TENSION,
        SHAPE_SENSING,
        HORIZONS_EXPERIMENT,
    ),
    claims=(*CLAIMS, *ON_PHYSICS),
)
