"""The papers that can be reproduced, by name."""

from sinuous.papers.hachen2025.paper import HACHEN2025
from sinuous.papers.qin2020.paper import QIN2020
from sinuous.papers.reproduce import Paper

PAPERS: dict[str, Paper] = {paper.name: paper for paper in (QIN2020, HACHEN2025)}
