"""A plant whose shape is not the one that the model says: smooth, and the same every time."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.measurement import Measurement
from sinuous.plants.plant import Truth
from sinuous.robots.cables import cable_rows
from sinuous.robots.centreline import TILT, Bends, Centreline
from sinuous.robots.chain_kernels import ARC
from sinuous.robots.robot import Robot

# Distinguishes the random numbers of a robot's making from others with the same seed.
STREAM = 1


@dataclass(frozen=True, kw_only=True)
class Mismatch:
    """How a robot differs from its model. All at zero (factors at one) is the model itself.

    Arguments:
        pitch_factor: distance of the cables from the backbone, as a multiple of the model's
        cable_angle: by which all cables of a segment sit turned about its axis [rad]
        coupling: share of a segment's bend that the next segment bends too; negative: against it
        unevenness: by how much a segment's base is bent more, and its end less, than its mean
        sag: of the tip under the robot's own weight if it is held straight and level [m]
        gravity: direction of the weight in the world
        base_tilt: of the base, towards its x and y [rad]
        play: dead band between actuator and cable [m]
        slack_bend: bend of a segment at which its cables lose tension, so that it bends no
            further whatever the cables do [rad]
        scatter: spread of `pitch_factor - 1`, `cable_angle`, `coupling` and `unevenness` from
            segment to segment, as a share of the values here; drawn from the plant's seed

    Raises:
        ValueError: if a value makes no sense
    """

    pitch_factor: float = 1.0
    cable_angle: float = 0.0
    coupling: float = 0.0
    unevenness: float = 0.0
    sag: float = 0.0
    gravity: tuple[float, float, float] = (0.0, 0.0, -1.0)
    base_tilt: tuple[float, float] = (0.0, 0.0)
    play: float = 0.0
    slack_bend: float = np.inf
    scatter: float = 0.0

    def __post_init__(self) -> None:
        finite = (self.pitch_factor, self.cable_angle, self.coupling, self.unevenness, self.sag,
                  *self.gravity, *self.base_tilt, self.play, self.scatter)  # fmt: skip
        if not all(np.isfinite(v) for v in finite) or not np.any(self.gravity):
            raise ValueError("a mismatch must be finite, and gravity have a direction")
        if self.pitch_factor <= 0.0 or not self.slack_bend > 0.0:
            raise ValueError("pitch factor and slack bend must be positive")
        if min(self.sag, self.play, self.scatter) < 0.0:
            raise ValueError("sag, play and scatter must be zero or more")

    @classmethod
    def representative(cls) -> "Mismatch":
        """What a carefully built robot of a few segments may have; none of it is printed.

        The tips of the presets stray by 4 to 5 mm in the median of random poses, by 8 mm in one
        of twenty.
        """
        return cls(
            pitch_factor=1.02,
            cable_angle=float(np.deg2rad(1.0)),
            coupling=-0.02,
            unevenness=0.1,
            sag=0.002,
            base_tilt=(float(np.deg2rad(0.3)), float(np.deg2rad(-0.2))),
            play=0.1e-3,
            scatter=0.3,
        )


class MismatchedPlant:
    """Integrates actuator rates exactly, but its cables, segments and base are not the model's.

    The lengths that the cables follow give the model's bend vectors, which are then changed
    segment by segment; the centre line is integrated arc by arc (`robots.centreline`). The
    weight bends it by the moment that it has on the shape without weight, to first order.

    Arguments:
        robot: the model
        seed: of what differs from segment to segment
        mismatch: how the plant differs from the model
        start: configuration (n,) that its actuators start from, by default the robot's home;
            there the cables are in the middle of their play

    Raises:
        ValueError: if the robot bends at joints instead of along segments
    """

    def __init__(
        self,
        robot: Robot,
        *,
        seed: int,
        mismatch: Mismatch | None = None,
        start: ArrayLike | None = None,
    ) -> None:
        self.robot = robot
        self._mismatch = mismatch or Mismatch()
        self._line = Centreline(robot=robot)
        if not self._line.is_smooth:
            raise ValueError("a mismatch is one of bending segments, and this robot has joints")
        self._bent = np.flatnonzero(robot.chain.turns == ARC)
        self._draw(np.random.default_rng((seed, STREAM)))
        self._play = np.zeros(len(robot.actuator_names))
        self._play[cable_rows(robot)] = 0.5 * self._mismatch.play
        self._sag = self._compliance(robot.home)
        self._lengths = robot.lengths(robot.home if start is None else start)
        self._pulled = self._lengths  # what the cables follow, with play
        self.truth = self._look()

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure."""
        self._lengths = self._lengths + dt * np.asarray(rates, dtype=float)
        low, high = self._lengths - self._play, self._lengths + self._play
        self._pulled = np.clip(self._pulled, low, high)
        self.truth = self._look()
        points = self.truth.points
        return Measurement(points=points, tip=points[-1], lengths=self._lengths)

    # --- once ----------------------------------------------------------------------------

    def _draw(self, rng: np.random.Generator) -> None:
        """Values of every bending section (K,): those stated, with their scatter."""
        m, count = self._mismatch, len(self._bent)
        scale = 1.0 + m.scatter * rng.normal(size=(4, count))
        self._factor = 1.0 + (m.pitch_factor - 1.0) * scale[0]
        self._angle = m.cable_angle * scale[1]
        self._coupling = m.coupling * scale[2, 1:]
        self._unevenness = np.zeros(len(self.robot.chain.theta_column))
        self._unevenness[self._bent] = m.unevenness * scale[3]

    def _compliance(self, home: Array) -> float:
        """Weight per length over bending stiffness [1/m^3]: 8 sag / L^4 of a level beam."""
        length = float(np.sum(self._line.section_lengths(home)[self._bent]))
        return 8.0 * self._mismatch.sag / length**4

    # --- every step ----------------------------------------------------------------------

    def _look(self) -> Truth:
        bends = self._loaded(self._weightless(self.robot.configuration(self._pulled)))
        R, p = self._line.frames(bends)
        T_w_t = np.eye(4)
        T_w_t[:3, :3], T_w_t[:3, 3] = R[-1], p[-1]
        return Truth(points=p, T_w_t=T_w_t, lengths=self._lengths, curvature=bends.curvature)

    def _weightless(self, c: Array) -> Bends:
        """The shape by what the cables do."""
        theta, line = self._line.section_bends(c), self._line
        theta[self._bent] = self._bend(theta[self._bent])
        lengths = line.section_lengths(c)
        curvature = line.curvature(theta, lengths)
        uneven = 1.0 + self._unevenness[line.section] * (1.0 - 2.0 * line.middle)
        return Bends(
            lengths=lengths[line.section] * line.share,
            curvature=curvature * uneven[:, None],
            tilt=np.array(self._mismatch.base_tilt, dtype=float).reshape(TILT),
        )

    def _bend(self, model: Array) -> Array:
        """Bend vectors (K, 2) [rad] of the segments, given the model's."""
        cos, sin = np.cos(self._angle), np.sin(self._angle)
        x, y = model.T / self._factor
        theta = np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)
        theta[1:] += self._coupling[:, None] * model[:-1]
        bend = np.hypot(theta[:, 0], theta[:, 1])
        return theta * np.minimum(1.0, self._mismatch.slack_bend / np.maximum(bend, 1e-12))[:, None]

    def _loaded(self, bends: Bends) -> Bends:
        """The shape with the bend by the moment of all weight beyond each arc."""
        if self._sag == 0.0:
            return bends
        R, p = self._line.frames(bends)
        middle, h = 0.5 * (p[1:] + p[:-1]), bends.lengths
        beyond = np.cumsum((h[:, None] * middle)[::-1], axis=0)[::-1]
        weight = np.cumsum(h[::-1])[::-1]
        gravity = np.array(self._mismatch.gravity) / np.linalg.norm(self._mismatch.gravity)
        moment = self._sag * np.cross(beyond - weight[:, None] * middle, gravity)
        local = np.einsum("aij,ai->aj", R[:-1], moment)
        own = np.stack([local[:, 1], -local[:, 0]], axis=1) * self._line.bends[:, None]
        return Bends(lengths=h, curvature=bends.curvature + own, tilt=bends.tilt)
