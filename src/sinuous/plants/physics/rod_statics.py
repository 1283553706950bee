"""Shapes at rest of a bare rod that is clamped at one end, by the forces that MuJoCo computes."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.plants.physics.engine import require_mujoco
from sinuous.plants.physics.rod_links import Link, cubic
from sinuous.plants.physics.rod_tangent import PointLoads, load_stiffness
from sinuous.robots.rod_mechanics import RoundRod

REST = 1e-9  # largest moment left, by that which bends the rod to a circle of radius L
LARGEST_TURN = 0.2  # of a hinge in one step [rad]
ITERATIONS = 40  # of Newton's method at a load
FIRST_SHARE = 0.25  # of the load
LEAST_SHARE = 1e-3  # by which it is raised before the search is given up
CAREFUL = 0.02  # share that is raised at a time where a rod is about to buckle


@dataclass(frozen=True, kw_only=True, eq=False)
class Load:
    """What acts on a rod, in the world: the rod is clamped along z.

    Arguments:
        gravity: (3,) [m/s^2]
        forces, moments: at mid-length and at the tip (2, 3) [N], [N m]
    """

    gravity: Array
    forces: Array = field(default_factory=lambda: np.zeros((2, 3)))
    moments: Array = field(default_factory=lambda: np.zeros((2, 3)))

    def scaled(self, share: float) -> "Load":
        """A share of all of it."""
        return Load(
            gravity=share * self.gravity, forces=share * self.forces, moments=share * self.moments
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Equilibrium:
    """A shape at rest, or where the search for one ended.

    Arguments:
        angles: of all hinges (n,) [rad]
        frames: positions (N + 1, 3) [m] of base and links
        directions: of the rod there (N + 1, 3)
        rest: largest moment left, as a share of E I / L
        converged: whether that is small enough
        iterations: steps of Newton's method in all
    """

    angles: Array
    frames: Array
    directions: Array
    rest: float
    converged: bool
    iterations: int


class BareRod:
    """A rod of links, clamped at the world's origin along z.

    Arguments:
        rod: what it is made of
        length: [m]
        links: in each half
    """

    def __init__(self, rod: RoundRod, *, length: float, links: int) -> None:
        self.rod, self.length, self.links = rod, length, 2 * links
        self._mujoco = require_mujoco()
        self._model = self._build().compile()
        self._data = self._mujoco.MjData(self._model)
        self._body: IntArray = np.asarray(self._model.jnt_bodyid, dtype=np.int64)
        self._loaded = (links, 2 * links)  # bodies at mid-length and at the tip

    @property
    def stretch(self) -> float:
        """Length of what a link stands for [m]."""
        return self.length / self.links

    def at_rest(self, load: Load) -> Equilibrium:
        """The shape into which the straight rod bends while all of the load grows together.

        Where it buckles, a large step leads to a shape that is at rest but would not stay so;
        then smaller ones follow the way that it goes.
        """
        angles, share, raise_by, iterations = np.zeros(self._model.nv), 0.0, FIRST_SHARE, 0
        found = None
        while share < 1.0 and raise_by >= LEAST_SHARE:
            tried = min(1.0, share + raise_by)
            found = self.near(load.scaled(tried), angles)
            iterations += found.iterations
            if found.converged and (raise_by <= CAREFUL or self._stays(load.scaled(tried))):
                angles, share, raise_by = found.angles, tried, 1.5 * raise_by
            else:
                raise_by *= 0.5
        assert found is not None
        return Equilibrium(
            angles=found.angles,
            frames=found.frames,
            directions=found.directions,
            rest=found.rest,
            converged=found.converged and share == 1.0,
            iterations=iterations,
        )

    def near(self, load: Load, angles: Array) -> Equilibrium:
        """The shape at rest to which Newton's method leads from these angles (n,) [rad]."""
        scale = self.rod.bending_stiffness / self.length
        angles, iterations, rest = angles.copy(), 0, np.inf
        while True:
            moments = self._moments(load, angles)
            rest = float(np.max(np.abs(moments))) / scale
            if rest < REST or iterations == ITERATIONS or not np.isfinite(rest):
                break
            turn = np.linalg.solve(self._stiffness(load), moments)
            angles += turn * min(1.0, LARGEST_TURN / float(np.max(np.abs(turn))))
            iterations += 1
        R = self._data.xmat.reshape(-1, 3, 3)
        return Equilibrium(
            angles=angles,
            frames=self._data.xpos.copy(),
            directions=R[:, :, 2].copy(),
            rest=rest,
            converged=rest < REST,
            iterations=iterations,
        )

    def points(self, shape: Equilibrium, arcs: Array) -> Array:
        """Points (K, 3) [m] of a shape at these arc lengths (K,) [m]."""
        cell = np.clip((arcs / self.stretch).astype(np.int64), 0, self.links - 1)
        weights = cubic(arcs / self.stretch - cell)[..., None]
        p, t = shape.frames, self.stretch * shape.directions
        first = weights[0] * p[cell] + weights[1] * t[cell]
        return first + weights[2] * p[cell + 1] + weights[3] * t[cell + 1]

    def angles_of(self, R: Array) -> Array:
        """Angles (n,) [rad] that turn the links as their frames (N + 1, 3, 3) are, nearly."""
        between_frames = np.swapaxes(R[:-1], 1, 2) @ R[1:]
        skew = 0.5 * (between_frames - np.swapaxes(between_frames, 1, 2))
        turns = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1)
        axis = np.argmax(self._model.jnt_axis, axis=1)
        return turns[self._body - 1, axis]

    def _build(self) -> Any:
        spec = self._mujoco.MjSpec()
        body = spec.worldbody
        for number in range(1, self.links + 1):
            link = Link(
                rod=self.rod,
                length=self.stretch,
                reversed=number % 2 == 0,
                twist_length=self.stretch,
                last=number == self.links,
            )
            body = link.add_to(body, f"link {number}")
        return spec

    def _moments(self, load: Load, angles: Array) -> Array:
        """What turns the hinges (n,) [N m]: springs, weight and the load; zero at rest."""
        data = self._data
        self._model.opt.gravity[:] = load.gravity
        data.qpos[:] = angles
        self._mujoco.mj_fwdPosition(self._model, data)
        self._mujoco.mj_fwdVelocity(self._model, data)
        moments = data.qfrc_passive - data.qfrc_bias
        for body, force, moment in zip(self._loaded, load.forces, load.moments, strict=True):
            self._mujoco.mj_applyFT(
                self._model, data, force, moment, data.xpos[body], body, moments
            )
        return moments

    def _stays(self, load: Load) -> bool:
        """Whether the shape that was looked at last takes work to leave, in any direction."""
        K = self._stiffness(load)
        try:
            np.linalg.cholesky(K + K.T)
        except np.linalg.LinAlgError:
            return False
        return True

    def _stiffness(self, load: Load) -> Array:
        """Derivative (n, n) of the moments by the angles, negative."""
        weights = self._model.body_mass[:, None] * load.gravity
        loads = PointLoads(
            body=np.concatenate([np.arange(self._model.nbody), self._loaded]),
            place=np.concatenate([self._data.xipos, self._data.xpos[list(self._loaded)]]),
            force=np.concatenate([weights, load.forces]),
            moment=np.concatenate([np.zeros_like(weights), load.moments]),
        )
        data = self._data
        K = load_stiffness(data.xaxis, data.xanchor, self._body, loads)
        K[np.diag_indices_from(K)] += self._model.jnt_stiffness
        return K
