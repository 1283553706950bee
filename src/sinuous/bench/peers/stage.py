"""One stage of the peers' program: where the disks are and what limits them."""

from dataclasses import dataclass
from typing import Self

import casadi as ca

from sinuous.arrays import Array
from sinuous.bench.peers.kinematics import disk_positions, scaling, unit
from sinuous.bench.peers.spline import Wall
from sinuous.robots.pcc import PccRobot


@dataclass(frozen=True, kw_only=True, eq=False)
class Stage:
    """The functions of one stage.

    Arguments:
        robot: whose disks are meant
        positions: y to disk centres (3, D)
        tip: y to the last of them (3,)
        tip_first: y to the tip and its Jacobian (3, n)
        first: y to the centres and their Jacobian (3 D, n)
        curvature: y and a force on every disk (3, D) to the Hessian (n, n) of their product
    """

    robot: PccRobot
    positions: ca.Function
    tip: ca.Function
    tip_first: ca.Function
    first: ca.Function
    curvature: ca.Function

    @classmethod
    def of(cls, robot: PccRobot) -> Self:
        """Write down a robot."""
        y = ca.SX.sym("y", len(robot.coordinate_names))
        p = disk_positions(robot, y)
        force = ca.SX.sym("force", *p.shape)
        work = ca.sum1(ca.sum2(p * force))
        plain = {"cse": True}
        return cls(
            robot=robot,
            positions=ca.Function("positions", [y], [p], plain),
            tip=ca.Function("tip", [y], [p[:, -1]], plain),
            tip_first=ca.Function("tip_first", [y], [p[:, -1], ca.jacobian(p[:, -1], y)], plain),
            first=ca.Function("first", [y], [p, ca.jacobian(ca.vec(p), y)], plain),
            curvature=ca.Function("curvature", [y, force], [ca.hessian(work, y)[0]], plain),
        )

    @property
    def disks(self) -> int:
        """How many there are in all."""
        return sum(segment.disks for segment in self.robot.segments)

    @property
    def lengths(self) -> Array:
        """L (P, n): actuator lengths in units of r by y."""
        slope = self.robot.lengths_jacobian(self.robot.home)
        return slope * scaling(self.robot) / unit(self.robot)

    def bend(self, y: ca.MX) -> ca.MX:
        """(kappa gamma)^2 - |theta|^2 (M,), which must not be negative."""
        rows: list[ca.MX] = []
        for j, segment in enumerate(self.robot.segments):
            reach = segment.max_curvature * unit(self.robot) * y[3 * j + 2]
            rows.append(reach**2 - ca.sumsqr(y[3 * j : 3 * j + 2]))
        return ca.vertcat(*rows)

    def limits(self, wall: Wall | None, y: ca.MX) -> ca.MX:
        """Bend and clearance (M + D,); the bend alone where no wall is."""
        if wall is None:
            return self.bend(y)
        return ca.vertcat(self.bend(y), wall.value.map(self.disks)(self.positions(y)).T)

    def limits_first(self, wall: Wall | None, y: ca.MX) -> tuple[ca.MX, ca.MX]:
        """The same and their Jacobian."""
        if wall is None:
            bend = self.bend(y)
            return bend, ca.densify(ca.jacobian(bend, y))
        points, J = self.first(y)
        clearance, gradient = wall.first.map(self.disks)(points)
        rows = [gradient[:, i].T @ J[3 * i : 3 * i + 3, :] for i in range(self.disks)]
        bend = self.bend(y)
        slope = ca.vertcat(ca.densify(ca.jacobian(bend, y)), *rows)
        return ca.vertcat(bend, clearance.T), slope

    def limits_pair(self, wall: Wall, name: str) -> tuple[ca.Function, ca.Function]:
        """Both as functions that CasADi recognises as one and its Jacobian, once compiled."""
        y = ca.MX.sym("y", len(self.robot.coordinate_names))
        value, slope = self.limits_first(wall, y)
        unused = ca.MX.sym("out_h", value.shape[0])
        return (
            ca.Function(name, [y], [self.limits(wall, y)], ["y"], ["h"]),
            ca.Function(f"jac_{name}", [y, unused], [slope], ["y", "out_h"], ["jac_h_y"]),
        )
