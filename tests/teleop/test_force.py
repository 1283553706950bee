"""The virtual force (23)-(25): size, direction, and which side of a boundary."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.teleop.boundary import BoxForce, ZoneForce
from sinuous.teleop.ends import FollowerEnd
from sinuous.teleop.force import ErrorForce, ErrorForceAlong, Motion, Together, VirtualForce
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.printed import PrintedForce

from .rigs import BOUNDARY, C2, PLANE

ROUNDING = 1e-12  # [N]
PLACE = st.floats(-0.5, 0.5)
BOX = BoxForce(low=(-BOUNDARY, -BOUNDARY), high=(BOUNDARY, BOUNDARY))


def motion(
    X_sd: object = (0.0, 0.0), X_s: object = (0.0, 0.0), V_s: object = (0.0, 0.0),
    V_sd: object = (0.0, 0.0),
) -> Motion:  # fmt: skip
    """A motion from anything that is a vector."""
    return Motion(*(np.array(v, dtype=float) for v in (X_sd, V_sd, X_s, V_s)))


def test_the_error_force_is_24_with_its_sign_turned_and_a_length() -> None:
    e, k_f, s = np.array([0.013, -0.004]), 3.0, 0.01
    printed = k_f * (1.0 / (1.0 + np.exp(e / s)) - 0.5)
    np.testing.assert_allclose(ErrorForce().force(motion(X_sd=e)), -printed, atol=ROUNDING)


@given(e=st.tuples(st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)))
def test_error_forces_resist_and_are_bounded(e: tuple[float, float]) -> None:
    for force in (ErrorForce().force(motion(X_sd=e)), ErrorForceAlong().force(motion(X_sd=e))):
        assert np.all(np.abs(force) <= 1.5 + ROUNDING)
        assert np.all(np.sign(force) * np.sign(e) >= 0.0)


def test_small_errors_are_felt_as_a_spring() -> None:
    for law in (ErrorForce(gain=3.0, length=0.01), ErrorForceAlong(gain=3.0, length=0.01)):
        force = law.force(motion(X_sd=(1e-5, -2e-5)))
        np.testing.assert_allclose(force, [75e-5, -150e-5], rtol=1e-6)
        np.testing.assert_array_equal(law.force(motion()), [0.0, 0.0])


@given(angle=st.floats(0.0, 6.3), size=st.floats(0.0, 0.5))
def test_along_the_error_no_direction_is_special(angle: float, size: float) -> None:
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    straight = ErrorForceAlong().force(motion(X_sd=(size, 0.0)))
    turned = ErrorForceAlong().force(motion(X_sd=turn @ [size, 0.0]))
    np.testing.assert_allclose(turned, turn @ straight, atol=ROUNDING)
    assert straight[0] == pytest.approx(ErrorForce().force(motion(X_sd=(size, 0.0)))[0])


@given(x=st.tuples(PLACE, PLACE), v=st.tuples(st.floats(-9, 9), st.floats(-9, 9)))
def test_the_box_never_pulls_and_is_the_same_on_both_sides(
    x: tuple[float, float], v: tuple[float, float]
) -> None:
    force = BOX.force(motion(X_s=x, V_s=v))
    beyond = np.abs(x) >= BOUNDARY
    assert np.all(force[~beyond] == 0.0)
    assert np.all(force[beyond] * np.sign(x)[beyond] >= 0.0)
    mirrored = BOX.force(motion(X_s=np.negative(x), V_s=np.negative(v)))
    np.testing.assert_array_equal(mirrored, -force)


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("axis", [0, 1])
def test_spring_and_damper_of_25_resist_on_every_side(axis: int, side: float) -> None:
    x, out, back = (side * size * np.eye(2)[axis] for size in (0.19, 0.2, -0.2))
    at_rest = BOX.force(motion(X_s=x))
    assert side * at_rest[axis] == pytest.approx(0.5)  # 50 N/m by 10 mm
    assert side * BOX.force(motion(X_s=x, V_s=out))[axis] == pytest.approx(0.7)
    assert side * BOX.force(motion(X_s=x, V_s=back))[axis] == pytest.approx(0.3)
    assert BOX.force(motion(X_s=x, V_s=4 * back))[axis] == 0.0  # clamped


def test_a9_the_printed_damper_has_the_wrong_sign_on_the_lower_side_only() -> None:
    """As forces on the hand, -F_b of ours: the printed number differs by twice c_b v below."""
    printed = PrintedForce(low=(-BOUNDARY, -BOUNDARY), high=(BOUNDARY, BOUNDARY))
    v = 0.2
    above = motion(X_sd=(0.19, 0.0), X_s=(0.19, 0.0), V_s=(v, 0.0))
    below = motion(X_sd=(-0.19, 0.0), X_s=(-0.19, 0.0), V_s=(-v, 0.0))
    np.testing.assert_allclose(printed.force(above), -BOX.force(above), atol=ROUNDING)
    difference = printed.force(below)[0] - -BOX.force(below)[0]
    assert difference == pytest.approx(2.0 * 1.0 * -v)
    # Going out, the printed damper pushes out; ours, inward.
    spring_only = motion(X_sd=(-0.19, 0.0), X_s=(-0.19, 0.0))
    assert printed.force(below)[0] - printed.force(spring_only)[0] < 0.0
    assert -BOX.force(below)[0] + BOX.force(spring_only)[0] > 0.0


def test_parts_add_up() -> None:
    m = motion(X_sd=(0.2, 0.0), X_s=(0.19, -0.3), V_s=(0.1, 0.1))
    both = Together((ErrorForce(), BOX)).force(m)
    np.testing.assert_array_equal(both, ErrorForce().force(m) + BOX.force(m))


CUBE = SafeZone.from_mesh(shapes.box((0.2, 0.2, 0.2)))
SPACE = Mapping.space(1.0, origin=(0.0, 0.0, 0.0))
ZONE = ZoneForce(zone=CUBE, mapping=SPACE, distance=0.01)


def at(X_sd: object, V_sd: object = (0.0, 0.0, 0.0)) -> Motion:
    """A desired motion in space, the follower at the origin."""
    return motion(X_sd=X_sd, V_sd=V_sd, X_s=(0.0, 0.0, 0.0), V_s=(0.0, 0.0, 0.0))


def test_a_zone_pushes_back_what_is_desired_beyond_the_margin() -> None:
    np.testing.assert_array_equal(ZONE.force(at((0.0895, 0.0, 0.0))), 0.0)
    for axis in range(3):
        for side in (1.0, -1.0):
            normal = side * np.eye(3)[axis]
            # 20 mm beyond the margin, which is inside the wall's other side.
            np.testing.assert_allclose(ZONE.force(at(0.11 * normal)), normal, atol=1e-9)
            outward = ZONE.force(at(0.11 * normal, 0.3 * normal))
            np.testing.assert_allclose(outward, 1.3 * normal, atol=1e-9)
            inward = ZONE.force(at(0.11 * normal, -3.0 * normal))
            np.testing.assert_allclose(inward, 0.0, atol=1e-9)  # never towards the wall


@given(p=st.tuples(*[st.floats(-0.15, 0.15)] * 3))
def test_the_force_of_a_zone_is_the_slope_of_a_spring_s_energy(
    p: tuple[float, float, float],
) -> None:
    point, step = np.array(p), 1e-6

    def energy(x: Array) -> float:
        """Of a spring from the nearest place in a smaller cube, 10 mm from all walls."""
        return 0.5 * 50.0 * float(np.sum((np.abs(x) - 0.09).clip(0.0) ** 2))

    slope = [
        (energy(point + step * e) - energy(point - step * e)) / (2 * step) for e in np.eye(3)
    ]  # fmt: skip
    np.testing.assert_allclose(ZONE.force(at(point)), slope, atol=1e-4)


@given(
    p=st.tuples(*[st.floats(-0.02, 0.02)] * 2),
    q=st.tuples(*[st.floats(-1e-4, 1e-4)] * 3),
)
def test_the_force_does_not_jump_where_two_walls_are_equally_near(
    p: tuple[float, float], q: tuple[float, float, float]
) -> None:
    """Between the flat facets of a tube the nearest wall switches; the force is a spring's."""
    around = np.linspace(0.0, 0.06, 7)
    tube = shapes.tube(np.stack([0 * around, 0 * around, around], axis=1), 0.018, sections=12)
    force = ZoneForce(zone=SafeZone.from_mesh(tube), mapping=SPACE, distance=0.005)
    here = np.array([*p, 0.03])
    there = here + np.array(q)
    change = np.linalg.norm(force.force(at(there)) - force.force(at(here)))
    assert change <= 50.0 * np.linalg.norm(there - here) + 1e-4


