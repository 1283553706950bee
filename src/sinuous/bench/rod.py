"""`sinuous bench rod`: shapes at rest of a bare rod beside those of another solver."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import log2
from time import process_time

import numpy as np

from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.machine import machine, versions
from sinuous.bench.result import Column, Result, Row, Table
from sinuous.bench.rod_figure import draw
from sinuous.bench.rod_file import RodFile, read_rod_file
from sinuous.bench.rod_search import OTHER, Found, find
from sinuous.plants.physics.rod_statics import BareRod
from sinuous.robots.rod_mechanics import RoundRod

LINKS = (4, 8, 16, 32)  # in each half
QUICK_LINKS, QUICK_SHAPES = (4, 8, 16), 20
OBSERVED = 100  # shapes between two reports
MS_PER_S = 1e3

COLUMNS = (
    Column(key="links_per_half", title="links per half"),
    Column(key="mean_error_fraction", title="mean error", form=".3%"),
    Column(key="tip_error_fraction", title="at the tip", form=".3%"),
    Column(key="worst_error_fraction", title="worst", form=".3%"),
    Column(key="change_fraction", title="to twice as many", form=".4%"),
    Column(key="order", title="order", form=".2f"),
    Column(key="not_converged", title="not converged"),
    Column(key="other_shape", title="other shape"),
    Column(key="steps_mean", title="steps", form=".1f"),
    Column(key="ms_per_shape", title="ms", form=".1f"),
)
NOTES = (
    "Errors are distances between stations of the same arc length, by the length of the rod: mean "
    "over all stations and shapes, at the last station, and the worst station of all.",
    '"to twice as many": mean distance to the shapes with twice as many links; from two of them '
    'follows the order of convergence. "steps" of Newton\'s method, "ms" of processor time.',
    '"not converged": shapes that were not found; each counts as an error of the whole length.',
    f'"other shape": more than {OTHER:.0%} of the length away, or not found, when the loads grow '
    "on the straight rod; a shape at rest was then looked for beside that of the file, and counts. "
    "A rod may have several.",
)


@dataclass(frozen=True, kw_only=True)
class RodTask:
    """What is compared.

    Arguments:
        path: of the file of shapes
        rod: what the rod is made of
        length: [m]
    """

    path: str
    rod: RoundRod
    length: float

    def benchmark(self) -> Benchmark:
        """As the command line runs it."""
        return Benchmark(run=self.run, draw=draw)

    def run(self, quick: bool, observe: Observe) -> Result:
        """Find every shape of the file, with more and more links."""
        file = read_rod_file(self.path, length=self.length)
        if quick:
            file = RodFile(arcs=file.arcs, shapes=file.shapes[:QUICK_SHAPES])
        links = QUICK_LINKS if quick else LINKS
        rows, found = list[Row](), list[list[Found]]()
        for number, count in enumerate(links):
            started = process_time()
            found.append(self._find_all(file, count, (number, len(links)), observe))
            spent = MS_PER_S * (process_time() - started) / len(file.shapes)
            rows.append({"links_per_half": count, **judge(found[-1]), "ms_per_shape": spent})
        changes = [self._change(*two) for two in pairwise(found)]
        convergence = [{**row, **each} for row, each in zip(rows, orders(changes), strict=True)]
        return Result(
            what="rod",
            tables=(Table(name="convergence", title="at rest", columns=COLUMNS, rows=convergence),),
            about={
                **rows[-1],
                "shapes": len(file.shapes),
                "rows": [shape_row(each) for each in found[-1]],
                "lines": [line_row(file, *each) for each in enumerate(found[-1])],
                "settings": self._settings(),
                "versions": versions(),
                "machine": machine(),
            },
            notes=NOTES,
        )

    def _find_all(
        self, file: RodFile, links: int, part: tuple[int, int], observe: Observe
    ) -> list[Found]:
        bare = BareRod(self.rod, length=self.length, links=links)
        reports = -(-len(file.shapes) // OBSERVED)
        found = list[Found]()
        for number, shape in enumerate(file.shapes):
            if number % OBSERVED == 0:
                done = part[0] * reports + number // OBSERVED
                observe(f"{links} links per half", done, part[1] * reports)
            found.append(find(bare, file.arcs, shape))
        return found

    def _change(self, coarse: Sequence[Found], fine: Sequence[Found]) -> float:
        """Mean distance of the stations, by the length; of shapes found in both cases."""
        distances = [
            np.mean(np.linalg.norm(a.points - b.points, axis=1))
            for a, b in zip(coarse, fine, strict=True)
            if a.converged and b.converged
        ]
        return float(np.mean(distances)) / self.length if distances else np.nan

    def _settings(self) -> Row:
        return {
            "file": self.path,
            "length_m": self.length,
            "radius_m": self.rod.radius,
            "youngs_modulus_pa": self.rod.youngs_modulus,
            "poisson": self.rod.poisson,
            "density_kg_m3": self.rod.density,
        }


def judge(found: Sequence[Found]) -> Row:
    """Errors over all shapes."""
    errors = np.array([each.error for each in found])
    straight = np.array([each.straight_error for each in found])
    return {
        "mean_error_fraction": float(np.mean(errors)),
        "tip_error_fraction": float(np.mean(errors[:, -1])),
        "worst_error_fraction": float(np.max(errors)),
        "straight_mean_error_fraction": float(np.mean(straight)),
        "straight_worst_error_fraction": float(np.max(straight)),
        "not_converged": sum(not each.converged for each in found),
        "other_shape": sum(each.other for each in found),
        "steps_mean": float(np.mean([each.steps for each in found])),
    }


def orders(changes: Sequence[float]) -> list[Row]:
    """Change to the next finer rod and the order that two changes show, for every rod."""
    rows: list[Row] = []
    for change, finer in zip(changes, [*changes[1:], None], strict=True):
        order = log2(change / finer) if finer else None
        rows.append({"change_fraction": change, "order": order})
    return [*rows, {}]


def shape_row(found: Found) -> Row:
    """What is said of one shape."""
    return {
        "shape": found.name,
        "mean_error_fraction": float(np.mean(found.error)),
        "worst_error_fraction": float(np.max(found.error)),
        "tip_error_fraction": float(found.error[-1]),
        "converged": found.converged,
        "other_shape": found.other,
        "steps": found.steps,
    }


def line_row(file: RodFile, number: int, found: Found) -> Row:
    """Both shapes, for the figure."""
    return {
        "shape": found.name,
        "points_m": found.points.tolist(),
        "file_points_m": file.shapes[number].points.tolist(),
    }
