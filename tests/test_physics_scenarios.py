"""Scenarios on physics: margins keep bodies off walls, faults end runs, sensors tell all."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import sinuous as sn
from sinuous.arrays import Array
from sinuous.cli import main
from sinuous.measurement import Measurement
from sinuous.plants.plant import Plant, Truth
from sinuous.scenario.law import Taut
from sinuous.scenario.plants import Physics
from sinuous.session import End, steps

SCENARIOS = Path(__file__).parents[1] / "examples" / "scenarios"
ROD = SCENARIOS / "rod_physics.toml"
SEEN = 1e-3  # tip error that a model without feedback is far above [m]
SHORT = "path.max_steps=45"


def load(name: str, *changes: str) -> sn.Scenario:
    return sn.load_scenario(SCENARIOS / f"{name}.toml", set=changes)


# --- what the examples say --------------------------------------------------------------------


def test_a_rod_robot_learns_what_its_model_is_wrong_by_and_touches_nothing() -> None:
    scenario = load("rod_physics", SHORT)
    first = replace(scenario, path=scenario.path[:1])
    run = sn.run(first)
    physics = run.summary["physics"]
    error = np.linalg.norm(run.recording.actual_tip - run.recording.target, axis=1)
    off = np.linalg.norm(run.recording.actual_tip - run.recording.nominal_tip, axis=1)
    assert error[-1] < SEEN < off[-1]
    assert run.summary["margin_violations"] == physics["wall_contacts"] == 0
    assert physics["penetration_max_m"] == 0.0
    assert run.summary["min_clearance_actual_m"] > 0.0


def test_modules_keep_off_the_walls_of_a_vessel() -> None:
    scenario = load("jointed_physics", "path.max_steps=50")
    run = sn.run(replace(scenario, path=scenario.path[:1]))
    error = np.linalg.norm(run.recording.actual_tip - run.recording.target, axis=1)
    assert error[-1] < SEEN
    assert run.summary["physics"]["wall_contacts"] == 0
    assert run.summary["min_clearance_actual_m"] > 0.0


def test_cables_follow_and_do_not_see_the_weight() -> None:
    """Inverse kinematics and PIDs bring encoders to their place, and the tip hangs below it."""
    scenario = load("cables_physics", "path.max_steps=250", "plant.physics.walls=false")
    run = sn.run(replace(scenario, path=scenario.path[:1]))
    lengths = run.recording.measured_lengths[-1]
    believed = scenario.robot.tip(scenario.robot.configuration(lengths))
    np.testing.assert_allclose(believed, run.recording.target[-1], rtol=0, atol=SEEN)
    sag = run.recording.actual_tip[-1] - believed
    assert sag[2] < -SEEN
    assert abs(sag[0]) < 0.1 * abs(sag[2])


def test_a_cable_goes_slack_and_a_floor_keeps_it_taut() -> None:
    kept = load("slack", "path.max_steps=60")
    law = kept.law
    assert isinstance(law, Taut)
    lost = replace(kept, law=law.law)
    fractions = [sn.run(one).summary["physics"]["slack_fraction"] for one in (kept, lost)]
    assert fractions[0] == 0.0
    assert fractions[1] > 0.3


# --- what a margin is for ---------------------------------------------------------------------


def test_a_body_pushed_into_a_wall_says_so() -> None:
    """Without feedback and margin the load bends the robot into the wall that it goes along."""
    scenario = load(
        "rod_physics",
        "mpc.margin_mm=0",
        "plant.physics.tip_force_n=[1, 0, 0]",
        "control.offset_free.when=never",
        "path.waypoints_mm=[[45, 0, 150]]",
        SHORT,
    )
    physics = sn.run(scenario).summary["physics"]
    assert physics["wall_contacts"] > 0
    assert physics["contact_force_max_n"] > 0.05
    assert 0.0 < physics["penetration_max_m"] < 1e-3


# --- the controller sees what sensors yield ---------------------------------------------------


class Liar:
    """Measures like the physics plant; its truth is anything."""

    def __init__(self, plant: Plant, lie: float) -> None:
        self._plant, self._lie = plant, lie

    @property
    def truth(self) -> Truth:
        truth = self._plant.truth
        return replace(
            truth,
            points=truth.points + self._lie,
            lengths=truth.lengths + self._lie,
            tensions=truth.tensions * (1.0 - 10.0 * self._lie),
        )

    def step(self, rates: Array, dt: float) -> Measurement:
        return self._plant.step(rates, dt)


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("slack", ()),
        ("cables_physics", ("plant.physics.walls=false",)),
    ],
    ids=["plan with taut cables", "cables"],
)
def test_the_controller_never_sees_the_truth(name: str, changes: tuple[str, ...]) -> None:
    scenario = load(name, *changes, "path.max_steps=10")
    assert isinstance(scenario.plant, Physics)
    make = scenario.plant
    runs = [
        list(steps(replace(scenario, plant=lambda lie=lie: Liar(make(), lie))))
        for lie in (0.0, 0.1)
    ]
    assert len(runs[0]) == len(runs[1]) > 0
    for honest, lying in zip(*runs, strict=True):
        assert np.array_equal(honest.rates, lying.rates)
        assert not np.array_equal(honest.actual_points, lying.actual_points)


def test_a_tracker_yields_no_more_of_a_robot_on_physics_than_its_coil() -> None:
    plant = load("rod_physics", "plant.physics.walls=false").new_plant()
    reading = plant.step(np.zeros(12), 1 / 30)
    assert not reading.has_shape
    assert np.array_equal(reading.lengths, plant.truth.lengths)
    assert len(reading.tensions) == 9
    blind = load(
        "rod_physics", "plant.physics.walls=false", "plant.physics.tension_sensors=false"
    ).new_plant()
    assert not len(blind.step(np.zeros(12), 1 / 30).tensions)


# --- faults -----------------------------------------------------------------------------------


def broken(make: Callable[[], Plant], after: int) -> Callable[[], Plant]:
    """Makes a plant in which a speed is not a number from some step on."""

    class Broken:
        def __init__(self) -> None:
            self._plant, self._left = make(), after

        @property
        def truth(self) -> Truth:
            return self._plant.truth

        def step(self, rates: Array, dt: float) -> Measurement:
            self._left -= 1
            if self._left < 0:
                rates = rates * np.nan
            return self._plant.step(rates, dt)

    return Broken


def test_a_number_that_is_none_ends_the_run_as_failed() -> None:
    scenario = load("slack")
    assert isinstance(scenario.plant, Physics)
    run = sn.run(replace(scenario, plant=broken(scenario.plant, 3)))
    assert run.end is End.PLANT_FAILED
    assert "the physics failed" in run.fault
    assert len(run.recording) == 3
    assert np.all(np.isfinite(run.recording.actual_points))


def test_a_failed_run_has_its_own_exit_code_and_says_why(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    impossible = "plant.physics.tip_force_n=[1e15, 0, 0]"
    code = main(["run", str(SCENARIOS / "slack.toml"), "--out", str(tmp_path), "--set", impossible])
    said = capsys.readouterr().err
    assert code not in (0, 2)
    assert "the plant failed: the physics failed" in said
    assert (tmp_path / "summary.json").is_file()
