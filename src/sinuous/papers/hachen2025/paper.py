"""Paper B: what `sinuous reproduce hachen2025` runs."""

from sinuous.papers.hachen2025.convergence import CONVERGENCE
from sinuous.papers.hachen2025.waypoints import WAYPOINTS
from sinuous.papers.reproduce import Paper

HACHEN2025 = Paper(
    name="hachen2025",
    title="M. Hachen, C. Shentu, S. Lilge, J. Burgner-Kahrs: A Non-Linear Model Predictive "
    "Task-Space Controller Satisfying Shape Constraints for Tendon-Driven Continuum Robots (2025)",
    experiments=(CONVERGENCE, WAYPOINTS),
    claims=(),
)
