"""What the paper says, section by section, and the functions that judge it from data."""

from sinuous.papers.hachen2025.claims.constraints import CONSTRAINTS
from sinuous.papers.hachen2025.claims.convergence import CONVERGENCE
from sinuous.papers.hachen2025.claims.formulas import FORMULAS
from sinuous.papers.hachen2025.claims.hardware import HARDWARE
from sinuous.papers.hachen2025.claims.timing import TIMING

CLAIMS = (*FORMULAS, *CONVERGENCE, *CONSTRAINTS, *TIMING, *HARDWARE)
