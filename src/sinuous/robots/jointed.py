"""Cable-driven robots of rigid modules on universal joints (paper A, section 2).

The base plate is at the origin and the straight robot along y.  Joint i, whose centre A_i is a
plate offset D beyond the plate before it, turns what follows by R_i = Rot(e1, q1) Rot(e2, q2) about
two axes of Z and X; then come the tube of module i, of length H between its two endplates, and
the next joint.  So A_1 = D y and A_(i+1) = A_i + L d_i with L = H + 2 D and d_i the direction y
after the turns of the joints 1 to i.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from math import atan2, hypot
from typing import ClassVar

import numpy as np

from sinuous.arrays import Array, ArrayLike, IntArray
from sinuous.robots import jointed_kernels, routing
from sinuous.robots.bending import BendLimits
from sinuous.robots.body import Section
from sinuous.robots.chain_robot import ChainRobot, flat_rows, unflat
from sinuous.robots.jointed_cables import hole_angles, hole_offsets, route
from sinuous.robots.jointed_kernels import CABLES
from sinuous.robots.mechanics import JointedMechanics
from sinuous.robots.parts import JointOrder
from sinuous.robots.routing import Routing

UNIT = np.eye(3)
SECTIONS = 5  # of a module: two halves of its joint, between them its two hinges, and its tube
# By how much a limit may exceed the bend at which plates touch: rounding of its decimals [rad].
ROUNDING = 1e-9


def contact_bend(radius: float, plate_offset: float) -> float:
    """Bend of a joint at which its plates touch: 2 atan(D / R) [rad] (notes A, symbols)."""
    return 2.0 * atan2(plate_offset, radius)


@dataclass(frozen=True, kw_only=True, eq=False)
class JointedRobot(ChainRobot):
    """Any number of modules, with an optional stage and tool.

    Coordinates (n,): [insertion], then per joint its two angles in order of rotation [rad].
    Actuators (P,): [insertion], then per module its three cables [m], counted from the base
    plate (7).

    Arguments:
        joints: N, as many as there are modules
        holes: M, evenly spaced in every plate
        radius: R of the tubes and of the circle of holes [m]
        plate_offset: D, from a plate to the centre of the joint beside it [m]
        tube_length: H [m]
        orders: in which each joint turns (N,)
        bend_limit: largest angle between the two links at a joint [rad]
        cable_lengths: shortest and longest cables of each module (N,) [m]; by default only the
            bend limits bound them
        mechanics: what makes it move if physics does; kinematics and controllers do not read it

    Raises:
        ValueError: if the numbers do not make a robot
    """

    AXIS: ClassVar[tuple[float, float, float]] = (0.0, 1.0, 0.0)

    joints: int
    holes: int
    radius: float
    plate_offset: float
    tube_length: float
    orders: tuple[JointOrder, ...]
    bend_limit: float
    cable_lengths: tuple[tuple[float, float], ...] = ()
    mechanics: JointedMechanics = field(default_factory=JointedMechanics)

    def __post_init__(self) -> None:
        for name in ("radius", "plate_offset", "tube_length"):
            value = getattr(self, name)
            if not 0.0 < value < np.inf:
                raise ValueError(f"{name} must be a positive length, not {value}")
        if self.joints < 1:
            raise ValueError(f"a robot needs a joint or more, not {self.joints}")
        if self.holes % CABLES or self.holes < CABLES * self.joints:
            raise ValueError(
                f"holes must be a multiple of {CABLES} and at least {CABLES * self.joints}, so "
                f"that no two cables share one, not {self.holes}"
            )
        contact = contact_bend(self.radius, self.plate_offset)
        if not 0.0 < self.bend_limit <= contact + ROUNDING:
            raise ValueError(
                f"bend_limit must be above 0 and at most {contact:.6g}, where plates touch, "
                f"not {self.bend_limit}"
            )
        if len(self.orders) != self.joints:
            raise ValueError(f"{self.joints} joints have as many orders, not {len(self.orders)}")
        if len(self.cable_lengths) not in (0, self.joints):
            raise ValueError(f"cable_lengths must be none or one pair for each of {self.joints}")

    @property
    def link_length(self) -> float:
        """L, from one joint to the next [m]."""
        return self.tube_length + 2.0 * self.plate_offset

    # --- coordinates and actuators -------------------------------------------------------

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """Names of the coordinates (n,)."""
        angles = [f"joint {i} {a}" for i, o in enumerate(self.orders, 1) for a in o.angles]
        return (*self._stage_names, *angles)

    @property
    def actuator_names(self) -> tuple[str, ...]:
        """Names of the actuators (P,)."""
        cables = [(k, j) for k in range(1, self.joints + 1) for j in range(1, CABLES + 1)]
        return (*self._stage_names, *(f"module {k} cable {j}" for k, j in cables))

    @property
    def bend_names(self) -> tuple[str, ...]:
        """Names of the bend limits (J,)."""
        return tuple(f"joint {i} bend" for i in range(1, self.joints + 1))

    @property
    def _stage_names(self) -> tuple[str, ...]:
        return ("insertion",) if self.insertion else ()

    @property
    def home(self) -> Array:
        """Configuration (n,) to start from: straight."""
        stage = [self.insertion.home] if self.insertion else []
        return np.array([*stage, *[0.0] * (2 * self.joints)])

    @cached_property
    def columns(self) -> IntArray:
        """Column of the first angle of every joint (N,)."""
        return len(self._stage_names) + 2 * np.arange(self.joints)

    @property
    def rate_limits(self) -> Array:
        """Slowest and fastest actuator rates [m/s] (P, 2)."""
        stage = [self.speed.insertion] if self.insertion else []
        fastest = np.array([*stage, *[self.speed.cable] * (CABLES * self.joints)])
        return np.stack([-fastest, fastest], axis=1)

    @property
    def length_limits(self) -> Array:
        """Shortest and longest actuator lengths [m] (P, 2), infinite where none is stated."""
        stage = [self.insertion.travel] if self.insertion else []
        cables = self.cable_lengths or ((-np.inf, np.inf),) * self.joints
        return np.array([*stage, *(pair for pair in cables for _ in range(CABLES))])

    @property
    def coordinate_limits(self) -> Array:
        """Limits of the coordinates (n, 2): none that bends or lengths do not imply."""
        return np.tile([-np.inf, np.inf], (len(self.coordinate_names), 1))

    # --- cables --------------------------------------------------------------------------

    @property
    def routing(self) -> Routing:
        """The cables as plain arrays."""
        return self._routing

    @cached_property
    def _routing(self) -> Routing:
        return route(
            holes=hole_offsets(hole_angles(self.joints, self.holes), self.radius),
            plate_offset=self.plate_offset,
            tube_length=self.tube_length,
            orders=self.orders,
            first_column=len(self._stage_names),
        )

    def lengths(self, c: ArrayLike) -> Array:
        """Actuator lengths (..., P) [m] of configurations (..., n) (5)-(7)."""
        flat, shape = flat_rows(c)
        out = np.empty((len(flat), len(self.routing.b)))
        routing.lengths_batch(self.routing, flat, out)
        return unflat(out, shape)

    def lengths_jacobian(self, c: ArrayLike) -> Array:
        """Their derivative (P, n) at one configuration (n,), analytic."""
        value = np.ascontiguousarray(c, dtype=float)
        out = np.empty((len(self.routing.b), len(value)))
        routing.jacobian(self.routing, value, out)
        return out

    def configuration(self, lengths: ArrayLike) -> Array:
        """Configuration (..., n) of actuator lengths (..., P) (8), by least squares.

        What no configuration explains is left over: see `consistency`.
        """
        return self._solve(lengths)[0]

    def consistency(self, lengths: ArrayLike) -> Array:
        """How far every module's cables (..., P) are from agreeing with each other (..., N) [m].

        The root mean square of what `configuration` leaves over: three cables measure two angles.
        """
        return self._solve(lengths)[1]

    def _solve(self, lengths: ArrayLike) -> tuple[Array, Array]:
        flat, shape = flat_rows(lengths)
        c = np.empty((len(flat), self._routing.A.shape[1]))
        residual = np.empty((len(flat), self.joints))
        jointed_kernels.configurations(self._routing, flat, c, residual)
        return unflat(c, shape), unflat(residual, shape)

    # --- body ----------------------------------------------------------------------------

    def _links(self) -> Iterator[Section]:
        # Halfway between two plates a cable on the inner side of a bend b is R cos^2(b/2) +
        # D sin(b/2) cos(b/2) from the link's axis: at most this, whatever b and the twist, as
        # both its holes are hypot(R, D) from the joint.
        bowed = 0.5 * (self.radius + hypot(self.radius, self.plate_offset))
        half = self.plate_offset
        for i, order in enumerate(self.orders, 1):
            yield self._straight(f"the near half of joint {i}", half, bowed)
            column = int(self.columns[i - 1])
            for angle, axis, name in zip(
                (column, column + 1), order.axes, order.angles, strict=True
            ):
                x, y, z = UNIT[axis]
                yield Section(name=f"joint {i} {name}", longest=0.0, radius=bowed, theta=angle,
                              hinge=True, direction=(x, y, z))  # fmt: skip
            yield self._straight(f"the far half of joint {i}", half, bowed, disks=1)
            yield self._straight(f"module {i}", self.tube_length, self.radius, disks=1, tube=True)

    def _straight(
        self, name: str, length: float, radius: float, *, disks: int = 0, tube: bool = False
    ) -> Section:
        return Section(
            name=name, longest=length, radius=radius, disks=disks, tube=tube, direction=self.AXIS
        )

    def module_poses(self, c: ArrayLike) -> Array:
        """Poses (..., N, 4, 4) in the world of the rear endplates, from base to tip (9)."""
        return self._poses(c, self._module_ends)

    @cached_property
    def _module_ends(self) -> IntArray:
        return len(self._stage_names) + SECTIONS * np.arange(1, self.joints + 1)

    # --- bend limits ---------------------------------------------------------------------

    @property
    def bend_limits(self) -> BendLimits:
        """Largest bends of the joints, in cable travel."""
        return self._bend_limits

    @cached_property
    def _bend_limits(self) -> BendLimits:
        return BendLimits(
            column=self.columns,
            is_joint=np.ones(self.joints, dtype=np.bool_),
            slope=np.zeros((self.joints, len(self.coordinate_names))),
            offset=np.full(self.joints, self.bend_limit),
            pitch=np.full(self.joints, self.radius),
        )
