"""The stability search: what counts as rest, which targets, and whether it is all plain data."""

import json
from pathlib import Path

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.papers.hachen2025.settling import END, OSCILLATING, end_of
from sinuous.papers.hachen2025.stability.experiment import STABILITY, TARGETS, worst
from sinuous.papers.hachen2025.stability.search import NEAR, settling_time
from sinuous.papers.hachen2025.targets import (
    PUSHED,
    along,
    anywhere,
    at_the_edge,
    beyond,
    inside,
    outside,
)
from sinuous.papers.hachen2025.undisturbed import (
    BEST,
    DT,
    FREE,
    MPC,
    PRINTED,
    STIFF,
    Gains,
    drive,
    held,
    place,
    tips,
)
from sinuous.papers.workers import Workers
from sinuous.plants.kinematic import KinematicPlant

TUBE = "winding_tube"
X = np.array([1.0, 0.0, 0.0])
TIME = DT * np.arange(301)


def straight(values: Array) -> Array:
    """A path (K, 3) on a straight line."""
    return values[:, None] * X


# --- what counts as rest ----------------------------------------------------------------------


def test_a_tip_that_stands_still_rests() -> None:
    end = end_of(straight(np.full(301, 0.1)))
    assert (end.extent, end.path) == (0.0, 0.0)
    assert not end.moving


def test_only_the_end_counts() -> None:
    begun = np.where(TIME[-1] - END - DT > TIME, np.sin(50.0 * TIME), 0.0)
    assert not end_of(straight(begun)).moving


@pytest.mark.parametrize("amplitude", [0.9, 1.1])
def test_an_oscillation_is_one_from_half_a_millimetre_on(amplitude: float) -> None:
    wave = 0.5 * amplitude * OSCILLATING * np.sign(np.sin(40.0 * TIME))
    end = end_of(straight(wave))
    assert end.extent == pytest.approx(amplitude * OSCILLATING)
    assert end.moving == end.to_and_fro == (amplitude > 1.0)


def test_the_diagonal_is_no_less_than_any_axis() -> None:
    wave = 0.8 * 0.5 * OSCILLATING * np.sign(np.sin(40.0 * TIME))
    both = np.stack([wave, wave, 0.0 * wave], axis=1)
    assert end_of(both).extent == pytest.approx(0.8 * OSCILLATING * 2**0.5)
    assert end_of(both).moving  # though no axis covers half a millimetre


def test_creeping_is_moving_but_not_to_and_fro() -> None:
    end = end_of(straight(0.01 * TIME))
    assert end.extent == pytest.approx(end.path) == pytest.approx(0.01 * END)
    assert end.moving
    assert not end.to_and_fro


def test_settling_is_staying() -> None:
    target = np.zeros(3)
    decay = straight(0.05 * np.exp(-2.0 * TIME))
    assert settling_time(decay, target) == pytest.approx(0.5 * np.log(0.05 / NEAR), abs=DT)
    assert settling_time(0.0 * decay, target) == 0.0
    assert settling_time(decay + NEAR * X, target) is None  # does not get there
    back = decay.copy()
    back[200] = 2.0 * NEAR * X  # there, and away once more
    assert settling_time(back, target) == pytest.approx(201 * DT)
    around = straight(0.9 * NEAR * np.sign(np.sin(40.0 * TIME)))
    assert settling_time(around, target) is None  # within reach of it, but never at rest


# --- targets ----------------------------------------------------------------------------------


def test_targets_at_the_edge_are_farther_out_and_those_beyond_farther_still() -> None:
    robot = place(FREE).robot
    sets = [make(robot, 200, np.random.default_rng(1)) for make in (anywhere, at_the_edge, beyond)]
    reach = [float(np.mean(np.linalg.norm(targets, axis=1))) for targets in sets]
    assert reach[0] < reach[2]
    assert reach[1] < reach[2]
    longest = sum(segment.length[1] for segment in robot.segments)
    assert np.max(np.linalg.norm(sets[1], axis=1)) > 0.97 * longest  # straight, at its longest
    assert np.max(np.linalg.norm(sets[0], axis=1)) <= longest
    assert longest < np.max(np.linalg.norm(sets[2], axis=1)) <= PUSHED * longest


