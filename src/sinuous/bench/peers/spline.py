"""The clearance as a smooth function that CasADi can differentiate and compile.

A uniform cubic B-spline on a grid: C2, no callbacks. CasADi's own spline evaluates each
derivative anew, so the compiled version reads the 64 coefficients of a cell once and gives
value, gradient and Hessian together, about ten times faster; both agree to rounding.
"""

from dataclasses import dataclass
from itertools import product
from typing import Self

import casadi as ca
import numpy as np
from scipy.ndimage import spline_filter

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import SafeZone

PAD = 3  # cells around the mesh
INSIDE = 1e-9  # of a cell, by which its end belongs to the next one

# Weights of the four coefficients next to a fraction t of a cell: value and derivatives.
WEIGHTS = (
    np.array([[1, -3, 3, -1], [4, 0, -6, 3], [1, 3, 3, -3], [0, 0, 0, 1]]) / 6.0,
    np.array([[-1, 2, -1], [0, -4, 3], [1, 2, -3], [0, 0, 1]]) / 2.0,
    np.array([[1, -1], [-2, 3], [1, -3], [0, 1]]) / 1.0,
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Spline:
    """A spline through the clearance at the points of a grid.

    Arguments:
        coefficients: (nx, ny, nz)
        origin: first point of the grid (3,)
        spacing: of the grid; all in one unit of length
    """

    coefficients: Array
    origin: Array
    spacing: float

    @classmethod
    def fit(cls, zone: SafeZone, *, spacing: float, unit: float) -> Self:
        """Fit to a zone.

        Arguments:
            spacing: of the grid [m]
            unit: of length in the peers' problem [m]
        """
        corners = zone.triangles.reshape(-1, 3)
        low = corners.min(axis=0) - PAD * spacing
        counts = np.ceil((corners.max(axis=0) - low) / spacing).astype(int) + PAD + 1
        grid = [low[i] + spacing * np.arange(counts[i]) for i in range(3)]
        values = zone.clearance(np.stack(np.meshgrid(*grid, indexing="ij"), axis=-1)) / unit
        fitted = np.asarray(spline_filter(values, order=3, mode="mirror"), dtype=np.float64)
        return cls(coefficients=fitted, origin=low / unit, spacing=spacing / unit)

    @property
    def flat(self) -> Array:
        """Coefficients with the first index running fastest."""
        return self.coefficients.ravel(order="F")

    def interpreted(self) -> ca.Function:
        """CasADi's own spline: a point (3,) to the clearance. For where no compiler is."""
        knots = [
            (self.origin[i] + self.spacing * (np.arange(count + 4) - 2.0)).tolist()
            for i, count in enumerate(self.coefficients.shape)
        ]
        options = {"lookup_mode": ["exact"] * 3}
        return ca.Function.bspline("wall", knots, self.flat.tolist(), [3, 3, 3], 1, options)

    def cell(self, point: ca.MX) -> tuple[ca.MX, ca.MX]:
        """The 64 coefficients around a point (3,), and where in its cell it lies (3,).

        A point outside the grid counts as the nearest one inside.
        """
        shape = self.coefficients.shape
        place = (point - ca.DM(self.origin)) / self.spacing
        place = ca.fmin(ca.fmax(place, 1.0), ca.DM([n - 2.0 - INSIDE for n in shape]))
        index = ca.floor(place)
        strides = (1, shape[0], shape[0] * shape[1])
        first = ca.dot(index - 1.0, ca.DM(strides))
        steps = [strides[0] * i + strides[1] * j + strides[2] * k for k, j, i in _CUBE]
        return ca.MX(ca.DM(self.flat))[first + ca.DM(steps)], place - index


_CUBE = tuple(product(range(4), repeat=3))


@dataclass(frozen=True, kw_only=True, eq=False)
class Wall:
    """The clearance of points as functions of a point (3,).

    Arguments:
        value: clearance
        first: clearance and its gradient (3,)
        second: gradient (3,) and Hessian (3, 3)
    """

    value: ca.Function
    first: ca.Function
    second: ca.Function

    @classmethod
    def interpreted(cls, spline: Spline) -> Self:
        """By CasADi's spline and its automatic derivatives."""
        point = ca.MX.sym("point", 3)
        value = spline.interpreted()(point)
        hessian, gradient = ca.hessian(value, point)
        return cls(
            value=ca.Function("wall_value", [point], [value]),
            first=ca.Function("wall_first", [point], [value, gradient]),
            second=ca.Function("wall_second", [point], [gradient, hessian]),
        )

    @classmethod
    def local(cls, spline: Spline) -> Self:
        """From the coefficients of a cell; to be compiled, else all of them are copied."""
        point = ca.MX.sym("point", 3)
        near, t = spline.cell(point)
        c, f = ca.SX.sym("c", 64), ca.SX.sym("f", 3)
        value, gradient, hessian = _polynomial(c, f, spline.spacing)

        def function(name: str, outputs: list[ca.SX]) -> ca.Function:
            inner = ca.Function(f"{name}_cell", [c, f], outputs, {"cse": True})
            found = inner(near, t)
            return ca.Function(name, [point], list(found) if len(outputs) > 1 else [found])

        return cls(
            value=function("wall_value", [value]),
            first=function("wall_first", [value, gradient]),
            second=function("wall_second", [gradient, hessian]),
        )


def _polynomial(c: ca.SX, f: ca.SX, spacing: float) -> tuple[ca.SX, ca.SX, ca.SX]:
    """Value, gradient and Hessian of a cell, contracted along x, then y, then z."""
    powers = [[f[axis] ** k for k in range(4)] for axis in range(3)]

    def weights(axis: int, order: int) -> list[ca.SX]:
        table = WEIGHTS[order]
        terms = range(table.shape[1])
        return [sum((float(row[k]) * powers[axis][k] for k in terms), ca.SX(0)) for row in table]

    along_x = [_contract(c, weights(0, order), 16) for order in range(3)]
    along_y = {
        (i, j): _contract(along_x[i], weights(1, j), 4)
        for i, j in product(range(3), repeat=2)
        if i + j <= 2
    }

    def derivative(*orders: int) -> ca.SX:
        i, j, k = orders
        return _contract(along_y[i, j], weights(2, k), 1) / spacing ** (i + j + k)

    unit = np.eye(3, dtype=int)
    gradient = ca.vertcat(*(derivative(*unit[i].tolist()) for i in range(3)))
    rows = [
        ca.horzcat(*(derivative(*(unit[i] + unit[j]).tolist()) for j in range(3))) for i in range(3)
    ]
    return derivative(0, 0, 0), gradient, ca.vertcat(*rows)


def _contract(c: ca.SX, weights: list[ca.SX], rest: int) -> ca.SX:
    """Sum over the index that runs fastest, leaving `rest` numbers."""
    return ca.vertcat(
        *(sum((weights[i] * c[4 * k + i] for i in range(4)), ca.SX(0)) for k in range(rest))
    )
