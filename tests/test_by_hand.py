"""Sessions with an operator's hand in place of the path: both kinds of robot, all controllers."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sinuous as sn
from sinuous.cli import main
from sinuous.errors import InputError
from sinuous.files import write_text
from sinuous.plants.plant import PlantFault
from sinuous.scenario import load_scenario
from sinuous.session import steps
from sinuous.session.by_hand import signal_names
from sinuous.view.figures import save_figures

SCENARIOS = Path(__file__).parents[1] / "examples" / "scenarios"
TICK = 1e-3
AT_REST = 1e-5  # what an operator, a plan and a channel leave of a way after seconds [m]
ROUNDING = 1e-12

FREE = """
name = "free"
[robot]
file = "hachen2025"
[mpc]
rate_hz = 50
horizon = 5
[path]
waypoints_mm = [[30, 0, 190]]
max_steps = 150
[teleop]
delay_ms = 100
"""

BY_CABLES = """
name = "cables"
[robot]
file = "qin2020"
[control]
law = "geometric_ik"
[plant]
encoder_step_mm = 0.001
[path]
waypoints_mm = [[0, 617.702, 120], [40, 617.702, 130]]
max_steps = 8000
[teleop]
delay_ms = 50
[teleop.mapping]
space = "plane"
scale = 2.25
"""


def scenario(folder: Path, text: str, *changes: str) -> sn.Scenario:
    path = folder / "scenario.toml"
    write_text(path, text)
    return load_scenario(path, set=changes)


@pytest.fixture(scope="module")
def free(tmp_path_factory: pytest.TempPathFactory) -> sn.Recording:
    return sn.run(scenario(tmp_path_factory.mktemp("free"), FREE)).recording


# --- what happens ---------------------------------------------------------------------------


def test_the_tip_gets_where_the_hand_goes(free: sn.Recording) -> None:
    np.testing.assert_allclose(free.actual_tip[-1], [0.03, 0.0, 0.19], rtol=0, atol=AT_REST)


def test_nothing_arrives_before_the_delay(free: sn.Recording) -> None:
    sent, desired = free.signal("sent_m"), free.signal("desired_m")
    late = round(0.1 / TICK)
    assert np.max(np.abs(sent[late // 2])) > 1e-3
    # The wave that the first motion made is sent one tick after it, and is used a tick later.
    np.testing.assert_array_equal(desired[:late], np.zeros((late, 3)))
    assert np.max(np.abs(desired[late + 10])) > 0.0


def test_every_tick_is_recorded(free: sn.Recording) -> None:
    assert free.header.tick == TICK
    assert free.signals.shape == (20 * len(free), len(signal_names("xyz")))
    np.testing.assert_array_equal(free.signal("tip_m")[0], np.zeros(3))
    assert np.all(free.signal("fault") == 0.0)


def test_the_target_is_what_arrived(free: sn.Recording) -> None:
    """The target of a control step is where the first of its ticks puts the desired point."""
    start = free.header.tick
    assert start == TICK
    first = free.signal("desired_m")[1::20] + [0.0, 0.0, 0.215]
    height = free.target[:, 2] - free.signal("desired_m")[1::20][:, 2]
    np.testing.assert_allclose(height, height[0], rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(free.target[:, :2], first[:, :2], rtol=0, atol=ROUNDING)


def test_energies_are_those_of_the_signals(free: sn.Recording) -> None:
    force, speed = free.signal("virtual_n"), free.signal("desired_m_s")
    follower = np.cumsum(np.sum(force * speed, axis=1)) * TICK
    np.testing.assert_allclose(free.signal("follower_j"), follower, rtol=0, atol=ROUNDING)
    leader = np.cumsum(np.sum(free.signal("felt_n") * free.signal("sent_m_s"), axis=1)) * TICK
    np.testing.assert_allclose(free.signal("channel_j"), leader - follower, rtol=0, atol=ROUNDING)
    assert np.min(free.signal("channel_j")) >= -ROUNDING


def test_runs_repeat_bit_for_bit(free: sn.Recording, tmp_path: Path) -> None:
    again = sn.run(scenario(tmp_path, FREE)).recording
    np.testing.assert_array_equal(again.signals, free.signals)
    np.testing.assert_array_equal(again.actual_points, free.actual_points)


def test_a_recording_keeps_the_signals(free: sn.Recording, tmp_path: Path) -> None:
    sn.run(scenario(tmp_path, FREE), out=tmp_path / "run")
    read = sn.read_recording(tmp_path / "run" / "run.mcap")
    assert read.header.signals == free.header.signals
    np.testing.assert_array_equal(read.signals, free.signals)
    with pytest.raises(KeyError, match="no signal sound"):
        read.signal("sound")


def test_figures_show_the_hand(free: sn.Recording, tmp_path: Path) -> None:
    names = [path.name for path in save_figures(free, tmp_path)]
    assert names[-1] == "by_hand.png"


# --- the loop of cables ---------------------------------------------------------------------


def test_cables_follow_the_hand_in_the_plane(tmp_path: Path) -> None:
    run = sn.run(scenario(tmp_path, BY_CABLES)).recording
    # The robot starts at the path's first point.
    start, end = np.array([0.0, 0.617702, 0.12]), np.array([0.04, 0.617702, 0.13])
    np.testing.assert_allclose(run.actual_tip[0], start, rtol=0, atol=AT_REST)
    # K_I / K_P is 0.4 per second: after 8 s a twentieth of the way may be left.
    assert np.linalg.norm(run.actual_tip[-1] - end) < 0.05 * np.linalg.norm(end - start)
    # What is measured is read off encoders of a micrometre.
    read = run.measured_lengths / 1e-6
    np.testing.assert_allclose(read, np.round(read), rtol=0, atol=1e-6)
    assert run.header.dt == TICK
    np.testing.assert_allclose(np.diff(run.time)[:200], 30 * TICK, rtol=0, atol=ROUNDING)


def test_a_fault_of_the_plant_ends_the_run(tmp_path: Path) -> None:
    found = scenario(tmp_path, FREE)

    class Broken:
        def __init__(self) -> None:
            self.plant = sn.KinematicPlant(found.robot, seed=0)
            self.truth = self.plant.truth

        def step(self, rates: Any, dt: float) -> sn.Measurement:
            seen = self.plant.step(rates, dt)
            return sn.Measurement(tip=np.full(3, np.nan), lengths=seen.lengths)

    broken = sn.Scenario(
        name="broken", mpc=found.mpc, path=found.path, teleop=found.teleop, plant=Broken
    )
    with pytest.raises(PlantFault, match="not a finite number"):
        list(steps(broken))


# --- each pairing, in a mesh ----------------------------------------------------------------


@pytest.mark.parametrize("name", ["watchdog", "jointed_teleop"])
def test_the_margin_holds_although_the_hand_goes_through_the_wall(name: str) -> None:
    found = load_scenario(SCENARIOS / f"{name}.toml")
    run = sn.run(found).recording
    assert np.min(run.nominal_clearance) >= found.mpc.margin
    # The hand, as far as the robot is concerned, is nearer to the wall than the tip may be.
    mapping = found.teleop.mapping
    hand = mapping.origin + run.signal("sent_m") @ mapping.axes.T
    keeps = found.robot.required_distance(found.mpc.margin)[-1]
    assert np.min(found.zone.clearance(hand[::50])) < keeps - 0.005
    # The wall is felt: while the hand hardly moves, the force is not zero.
    still = np.linalg.norm(run.signal("sent_m_s"), axis=1) < 0.01
    assert np.max(np.linalg.norm(run.signal("felt_n")[still], axis=1)) > 0.1
    assert np.min(run.signal("channel_j")) >= -ROUNDING


# --- bad input ------------------------------------------------------------------------------

BAD = {
    "negative delay": (["teleop.delay_ms=-1"], ["teleop.delay"]),
    "small gain": (["teleop.waves.gain=0.3"], ["teleop.waves.gain", "0.5 or more", "allow_active"]),
    "gain of another scheme": (
        ["teleop.scheme=c1", "teleop.waves.gain=0.7"],
        ["teleop.waves.gain", 'scheme = "c2"'],
    ),
    "inside out": (
        ["teleop.mapping.space=plane", "teleop.force.boundary_mm=[[180, -180], [-180, 180]]"],
        ["teleop.force.boundary", "inside out"],
    ),
    "boundary of two axes": (
        ["teleop.force.boundary_mm=[[-180, 180], [-180, 180]]"],
        ["teleop.force.boundary", "3 pairs"],
    ),
    "a wall felt twice": (
        ["teleop.force.constraints=true"],
        ["teleop.force.zone", "felt twice", "zone = false"],
    ),
    "constraints of a law without any": (
        ["teleop.force.constraints=true", "teleop.force.zone=false", "control.law=dls"],
        ["teleop.force.constraints", "dls", 'control.law = "mpc"'],
    ),
    "negative nearness": (["teleop.force.nearness_mm=-1"], ["teleop.force.nearness"]),
    "scales": (["teleop.mapping.scale=[1, 2]"], ["teleop.mapping.scale", "3, one for each axis"]),
    "origin of a plane": (
        ["teleop.mapping.space=plane", "teleop.mapping.origin_mm=[0, 0, 0]"],
        ["teleop.mapping.origin", "depth"],
    ),
    "rates": (["mpc.rate_hz=30"], ["teleop.rate", "whole multiple", "mpc.rate_hz = 50"]),
    "fast filter": (["teleop.waves.cutoff_rad_s=2000"], ["teleop.waves.cutoff", "amplify"]),
    "unknown scheme": (
        ["teleop.scheme=c3"],
        ["teleop.scheme", '"standard", "c1", "c2" or "position_force"'],
    ),
    "law for modules": (["control.law=geometric_ik"], ["robot.file", "geometric inverse"]),
    "encoders of a mismatch": (
        ["plant.encoder_step_mm=0.1", "plant.mismatch.sag_mm=1"],
        ["plant.encoder_step"],
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_is_said_in_the_words_of_the_file(
    tmp_path: Path, case: str, capsys: pytest.CaptureFixture[str]
) -> None:
    changes, words = BAD[case]
    path = tmp_path / "scenario.toml"
    write_text(path, FREE)
    options = [word for change in changes for word in ("--set", change)]
    assert main(("run", str(path), "--out", str(tmp_path / "out"), *options)) == 2
    said = capsys.readouterr().err
    for word in (str(path), *words):
        assert word in said
    assert not (tmp_path / "out" / "run.mcap").exists()


def test_a_small_gain_is_allowed_with_a_warning(tmp_path: Path) -> None:
    changes = ("teleop.waves.gain=0.3", "teleop.waves.allow_active=true", "path.max_steps=2")
    found = scenario(tmp_path, FREE, *changes)
    with pytest.warns(UserWarning, match="makes energy"):
        sn.run(found)


@pytest.mark.parametrize(
    "part",
    ["plant.mismatch.sag_mm=1", "sensor.kind=fibre", "control.taut={floor_n=1, estimate=true}"],
)
def test_what_is_for_segments_is_refused_for_modules(tmp_path: Path, part: str) -> None:
    with pytest.raises(InputError, match="segments only"):
        scenario(tmp_path, FREE, "robot.file=qin2020", part)
