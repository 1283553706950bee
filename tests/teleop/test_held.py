"""Walls that a controller knows of, as planes at the tip."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop.held import HeldForce, NearForce
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.motion import Motion, Plane

ROUNDING = 1e-12
STIFFNESS = 80.0
SPACE = Mapping.space(scale=2.0, origin=[0.01, -0.02, 0.1])
PLANE = Mapping.plane(scale=1.0, y0=0.3)
VECTOR = st.tuples(*[st.floats(-0.1, 0.1)] * 3)
ZERO = np.zeros(3)


def held(target: Array, way: Array) -> Plane:
    return Plane(target + way, way)


def at_rest(X_sd: Array, plane: Plane) -> Motion:
    zero = np.zeros(X_sd.size)
    return Motion(X_sd, zero, zero, zero, held=plane)


@given(x=VECTOR, way=VECTOR)
def test_at_the_target_it_is_a_spring_along_the_way(x: Array, way: Array) -> None:
    X, w = np.array(x), np.array(way)
    law = HeldForce(mapping=SPACE, stiffness=STIFFNESS, damping=0.0)
    # The hand is pushed along the way: the reaction that opposes its motion is the other way round.
    force = law.force(at_rest(X, held(SPACE.place(X), w)))
    np.testing.assert_allclose(force, -STIFFNESS * w, atol=1e-11)


@given(x=VECTOR, way=VECTOR, moved=VECTOR)
def test_between_steps_it_is_the_energy_of_a_spring(x: Array, way: Array, moved: Array) -> None:
    """The force is the gradient of 1/2 K depth^2, and never pulls towards the wall."""
    X, w, d = np.array(x), np.array(way), np.array(moved)
    law = HeldForce(mapping=SPACE, stiffness=STIFFNESS, damping=0.0)
    plane = held(SPACE.place(X), w)
    h, size = 1e-6, float(np.linalg.norm(w))

    def energy(at: Array) -> float:
        depth = max(float(w @ (plane.place - SPACE.place(at))) / size, 0.0) if size > 0.0 else 0.0
        return 0.5 * STIFFNESS * depth**2

    slopes = [(energy(X + d + h * e) - energy(X + d - h * e)) / (2 * h) for e in np.eye(3)]
    force = law.force(at_rest(X + d, plane))
    np.testing.assert_allclose(force, slopes, atol=1e-4)
    assert force @ w <= ROUNDING


def test_damping_acts_into_the_wall_only_and_never_pulls() -> None:
    law = HeldForce(mapping=SPACE, stiffness=STIFFNESS, damping=2.0)
    plane = held(SPACE.place(ZERO), np.array([-0.001, 0.0, 0.0]))
    into, out, along = np.array([0.1, 0, 0]), np.array([-1.0, 0, 0]), np.array([0, 0.1, 0])
    forces = [
        law.force(Motion(ZERO, V, ZERO, ZERO, held=plane))[0] for V in (into, out, along, ZERO)
    ]
    np.testing.assert_allclose(forces, [0.28, 0.0, 0.08, 0.08], atol=ROUNDING)


def test_without_walls_there_is_no_force() -> None:
    for law in (HeldForce(mapping=SPACE), NearForce(mapping=SPACE)):
        motion = Motion(np.ones(3), np.ones(3), ZERO, ZERO)
        assert not np.any(law.force(motion))


def test_a_plane_feels_what_is_along_its_axes() -> None:
    law = HeldForce(mapping=PLANE, stiffness=STIFFNESS, damping=0.0)
    X = np.array([0.02, 0.05])
    force = law.force(at_rest(X, held(PLANE.place(X), np.array([0.001, 0.002, -0.003]))))
    np.testing.assert_allclose(force, [-0.08, 0.24], atol=ROUNDING)


def test_closeness_is_felt_where_the_robot_is() -> None:
    law = NearForce(mapping=SPACE, stiffness=STIFFNESS)
    way = np.array([0.0, 0.0, -0.004])
    near = held(SPACE.place(ZERO), way)
    X_s = np.array([0.0, 0.0, -0.003])  # it has gone back already
    force = law.force(Motion(np.ones(3), ZERO, X_s, ZERO, near=near))
    np.testing.assert_allclose(force, [0.0, 0.0, STIFFNESS * 0.001], atol=ROUNDING)


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
def test_bad_numbers_are_refused(bad: float) -> None:
    with pytest.raises(ValueError, match="stiffness"):
        HeldForce(mapping=SPACE, stiffness=bad)
    with pytest.raises(ValueError, match="damping"):
        HeldForce(mapping=SPACE, damping=bad)
    with pytest.raises(ValueError, match="stiffness"):
        NearForce(mapping=SPACE, stiffness=bad)
