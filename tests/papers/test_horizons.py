"""Dead ends: the scenes are what they claim, the theory of stuck plans, and the verdicts."""

import copy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.papers.hachen2025.horizons import verdicts
from sinuous.papers.hachen2025.horizons.experiment import HORIZONS_EXPERIMENT, SEED
from sinuous.papers.hachen2025.horizons.runs import drive, guided, settle
from sinuous.papers.hachen2025.horizons.scenes import (
    HOLE,
    HOLE_RADIUS,
    PLATE,
    RADIUS,
    SPARE,
    TARGET,
    THICKNESS,
    DeadEnd,
    map_scene,
    passages,
    plate,
    plate_scene,
    plates,
    posts,
)
from sinuous.papers.workers import Workers

DT = 1 / 30
FACETED = 0.02  # share that 32 corners take from a circle's area, and more
STAYS = 2e-4  # what a stuck tip may still creep [m]: the plan keeps a reserve of 0.05 mm


@pytest.fixture(scope="module")
def scene() -> DeadEnd:
    """The scene of the figures."""
    return plate_scene(PLATE, HOLE, HOLE_RADIUS, TARGET[None])


@pytest.fixture(scope="module")
def quick() -> Any:
    """Data of a short run."""
    return HORIZONS_EXPERIMENT.run(Workers(), True)


def test_plate_is_a_solid_with_one_hole() -> None:
    mesh = plate(PLATE, HOLE, HOLE_RADIUS)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.euler_number == 0  # a torus
    area = np.pi * ((RADIUS + 1e-3) ** 2 - HOLE_RADIUS**2)
    assert mesh.volume == pytest.approx(area * THICKNESS, rel=FACETED)


def test_hole_is_open_and_the_plate_is_not(scene: DeadEnd) -> None:
    through = np.array([*HOLE, PLATE])
    beside = through + [2.0 * HOLE_RADIUS, 0.0, 0.0]
    assert scene.zone.clearance(through) == pytest.approx(HOLE_RADIUS, rel=FACETED)
    assert scene.zone.clearance(beside) < 0.0


@pytest.mark.parametrize("make", [plates, posts, passages])
@pytest.mark.parametrize("number", [0, 1])
def test_scenes_start_safe_repeat_and_leave_room(make: Any, number: int) -> None:
    one, again = make(SEED, number, 3), make(SEED, number, 3)
    assert np.array_equal(one.targets, again.targets)
    assert len(one.targets) == 3
    assert not np.array_equal(one.targets, make(SEED, number + 2, 3).targets)
    assert np.min(one.controller(2, DT).slack(one.start)) >= 0.0
    room = one.zone.clearance(one.targets) - one.robot.radii[-1] - one.margin
    assert np.all(room >= SPARE)


def test_plates_and_map_lie_behind_their_plate() -> None:
    one = plates(SEED, 0, 3)
    assert np.all(one.targets[:, 2] > one.via[0, 2])
    rows = np.array([map_scene(row, 3).targets for row in range(3)])
    assert np.allclose(rows[1, 1, :2], HOLE)  # the middle is over the hole
    assert np.allclose(np.ptp(rows, axis=(0, 1))[:2], np.ptp(rows[0, :, 0]))


def test_long_horizon_arrives_where_a_short_one_is_stuck(scene: DeadEnd) -> None:
    short = drive(scene.controller(2, DT), scene.start, TARGET)
    long = drive(scene.controller(20, DT), scene.start, TARGET)
    assert long.error <= verdicts.REACHED
    assert short.error > 100 * verdicts.REACHED


@pytest.mark.parametrize("horizon", [1, 5, 20])
def test_staying_is_a_plan_of_every_horizon_in_a_dead_end(scene: DeadEnd, horizon: int) -> None:
    """At a local minimum of the tip error among safe shapes no stage gains by moving."""
    stuck = drive(scene.controller(2, DT), scene.start, TARGET)
    again = drive(scene.controller(horizon, DT), stuck.c, TARGET)
    assert again.error == pytest.approx(stuck.error, abs=STAYS)


