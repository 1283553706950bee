"""Walls as lazy planes: the body stays inside any mesh, with few rows in the QP.

The distance to one triangle is convex, so its tangent plane never promises more room than
there is.  The distance to a mesh is not: one plane per point misses the other walls (notes
B8).  So the rows start from each point's nearest triangle, the solution is checked against
the whole mesh, and the triangles it violates join as planes taken at the old point.
"""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import kernel
from sinuous.control.shape import TOLERANCE, Contacts, Cuts
from sinuous.control.stage import Stage
from sinuous.geometry import bvh
from sinuous.geometry.bvh import ZoneArrays

# Points this close to where they must stop get a plane from the start [m]; all others get
# one when a solution violates it.
NEAR = 0.002

# Planes of one stage that join at a time, the tightest first. What is left out joins when a
# solution violates it; without a bound a body deep in the wall would stall the solver.
MOST = 24

# Walls that yield less than this per unit of every coordinate cannot be steered away from.
IMMOVABLE = 1e-6


@dataclass(frozen=True, kw_only=True)
class Walls:
    """Clearance of the body (18), for the whole surface and not only at the disks.

    Arguments:
        required: distance the guarded points keep (S,) [m], from `Robot.required_distance`
        movable: which of them any motion can move (S,); a fixed base is not
        reserve: what plans keep on top, so that the safety filter has room [m]
    """

    required: Array
    movable: BoolArray
    reserve: float

    def slack(self, stage: Stage) -> Array:
        return (stage.walls.clearance - self.required)[self.movable]

    def least_between(self, a: Stage, b: Stage, bow: Array) -> float:
        # Clearance changes no faster than the point moves: at x on the chord it is at least
        # what a has less |x - a| and what b has less |b - x|, so the mean of both.
        chord = np.linalg.norm(b.points - a.points, axis=1)
        both = a.walls.clearance + b.walls.clearance - 2.0 * self.required
        return float(np.min((0.5 * (both - chord) - bow)[self.movable], initial=np.inf))

    def cuts(self, stage: Stage, contacts: Contacts) -> Cuts:
        limit = self.required + self.reserve + NEAR
        near = np.flatnonzero(self.movable & (stage.walls.clearance < limit))
        other = contacts.triangle != stage.walls.triangle[contacts.source]
        points = np.concatenate([near, contacts.source[other]])
        return self._planes(
            stage, points, np.concatenate([stage.walls.triangle[near], contacts.triangle[other]])
        )

    def violated(self, stage: Stage, found: Stage) -> Cuts:
        limit = self.required + self.reserve - TOLERANCE
        beyond = np.flatnonzero(self.movable & (found.walls.clearance < limit))
        planes = self._planes(stage, beyond, found.walls.triangle[beyond])
        linear = planes.slack + planes.jacobian @ (found.c - stage.c)
        exact = (found.walls.clearance - self.required)[planes.source] - self.reserve
        return planes.lowered(np.maximum(linear - exact, 0.0))

    def describe(self, stage: Stage, source: int, triangle: int) -> str:
        wall = stage.zone.describe_triangle(triangle)
        return f"{wall} at {stage.robot.point_name(source)}"

    def _planes(self, stage: Stage, points: IntArray, triangles: IntArray) -> Cuts:
        if not len(points):
            return Cuts.none(len(stage.c))
        near = stage.walls
        count = len(points)
        A, slack = np.empty((count, len(stage.c))), np.empty(count)
        normal = np.empty((count, 3))
        inside = near.clearance[points] >= 0.0
        own = triangles == near.triangle[points]
        fill(stage.zone.arrays, stage.points, stage.jacobian, points, triangles, inside, A, slack,
             normal)  # fmt: skip
        # The nearest triangle of a point carries the sign and gradient of the zone itself.
        normal[own], slack[own] = near.gradient[points[own]], near.clearance[points[own]]
        A[own] = np.einsum("ki,kin->kn", normal[own], stage.jacobian[points[own]])
        slack -= self.required[points] + self.reserve
        rows = Cuts(jacobian=A, slack=slack, source=points, triangle=triangles, normal=normal)
        # From outside, only the nearest wall shows the way back in.
        useful = np.flatnonzero((inside | own) & np.any(np.abs(A) > IMMOVABLE, axis=1))
        return rows.only(useful[np.argsort(slack[useful], kind="stable")[:MOST]])


@kernel
def fill(
    zone: ZoneArrays,
    body: Array,
    jacobian: Array,
    points: IntArray,
    triangles: IntArray,
    inside: BoolArray,
    A: Array,
    distance: Array,
    normal: Array,
) -> None:
    """Planes of given triangles seen from given body points: A (m, n), distance and normal."""
    for k in range(points.size):
        p = points[k]
        d, x, y, z = bvh.plane(zone, triangles[k], body[p], inside[k])
        distance[k] = d
        normal[k, 0], normal[k, 1], normal[k, 2] = x, y, z
        for j in range(A.shape[1]):
            A[k, j] = x * jacobian[p, 0, j] + y * jacobian[p, 1, j] + z * jacobian[p, 2, j]