def test_in_a_plane_only_what_is_in_it_is_felt() -> None:
    mapping = Mapping.plane(1.0, y0=0.095)  # beyond the margin of the wall at y = 0.1
    force = ZoneForce(zone=CUBE, mapping=mapping, distance=0.01).force(motion())
    np.testing.assert_allclose(force, [0.0, 0.0], atol=1e-9)


def test_without_walls_there_is_no_force() -> None:
    free = ZoneForce(zone=SafeZone.unbounded(), mapping=SPACE, distance=0.01)
    np.testing.assert_array_equal(free.force(at((1.0, 2.0, 3.0))), 0.0)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ErrorForce(gain=-1.0), "gain"),
        (lambda: ErrorForce(length=0.0), "length"),
        (lambda: ErrorForceAlong(gain=np.nan), "gain"),
        (lambda: ErrorForceAlong(length=np.inf), "length"),
        (lambda: BoxForce(low=(0.1, 0.0), high=(-0.1, 0.1)), "low below high"),
        (lambda: BoxForce(low=(0.1,), high=(0.2, 0.3)), "low below high"),
        (lambda: BoxForce(low=(np.nan,), high=(0.2,)), "low must be"),
        (lambda: BoxForce(low=(0.0,), high=(0.2,), stiffness=-1.0), "stiffness"),
        (lambda: BoxForce(low=(0.0,), high=(0.2,), damping=np.nan), "damping"),
        (lambda: PrintedForce(low=(0.1,), high=(0.0,)), "low below high"),
        (lambda: ZoneForce(zone=CUBE, mapping=SPACE, distance=-1.0), "distance"),
        (lambda: ZoneForce(zone=CUBE, mapping=SPACE, distance=0.0, stiffness=-1.0), "stiffness"),
        (lambda: ZoneForce(zone=CUBE, mapping=SPACE, distance=0.0, damping=-1.0), "damping"),
        (lambda: Together(()), "one part or more"),
    ],
)
def test_forces_that_make_no_sense(make: object, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        make()  # type: ignore[operator]


@pytest.mark.parametrize("force", [BoxForce(low=(0.0,) * 3, high=(1.0,) * 3), ZONE])
def test_a_force_has_the_axes_of_its_end(force: VirtualForce) -> None:
    with pytest.raises(ValueError, match="force must have 2 axes"):
        FollowerEnd(scheme=C2, mapping=PLANE, force=force)