def test_way_points_prove_that_a_way_exists(scene: DeadEnd) -> None:
    assert guided(scene, TARGET) <= verdicts.REACHED


def test_drive_gives_up_where_the_tip_comes_no_closer(scene: DeadEnd) -> None:
    outside = np.array([0.0, 0.0, 0.5])
    end = drive(scene.controller(2, DT), scene.start, outside)
    assert end.error > 0.3
    assert 0.0 < end.time < 15.0


def test_settling_sees_motion_and_rest(scene: DeadEnd) -> None:
    mpc = scene.controller(2, DT)
    rest = settle(mpc, scene.start, scene.robot.tip(scene.start), 1.5)
    assert rest["error_m"] <= 1e-5
    near = scene.robot.tip(scene.start) + [0.005, 0.0, 0.0]
    moved = settle(mpc, scene.start, near, 3.0)
    assert moved["settled_s"] > rest["settled_s"] or rest["settled_s"] == 0.0
    assert moved["settled_s"] >= DT
    assert moved["error_m"] <= 1e-5


def made_up() -> dict[str, Any]:
    """Data in which N = 5 is best of those that hold 100 Hz, and N = 10 is too slow."""
    horizons = [2, 5, 10]
    return {
        "horizons": horizons,
        "attempts": [
            {
                "rate_hz": 30.0,
                "horizons": horizons,
                "error_m": [0.0, 0.0, 0.0] if k < 40 else [0.04, 0.04, 0.04],
                "guided_error_m": 0.0,
                "from_dead_end_error_m": [] if k < 40 else [0.04, 0.04],
            }
            for k in range(50)
        ],
        "settling": [
            {"family": "posts", "horizon": N, "settled_s": s, "rate_change_at_rest_m_s": 0.0}
            for N, s in zip(horizons, (4.0, 3.0, 2.0), strict=True)
        ],
        "cost": [
            {"horizon": N, "p99_s": s} for N, s in zip(horizons, (1e-3, 2e-3, 2e-2), strict=True)
        ],
    }


def test_counts() -> None:
    data = made_up()
    assert verdicts.reached(data) == {2: 40, 5: 40, 10: 40}
    assert verdicts.guided(data) == (50, 50)
    assert verdicts.escapes(data) == (0, 20)
    data["attempts"][0]["error_m"][1] = 0.01
    data["attempts"][45]["from_dead_end_error_m"] = [0.0, 0.04]
    data["attempts"][3]["guided_error_m"] = 0.01
    assert verdicts.reached(data) == {2: 40, 5: 39, 10: 40}
    assert verdicts.guided(data) == (49, 50)
    assert verdicts.escapes(data) == (1, 20)


def test_recommended_follows_the_data() -> None:
    data = made_up()
    assert verdicts.holds(data) == [2, 5]
    assert verdicts.recommended(data) == 5
    fast = copy.deepcopy(data)
    fast["cost"][2]["p99_s"] = 5e-3  # then N = 10 settles soonest
    assert verdicts.recommended(fast) == 10
    lost = copy.deepcopy(data)
    for row in lost["attempts"][:20]:
        row["error_m"][1] = 0.04  # N = 5 reaches half as many
    assert verdicts.recommended(lost) == 2
    late = copy.deepcopy(data)
    for row in late["cost"]:
        row["p99_s"] = 1.0
    assert verdicts.recommended(late) is None


def test_quick_run_is_plain_data_and_draws(quick: Any, tmp_path: Path) -> None:
    assert {row["family"] for row in quick["settling"]} == {"three posts", "rough passage"}
    assert [row["horizon"] for row in quick["cost"]] == quick["horizons"]
    figures = HORIZONS_EXPERIMENT.draw(quick, tmp_path)
    assert len({figure.name for figure in figures}) == 4
    assert all(figure.stat().st_size > 10_000 for figure in figures)
