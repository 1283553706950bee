"""Experiments on physics: verdicts follow from data, and the short versions of them run."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sinuous.papers.claims import Claim
from sinuous.papers.hachen2025.paper import HACHEN2025
from sinuous.papers.hachen2025.physics import loop, tension
from sinuous.papers.hachen2025.physics.verdicts import VERDICTS as HACHEN
from sinuous.papers.hachen2025.runs import sampled_configurations, sampled_targets, scenario
from sinuous.papers.physics import nothing
from sinuous.papers.qin2020.paper import QIN2020
from sinuous.papers.qin2020.physics.experiment import ON_PHYSICS, PLANTS, encoders, with_play
from sinuous.papers.qin2020.physics.verdicts import VERDICTS as QIN
from sinuous.papers.qin2020.sets.experiment import IMPEDANCE, chain
from sinuous.robots.jointed import JointedRobot
from sinuous.scenario.plants import Physics

Data = dict[str, Any]
NAMED = {claim.name: claim for claim in (*HACHEN, *QIN)}
DATA = ("physics", "hardware_physics", "tension", "sets_physics")


def at_target(controller: str, sensor: str, **changes: Any) -> Data:
    return {
        "controller": controller,
        "sensor": sensor,
        "margin_m": 0.0055,
        "tip_error_at_rest_m": 1e-4 if sensor == loop.NOISE else 1.4e-3,
        "least_nominal_clearance_m": 0.0056,
        "least_actual_clearance_m": 0.003,
        "wall_contacts": 0,
    } | changes


def hardware(test: str, controller: str) -> Data:
    return {
        "test": test,
        "controller": controller,
        "margin_m": 0.0055,
        "nominal_error_at_goals_m": [1e-6],
        "real_error_at_goals_m": [1e-3],
        "nominal_violations": 0,
        "least_tip_room_m": 0.0035,
        "wall_contacts": 0,
    }


def taut(cure: str, error: float, slack: float) -> Data:
    return {
        "controller": tension.ALONE,
        "pretension_m": tension.LOST,
        "cure": cure,
        "tip_error_at_rest_m": error,
        "slack_at_rest_fraction": slack,
    }


def in_set(name: str, plant: str) -> Data:
    sides = [(axis, side) for axis in ("x", "z") for side in (-1.0, 1.0)]
    return {
        "set": name,
        "plant": plant,
        "range_m": [0.2, 0.2],
        "real_tracking_rms_m": 0.005,
        "real_tracking_largest_m": 0.01,
        "tip_unseen_largest_m": 0.001,
        "real_beyond_boundary_m": 0.02,
        "slack_fraction": 0.0,
        "least_tension_n": 10.0,
        "faults": 0,
        "contacts": [{"axis": axis, "side": side} for axis, side in sides],
    }


def as_the_papers_say() -> dict[str, Data]:
    """Data with which everything holds."""
    rows = {
        "physics": [
            *(at_target(name, loop.NOISE) for name in loop.CONTROLLERS),
            at_target(loop.OFFSET_FREE, loop.BIAS),
        ],
        "hardware_physics": [
            hardware(test, name)
            for test in ("goals", "boundary")
            for name in ("MPC + local", "MPC + local, offset-free")
        ],
        "tension": [
            taut(tension.NONE, 0.01, 1.0),
            taut(tension.TOLD, 0.005, 0.0),
            taut(tension.ESTIMATED, 0.005, 0.0),
            taut(tension.MISTAKEN, 0.01, 1.0),
        ],
        "sets_physics": [in_set(name, plant) for name in ("set1", "set2") for plant in PLANTS],
    }
    return {name: {"missing": "", "rows": found} for name, found in rows.items()}


def changed(data: str, key: str, value: Any, **where: Any) -> Callable[[dict[str, Data]], None]:
    def change(found: dict[str, Data]) -> None:
        for row in found[data]["rows"]:
            if all(row[name] == wanted for name, wanted in where.items()):
                row[key] = value

    return change


FLIPS = {
    "physics_converges": changed("physics", "tip_error_at_rest_m", 6e-4, sensor=loop.NOISE),
    "physics_stays_inside": changed("physics", "wall_contacts", 1, controller=loop.OFFSET_FREE),
    "physics_reaches_its_goals": changed("hardware_physics", "nominal_error_at_goals_m", [0.002]),
    "physics_boundary_is_held": changed("hardware_physics", "least_tip_room_m", 0.002),
    "physics_tension_matters": changed("tension", "tip_error_at_rest_m", 0.01, cure=tension.TOLD),
    "physics_follows_closely": changed("sets_physics", "real_tracking_largest_m", 0.03),
    "physics_boundary_is_felt": changed("sets_physics", "contacts", []),
}


def test_every_claim_of_both_papers_can_flip_and_finds_its_data() -> None:
    assert NAMED.keys() == FLIPS.keys()
    for paper, own in ((HACHEN2025, HACHEN), (QIN2020, QIN)):
        assert set(own) <= set(paper.claims)
        assert len({claim.name for claim in paper.claims}) == len(paper.claims)
        names = {one.name for one in paper.experiments}
        assert {need for claim in own for need in claim.needs} <= names


@pytest.mark.parametrize("name", FLIPS)
def test_a_verdict_follows_from_the_data(name: str) -> None:
    data = as_the_papers_say()
    claim: Claim = NAMED[name]
    assert claim.verdict(data).holds is True
    FLIPS[name](data)
    assert claim.verdict(data).holds is False


def test_a_controller_that_leaves_an_error_is_the_one_that_is_named() -> None:
    data = as_the_papers_say()
    changed("physics", "tip_error_at_rest_m", 2e-3, controller="MPC + local")(data)
    verdict = NAMED["physics_converges"].verdict(data)
    assert verdict.holds is False
    assert "MPC + local 2.00 mm" in verdict.measured
    assert f"{loop.OFFSET_FREE} 0.10 mm" in verdict.measured


def test_without_physics_nothing_is_judged_and_the_reason_is_said() -> None:
    data = {name: nothing("it is not installed") for name in DATA}
    for claim in NAMED.values():
        verdict = claim.verdict(data)
        assert verdict.holds is None
        assert verdict.reason == "it is not installed"


def test_targets_can_be_reached_with_the_margin() -> None:
    base = scenario(loop.SCENARIO)
    targets = loop.reachable(base, loop.TARGETS)
    assert targets.shape == (loop.TARGETS, 3)
    room = base.zone.clearance(targets) - base.robot.radii[-1]
    assert np.all(room >= base.mpc.margin)
    assert np.all(np.ptp(targets, axis=0) > 0.04)  # they are all over the chamber


def test_targets_are_the_tips_of_configurations() -> None:
    robot = scenario(loop.SCENARIO).robot
    c = sampled_configurations(robot, 5, 1)
    np.testing.assert_array_equal(sampled_targets(robot, 5, 1), [robot.tip(one) for one in c])


def test_a_lost_pretension_is_the_robots_and_known_only_if_it_is_told() -> None:
    base = scenario(tension.SCENARIO, *tension.FREE)
    for known in (True, False):
        found = tension.pretensioned(base, tension.LOST, known=known)
        assert isinstance(found.plant, Physics)
        assert found.plant.robot.mechanics.cables.pretension == tension.LOST  # pyright: ignore
        believed = found.robot.mechanics.cables.pretension  # pyright: ignore
        assert believed == (tension.LOST if known else tension.KEPT)


def test_encoders_see_the_model_and_the_tip_hangs_below_it() -> None:
    found = with_play(chain("set1", "C2", IMPEDANCE, *ON_PHYSICS, seconds=0.1), 1e-4)
    assert isinstance(found.plant, Physics)
    assert isinstance(found.plant.robot, JointedRobot)
    assert found.plant.robot.mechanics.cables.play == 1e-4
    plant = encoders(found.plant(), 0)
    reading = plant.step(np.zeros(15), 1e-3)
    robot = found.robot
    np.testing.assert_allclose(reading.tip, robot.tip(robot.configuration(reading.lengths)))
    below = plant.truth.T_w_t[2, 3] - reading.tip[2]
    assert -2e-3 < below < -2e-4
