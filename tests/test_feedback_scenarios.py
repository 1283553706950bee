"""Scenarios with feedback: which controller runs, what stands in for the robot, what is seen."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import sinuous as sn
from sinuous.arrays import Array
from sinuous.cli import main
from sinuous.control.dls import DampedLeastSquares
from sinuous.control.hierarchical import HierarchicalController
from sinuous.control.local import LocalController
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.offset_free import OffsetFree, When
from sinuous.control.projected import ProjectedTarget
from sinuous.measurement import Measurement
from sinuous.plants.kinematic import KinematicPlant
from sinuous.plants.mismatched import MismatchedPlant
from sinuous.plants.plant import Truth
from sinuous.plants.recorded import RecordedPlant
from sinuous.plants.sensors import Sensor
from sinuous.session import steps

FREE = Path(__file__).parent.parent / "examples" / "scenarios" / "free_space.toml"


def load(*changes: str) -> sn.Scenario:
    return sn.load_scenario(FREE, set=changes)


# --- which controller -------------------------------------------------------------------------


def test_without_a_word_the_plan_is_alone() -> None:
    assert isinstance(load().controller, ShapeConstrainedMPC)


def test_a_table_of_feedback_puts_it_around_the_plan() -> None:
    found = load("control.local.tip_gain_per_s=7", "control.local.share=0.4").controller
    assert isinstance(found, HierarchicalController)
    assert found.local == LocalController(tip_gain=7.0, share=0.4)
    assert found.offset_free == OffsetFree()
    assert found.planner.rate_share == pytest.approx(0.6)
    found = load(
        "control.offset_free.when=always",
        "control.offset_free.time_constant_ms=200",
        "control.offset_free.limit_mm=4",
        "control.local.enabled=false",
    ).controller
    assert isinstance(found, HierarchicalController)
    assert found.local is None
    assert found.offset_free == OffsetFree(time_constant=0.2, limit=0.004, when=When.ALWAYS)


def test_a_sensor_brings_feedback_and_only_the_tip_an_offset() -> None:
    found = load("sensor.kind=tip").controller
    assert isinstance(found, HierarchicalController)
    assert found.offset_free.applies(has_shape=False)
    assert not found.offset_free.applies(has_shape=True)


def test_the_reference_controller_and_the_projection() -> None:
    found = load("control.law=dls", "control.dls.gain=0.3", "control.dls.penalty=2").controller
    assert isinstance(found, DampedLeastSquares)
    assert (found.gain, found.damping, found.penalty) == (0.3, 1.0, 2.0)
    found = load("control.project_target=true").controller
    assert isinstance(found, ProjectedTarget)
    assert isinstance(found.controller, ShapeConstrainedMPC)
    found = load("control.law=dls", "control.project_target=true").controller
    assert isinstance(found, ProjectedTarget)
    assert isinstance(found.controller, DampedLeastSquares)


# --- what stands in for the robot, and what is seen -------------------------------------------


def test_a_mismatch_and_its_seed() -> None:
    base = load("plant.mismatch.pitch_factor=1.05", "plant.mismatch.scatter=0.5")
    assert isinstance(base.new_plant(), MismatchedPlant)
    still, bent = np.zeros(12), 0.003 * np.array([-1.0, 0.5, 0.5, 0.0] * 3)
    assert base.mpc.robot.name == "hachen2025"

    def tip(scenario: sn.Scenario) -> Array:
        plant = scenario.new_plant()
        plant.step(bent, 1.0)
        return plant.step(still, 1.0).tip

    assert np.array_equal(tip(base), tip(base))
    assert not np.array_equal(tip(base), tip(replace(base, seed=1)))


@pytest.mark.parametrize("kind", ["tip", "shape", "fibre"])
def test_sensors_wrap_whatever_plant_there_is(kind: str) -> None:
    for plant in ("plant.mismatch.sag_mm=1", "plant.disturbance.length_std_mm=0.1"):
        scenario = load(f"sensor.kind={kind}", "sensor.rate_hz=10", "sensor.delay_ms=50", plant)
        found = scenario.new_plant()
        assert isinstance(found, Sensor)
        seen = [found.step(np.zeros(12), 1 / 30) for _ in range(6)]
        assert [reading.has_shape for reading in seen] == [kind != "tip"] * 6
        assert max(reading.age for reading in seen) >= 0.1


def test_what_a_tracker_yields() -> None:
    scenario = load("sensor.kind=tip", "sensor.coil_mm=[0,0,10]", "sensor.bias_mm=1")
    plant = scenario.new_plant()
    reading = plant.step(np.zeros(12), 1 / 30)
    coil = plant.truth.T_w_t @ np.array([0.0, 0.0, 0.01, 1.0])
    assert np.linalg.norm(reading.tip - coil[:3]) == pytest.approx(0.001)
    np.testing.assert_array_equal(reading.coil, [0.0, 0.0, 0.01])


def test_a_record_is_played_back_and_starts_the_plan_where_it_starts(tmp_path: Path) -> None:
    robot = load().robot
    names = [f"{name.replace(' ', '_')}_mm" for name in robot.actuator_names]
    rows = [f"t_s,x_mm,y_mm,z_mm,{','.join(names)}"]
    for k in range(30):
        c = robot.home + 0.01 * k * np.array([1.0, 0, 0, 0, 0, 0, 0, 0, 0])
        values = [*(1e3 * robot.tip(c)), *(1e3 * robot.lengths(c))]
        rows.append(f"{0.1 * k},{','.join(map(repr, map(float, values)))}")
    (tmp_path / "record.csv").write_text("\n".join(rows) + "\n")
    text = FREE.read_text() + '\n[plant.recorded]\ncsv = "record.csv"\n'
    (tmp_path / "replay.toml").write_text(text)
    scenario = sn.load_scenario(tmp_path / "replay.toml", set=["path.max_steps=60"])
    assert isinstance(scenario.new_plant(), RecordedPlant)
    assert isinstance(scenario.controller, HierarchicalController)
    for law in ("mpc", "dls"):
        run = sn.run(replace(scenario, law=load(f"control.law={law}").law)).recording
        # The robot that was recorded does not hear what the controller says.
        assert np.allclose(run.actual_tip[8], robot.tip(robot.home + [0.03, *np.zeros(8)]))
        assert np.max(np.abs(run.rates)) > 1e-3
    # The copy that a recording holds finds the record from anywhere.
    assert str(tmp_path / "record.csv") in scenario.text


# --- the controller sees what sensors yield ---------------------------------------------------


class Liar:
    """Measures like an exact plant; its truth is anything."""

    def __init__(self, scenario: sn.Scenario, lie: float) -> None:
        self._plant = KinematicPlant(scenario.robot, seed=0)
        self._lie = lie

    @property
    def truth(self) -> Truth:
        truth = self._plant.truth
        return replace(truth, points=truth.points + self._lie, lengths=truth.lengths + self._lie)

    def step(self, rates: Array, dt: float) -> Measurement:
        return self._plant.step(rates, dt)


@pytest.mark.parametrize("law", ["mpc", "dls"])
def test_the_controller_never_sees_the_truth(law: str) -> None:
    feedback = () if law == "dls" else ("control.local.enabled=true",)
    scenario = load(f"control.law={law}", "path.max_steps=40", *feedback)
    runs = [
        list(steps(replace(scenario, plant=lambda lie=lie: Liar(scenario, lie))))
        for lie in (0.0, 0.1)
    ]
    assert len(runs[0]) == len(runs[1])
    for honest, lying in zip(*runs, strict=True):
        assert np.array_equal(honest.rates, lying.rates)
        assert not np.array_equal(honest.actual_points, lying.actual_points)
    # And it does see the measurement.
    plant = replace(scenario, sensor=load("sensor.kind=tip", "sensor.bias_mm=5").sensor)
    other = list(steps(plant))
    assert any(not np.array_equal(a.rates, b.rates) for a, b in zip(runs[0], other, strict=False))


# --- what is wrong with them ------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (["control.law=pid"], ["control.law", '"mpc", "dls" or "geometric_ik"', '"pid"']),
        (["control.law=dls", "control.local.share=0.1"], ["control.law", "mpc"]),
        (["control.local.share=1"], ["control.local.share"]),
        (["control.local.tip_gain=7"], ["tip_gain_per_s"]),
        (["control.local.damping=0"], ["control.local.damping"]),
        (["control.offset_free.when=sometimes"], ["control.offset_free.when", "tip_only"]),
        (["control.dls.gain=2"], ["control.dls.gain"]),
        (["sensor.rate_hz=40"], ["sensor.kind"]),
        (["sensor.kind=smell"], ["sensor.kind", '"smell"']),
        (["sensor.kind=tip", "sensor.rate_hz=0"], ["sensor.rate_hz"]),
        (["sensor.kind=tip", "sensor.noise_mm=-1"], ["sensor.noise_mm"]),
        (["sensor.kind=shape", "sensor.coil_mm=[0,0,1]"], ["sensor.coil_mm", "tip"]),
        (["plant.mismatch.gravity=[0,0,0]"], ["plant.mismatch.gravity"]),
        (["plant.mismatch.pitch_factor=0"], ["plant.mismatch.pitch_factor"]),
        (
            ["plant.mismatch.sag_mm=1", "plant.disturbance.length_std_mm=1"],
            ["plant.mismatch", "one of disturbance, mismatch, recorded, physics and calibrated"],
        ),
        (["plant.calibrated.compensated=true"], ["plant.calibrated", "[fitted]", "hachen2025"]),
        (["plant.physics.payload_g=-1"], ["plant.physics.payload_g"]),
        (
            ["plant.physics.walls=true", "plant.encoder_step_mm=1"],
            ["plant.encoder_step", "physics"],
        ),
        (["control.taut.floor_n=0"], ["control.taut.floor_n"]),
        (["plant.recorded.csv=nowhere.csv"], ["plant.recorded.csv", "nothing at"]),
        (["plant.recorded.csv=free_space.toml"], ["row 1", "t_s"]),
    ],
)
def test_what_is_wrong_is_said_in_the_words_of_the_file(
    changes: list[str], words: list[str]
) -> None:
    with pytest.raises(sn.InputError) as error:
        load(*changes)
    for word in words:
        assert word in str(error.value)


def test_check_says_what_runs_and_what_is_seen(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = FREE.read_text() + '\n[plant.mismatch]\nsag_mm = 2\n[sensor]\nkind = "fibre"\n'
    (tmp_path / "seen.toml").write_text(text)
    assert main(["check", str(tmp_path / "seen.toml")]) == 0
    said = "".join(capsys.readouterr().out.split())
    for words in ("Feedback(", "Mismatch(", "sag=0.002", "ShapeSensing("):
        assert words in said
