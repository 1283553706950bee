"""What every robot offers: one interface, so that no controller knows a robot by name."""

from typing import Protocol, Self

from sinuous.arrays import Array, ArrayLike, BoolArray, IntArray
from sinuous.robots.bending import BendLimits
from sinuous.robots.chain_kernels import Chain
from sinuous.robots.routing import Routing


class Robot(Protocol):
    """A continuum robot as an immutable value; c (..., n) is its configuration.

    Actuator lengths are smooth in c, affine but for the joints that cables cross, and satisfy
    the robot's coupling rules (paper B eq. 19) identically, so the configuration has no equality
    constraints.
    Points and tip are in the world frame, which is the frame of the mesh.
    """

    @property
    def name(self) -> str: ...
    @property
    def T_w_b(self) -> Array:
        """Pose of the base in the world (4, 4)."""
        ...

    @property
    def home(self) -> Array:
        """Configuration (n,) to start from."""
        ...

    @property
    def coordinate_names(self) -> tuple[str, ...]: ...
    @property
    def actuator_names(self) -> tuple[str, ...]: ...
    @property
    def chain(self) -> Chain:
        """The body as plain arrays: what compiled controllers read."""
        ...

    @property
    def radii(self) -> Array:
        """Body radius [m] at every guarded point (S,)."""
        ...

    @property
    def movable(self) -> BoolArray:
        """Which guarded points any actuator can move (S,)."""
        ...

    @property
    def disk_indices(self) -> IntArray:
        """Which of the guarded points are disks (D,)."""
        ...

    @property
    def tubes(self) -> IntArray:
        """First and last guarded point of every rigid tube of the body (T, 2)."""
        ...

    @property
    def rate_limits(self) -> Array:
        """Slowest and fastest actuator rates [m/s] (P, 2)."""
        ...

    @property
    def length_limits(self) -> Array:
        """Shortest and longest actuator lengths [m] (P, 2)."""
        ...

    @property
    def coordinate_limits(self) -> Array:
        """Limits of the coordinates (n, 2) that no actuator's limits imply, else infinite."""
        ...

    @property
    def routing(self) -> Routing:
        """The cables as plain arrays: what compiled controllers read."""
        ...

    @property
    def bend_limits(self) -> BendLimits:
        """How far its segments or joints may be bent."""
        ...

    @property
    def bend_names(self) -> tuple[str, ...]: ...

    def at(self, T_w_b: ArrayLike) -> Self:
        """The same robot with its base at T_w_b (4, 4)."""
        ...

    def sampled(self, spacing: float) -> Self:
        """The same robot with its body guarded every `spacing` [m]."""
        ...

    def points(self, c: ArrayLike) -> Array:
        """Guarded points (..., S, 3) along the body, from base to tip [m]."""
        ...

    def points_jacobian(self, c: ArrayLike) -> Array:
        """Their derivative by c (..., S, 3, n)."""
        ...

    def points_curvature(self, c: ArrayLike, forces: Array) -> Array:
        """Derivative (n, n) of the generalised force sum_s J_s' f_s, with f (S, 3) held."""
        ...

    def point_name(self, index: int) -> str:
        """Where on the body a guarded point lies, in words."""
        ...

    def required_distance(self, margin: float) -> Array:
        """Distance [m] (S,) the guarded points must keep so that the body keeps the margin."""
        ...

    def tip(self, c: ArrayLike) -> Array:
        """Tip position (..., 3) [m]."""
        ...

    def tip_pose(self, c: ArrayLike) -> Array:
        """Tip pose T_w_t (..., 4, 4): the tip's position, oriented like the last disk or plate."""
        ...

    def shape(self, c: ArrayLike) -> tuple[Array, Array]:
        """Points (..., S, 3) and tip pose (..., 4, 4) at once, for what runs at every tick."""
        ...

    def lengths(self, c: ArrayLike) -> Array:
        """Actuator lengths (..., P) [m]."""
        ...

    def lengths_jacobian(self, c: ArrayLike) -> Array:
        """Their derivative (P, n) at one configuration (n,)."""
        ...

    def configuration(self, lengths: ArrayLike) -> Array:
        """Configuration (..., n) that explains actuator lengths (..., P) best."""
        ...

    def bend_slack(self, c: ArrayLike) -> Array:
        """Cable travel left until each bend limit [m] (..., J); negative: bent too far."""
        ...

    def bend_slack_jacobian(self, c: ArrayLike) -> Array:
        """Its derivative by c (J, n)."""
        ...