def test_targets_in_and_beside_the_tube_are_where_they_should_be() -> None:
    zone, rng = place(TUBE).zone, np.random.default_rng(2)
    clearance = zone.clearance(inside(zone, 0.011, 50, rng))
    assert len(clearance) == 50
    assert np.min(clearance) >= 0.011
    clearance = zone.clearance(outside(zone, 0.01, 0.04, 50, rng))
    assert np.max(clearance) <= -0.01
    assert np.min(clearance) >= -0.04


def test_targets_in_a_passage_are_ahead_of_the_robot() -> None:
    here = place(TUBE)
    base, needed = here.robot.T_w_b[:3, 3], here.robot.required_distance(here.margin)[-1]
    targets = along(here, 40, np.random.default_rng(3))
    assert len(targets) == 40
    assert np.min(here.zone.clearance(targets)) >= needed
    away = np.linalg.norm(targets - base, axis=1)
    assert np.min(away) > np.linalg.norm(here.robot.tip(here.start) - base)


# --- loops ------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", [MPC, BEST])
def test_steps_that_are_not_taken_would_change_nothing(law: str | Gains) -> None:
    here = place(FREE)
    controller, target = here.controller(law), np.array([0.03, 0.01, 0.17])
    way = drive(controller, here.start, held(target, 6.0))
    state = controller.init(here.start)
    for c in way[1:]:
        state, _ = controller.step(state, target)
        np.testing.assert_array_equal(state.c, c)


def test_a_target_that_moves_later_is_followed() -> None:
    here = place(FREE)
    first, last = np.array([0.02, 0.0, 0.18]), np.array([-0.02, 0.0, 0.18])
    targets = np.concatenate([held(first, 5.0), held(last, 5.0)])
    path = tips(here.robot, drive(here.controller(BEST), here.start, targets))
    assert np.linalg.norm(path[150] - first) < 1e-6
    assert np.linalg.norm(path[-1] - last) < 1e-6


def test_an_exact_plant_makes_no_difference() -> None:
    here, target = place(TUBE), np.array([0.045, 0.0, 0.095])
    controller = here.controller(STIFF)
    way = drive(controller, here.start, held(target, 2.0))
    plant = KinematicPlant(here.robot, seed=0, start=here.start)
    state, seen = controller.init(here.start), None
    for _ in range(60):
        state, command = controller.step(state, target, seen)
        seen = plant.step(command.rates, DT)
    np.testing.assert_allclose(plant.truth.points[-1], tips(here.robot, way)[-1], atol=1e-7)


def test_at_the_edge_a_stiff_penalty_goes_to_and_fro_where_the_mpc_rests() -> None:
    """The far end of the winding tube, which the robot barely reaches."""
    here = place(TUBE)
    targets = along(here, 100, np.random.default_rng(2025))
    far = targets[np.argmax(np.linalg.norm(targets - here.robot.T_w_b[:3, 3], axis=1))]
    ends = {
        law: end_of(tips(here.robot, drive(here.controller(law), here.start, held(far, 10.0))))
        for law in (STIFF, MPC)
    }
    assert ends[STIFF].to_and_fro
    assert not ends[MPC].moving


# --- the experiment ---------------------------------------------------------------------------


def test_the_worst_case_turns_back_most() -> None:
    def row(law: str, extent: float, path: float) -> dict[str, object]:
        return {"controller": law, "extent_m": extent, "path_m": path}

    creeping, small, large = row("a", 0.02, 0.02), row("a", 1e-3, 4e-3), row("b", 2e-3, 9e-3)
    rows = [creeping, small, large, row(MPC, 0.1, 1.0)]
    assert worst(rows) is large
    assert worst([creeping, rows[-1]]) is creeping


def test_the_full_search_has_a_thousand_targets_in_free_space() -> None:
    assert sum(count for kind, count in TARGETS.items() if kind != "in the tube") == 1000


def test_a_quick_run_leaves_plain_data_and_figures(tmp_path: Path) -> None:
    data = json.loads(json.dumps(STABILITY.run(Workers(), True)))
    assert data["search"][0].items() >= BEST.plain().items()
    assert {row["gain"] for row in data["search"]} == {PRINTED.gain, BEST.gain}
    mpc = [row for row in data["rows"] if row["controller"] == MPC]
    assert len(mpc) == 12
    assert all(row["extent_m"] < OSCILLATING for row in mpc)
    made = STABILITY.draw(data, tmp_path)
    assert [path.suffix for path in made] == [".png"] * 3
    assert all(path.stat().st_size > 10_000 for path in made)
