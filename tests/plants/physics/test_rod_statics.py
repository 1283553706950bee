"""Bare rods at rest: beams in closed form, the elastica, the order of convergence."""

from typing import Any

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.plants.physics import rod_statics
from sinuous.plants.physics.rod_links import Link
from sinuous.plants.physics.rod_statics import BareRod, Load
from sinuous.robots.rod_mechanics import RoundRod

LENGTH = 0.6
ROD = RoundRod(radius=0.8e-3, youngs_modulus=200e9, poisson=0.33, density=7870.0)
EI, GJ = ROD.bending_stiffness, ROD.torsion_stiffness
NOTHING = np.zeros(3)
EXACT = 1e-9  # what Newton's method leaves, times a few
TANGENT = 1e-8  # central differences with 1e-6 rad of what is of size 1 N m
SMALL = 1e-3  # deflection by the length, up to which a beam is linear to 1e-6
FINE = 5e-4  # of the length: second order with 64 links, times the curvature


def bare(links: int = 32) -> BareRod:
    return BareRod(ROD, length=LENGTH, links=links)


def at_tip(force: Array = NOTHING, moment: Array = NOTHING, gravity: Array = NOTHING) -> Load:
    return Load(
        gravity=gravity,
        forces=np.array([NOTHING, force]),
        moments=np.array([NOTHING, moment]),
    )


def random_load(seed: int = 0) -> Load:
    rng = np.random.default_rng(seed)
    return Load(
        gravity=rng.normal(0.0, 6.0, 3),
        forces=rng.normal(0.0, 0.1, (2, 3)),
        moments=rng.normal(0.0, 0.05, (2, 3)),
    )


def tip(rod: BareRod, load: Load) -> Array:
    found = rod.at_rest(load)
    assert found.converged
    return found.frames[-1]


def test_the_tangent_is_the_derivative_of_the_engines_moments() -> None:
    rod, load = bare(4), random_load()
    q = np.random.default_rng(1).normal(0.0, 0.2, 24)
    rod._moments(load, q)  # pyright: ignore[reportPrivateUsage]
    K = rod._stiffness(load)  # pyright: ignore[reportPrivateUsage]
    for j, step in enumerate(1e-6 * np.eye(24)):
        up, down = (rod._moments(load, q + s) for s in (step, -step))  # pyright: ignore[reportPrivateUsage]
        np.testing.assert_allclose(K[:, j], (down - up) / 2e-6, rtol=0, atol=TANGENT)


def test_a_moment_bends_it_to_an_arc() -> None:
    """The angle is exact with any number of links, the radius right to second order."""
    bend, errors = 1.5, list[float]()
    for links in (4, 8, 16):
        rod = bare(links)
        found = rod.at_rest(at_tip(moment=np.array([0.0, bend * EI / LENGTH, 0.0])))
        np.testing.assert_allclose(
            found.directions[-1], [np.sin(bend), 0.0, np.cos(bend)], rtol=0, atol=EXACT
        )
        arc = LENGTH / bend * np.array([1.0 - np.cos(bend), 0.0, np.sin(bend)])
        errors.append(float(np.linalg.norm(found.frames[-1] - arc)))
    ratios = np.array(errors[:-1]) / errors[1:]
    np.testing.assert_allclose(ratios, 4.0, rtol=0.05)


def test_a_moment_about_its_axis_twists_it() -> None:
    twist = 0.8
    rod = bare(4)
    found = rod.at_rest(at_tip(moment=np.array([0.0, 0.0, twist * GJ / LENGTH])))
    assert np.sum(found.angles) == pytest.approx(twist, abs=EXACT)
    np.testing.assert_allclose(found.frames[-1], [0.0, 0.0, LENGTH], rtol=0, atol=EXACT)


def test_small_loads_bend_it_as_a_beam() -> None:
    """F L^3 / (3 E I) and w L^4 / (8 E I), by Euler and Bernoulli."""
    force = 3.0 * SMALL * EI / LENGTH**2
    bent = tip(bare(), at_tip(force=np.array([force, 0.0, 0.0])))
    assert bent[0] == pytest.approx(SMALL * LENGTH, rel=1e-3)
    gravity = 8.0 * SMALL * EI / LENGTH**3 / ROD.mass_per_length
    hanging = tip(bare(), at_tip(gravity=np.array([0.0, -gravity, 0.0])))
    assert hanging[1] == pytest.approx(-SMALL * LENGTH, rel=1e-3)


@pytest.mark.parametrize(
    ("load", "across", "along"),
    [(1.0, 0.30172, 0.05643), (10.0, 0.81061, 0.55500)],  # Mattiasson, 1981
)
def test_large_loads_bend_it_as_the_elastica(load: float, across: float, along: float) -> None:
    bent = tip(bare(), at_tip(force=np.array([0.0, load * EI / LENGTH**2, 0.0]))) / LENGTH
    np.testing.assert_allclose(bent, [0.0, across, 1.0 - along], rtol=0, atol=FINE)


def order(load: Load) -> float:
    coarse, fine, finest = (tip(bare(links), load) for links in (8, 16, 32))
    return float(np.log2(np.linalg.norm(coarse - fine) / np.linalg.norm(fine - finest)))


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_it_converges_to_second_order_in_space(seed: int) -> None:
    assert order(random_load(seed)) == pytest.approx(2.0, abs=0.1)


def test_hinges_in_the_same_order_everywhere_are_of_first_order(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Link, "axes", property(lambda _: [0, 1, 2]))
    assert order(random_load()) < 1.5


def test_it_is_the_same_rod_in_all_directions() -> None:
    """Turned about its own axis, loads turn the shape, but for the order of the hinges."""
    c, s = np.cos(0.7), np.sin(0.7)
    R = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    load = random_load()
    turned = Load(gravity=R @ load.gravity, forces=load.forces @ R.T, moments=load.moments @ R.T)
    np.testing.assert_allclose(
        tip(bare(), turned), R @ tip(bare(), load), rtol=0, atol=FINE * LENGTH
    )


def test_points_lie_between_frames_and_at_them() -> None:
    rod = bare(4)
    found = rod.at_rest(random_load())
    cuts = np.linspace(0.0, LENGTH, 9)
    np.testing.assert_allclose(rod.points(found, cuts), found.frames, rtol=0, atol=1e-12)
    fine = bare(32)
    between = np.linspace(0.0, LENGTH, 33)
    exact = fine.points(fine.at_rest(random_load()), between)
    np.testing.assert_allclose(rod.points(found, between), exact, rtol=0, atol=0.02 * LENGTH)


def test_a_search_that_ends_early_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rod_statics, "ITERATIONS", 1)
    assert not bare(4).at_rest(random_load()).converged


@pytest.mark.parametrize(
    ("change", "word"),
    [({"radius": 0.0}, "radius"), ({"youngs_modulus": np.nan}, "youngs_modulus"),
     ({"poisson": 0.6}, "poisson"), ({"density": -1.0}, "density")],
)  # fmt: skip
def test_no_rod(change: dict[str, Any], word: str) -> None:
    good = {"radius": 1e-3, "youngs_modulus": 1e9, "poisson": 0.3, "density": 1000.0}
    with pytest.raises(ValueError, match=word):
        RoundRod(**{**good, **change})
