"""Scenarios over bad links: no energy is made, the margin holds, and bad input is explained."""

from pathlib import Path

import numpy as np
import pytest

import sinuous as sn
from sinuous.cli import main
from sinuous.files import write_text
from sinuous.scenario import load_scenario

SCENARIOS = Path(__file__).parents[1] / "examples" / "scenarios"
ROUNDING = 1e-12
BACK = 1e-3  # from where the hand has put it, once everything rests [m]

FREE = """
name = "free"
seed = 5
[robot]
file = "hachen2025"
[mpc]
rate_hz = 50
horizon = 3
[path]
waypoints_mm = [[30, 0, 190], [0, 20, 200]]
max_steps = 250
[teleop]
delay_ms = 100
[teleop.link]
jitter_ms = 50
loss = 0.3
burst = 4
duplication = 0.1
outages_s = [[1, 1.5]]
course_s = [[0, 0], [3, 0], [3, 0.1]]
[teleop.correction]
"""


def scenario(folder: Path, *changes: str) -> sn.Scenario:
    path = folder / "scenario.toml"
    write_text(path, FREE)
    return load_scenario(path, set=changes)


@pytest.mark.parametrize("scheme", ["standard", "c1", "c2", "position_force"])
def test_no_scheme_makes_energy_and_all_get_there(tmp_path: Path, scheme: str) -> None:
    run = sn.run(scenario(tmp_path, f"teleop.scheme={scheme}")).recording
    assert np.min(run.signal("channel_j")) >= -ROUNDING
    # Drift is corrected: the tip is where the hand is, which is where the path ends.
    hand, tip = run.signal("sent_m")[-1], run.signal("tip_m")[-1]
    assert np.linalg.norm(hand - tip) < BACK
    np.testing.assert_allclose(run.actual_tip[-1], [0.0, 0.02, 0.2], rtol=0, atol=2 * BACK)


def test_without_protection_the_channel_makes_energy(tmp_path: Path) -> None:
    """A wave that is held through an outage goes on giving out the energy it had once."""
    cut = ("teleop.scheme=standard", "teleop.link.outages_s=[[0.2, 3]]", "path.max_steps=100")
    off = ("teleop.passivity.enabled=false", "teleop.passivity.hold_s=inf")
    bare = sn.run(scenario(tmp_path, *cut, *off)).recording
    assert np.min(bare.signal("channel_j")) < -1e-3
    kept = sn.run(scenario(tmp_path, *cut, "teleop.passivity.hold_s=inf")).recording
    assert np.min(kept.signal("channel_j")) >= -ROUNDING


def test_luck_is_that_of_the_seed(tmp_path: Path) -> None:
    short = ("path.max_steps=20",)
    one, same = (sn.run(scenario(tmp_path, *short)).recording for _ in range(2))
    np.testing.assert_array_equal(one.signals, same.signals)
    other = sn.run(scenario(tmp_path, *short, "seed=6")).recording
    assert np.any(other.signals != one.signals)


def test_a_recorded_trace_is_played(tmp_path: Path) -> None:
    rows = "\n".join(f"{k * 0.001},{200 if k % 2 else ''}" for k in range(100))
    write_text(tmp_path / "trace.csv", f"t_s,delay_ms\n{rows}\n")
    changes = ("teleop.link.trace=trace.csv", "teleop.delay_ms=0", "path.max_steps=20")
    still = ("teleop.link.jitter_ms=0", "teleop.link.loss=0", "teleop.link.outages_s=[]")
    run = sn.run(scenario(tmp_path, *changes, *still)).recording
    moves = np.flatnonzero(np.any(run.signal("desired_m_s") != 0.0, axis=1))
    assert 200 <= moves[0] <= 203
    # The recording finds the trace again from anywhere.
    assert str(tmp_path / "trace.csv") in run.header.scenario


def test_the_margin_holds_over_a_bad_link() -> None:
    found = load_scenario(SCENARIOS / "bad_link.toml", set=["path.max_steps=150"])
    run = sn.run(found).recording
    assert np.min(run.nominal_clearance) >= found.mpc.margin
    assert np.min(run.signal("channel_j")) >= -ROUNDING
    assert np.all(run.signal("fault") == 0.0)


def test_a_limit_bounds_what_is_felt_from_afar(tmp_path: Path) -> None:
    changes = ("teleop.limits.force_n=0.05", "teleop.limits.force_time_ms=100")
    run = sn.run(scenario(tmp_path, *changes, "teleop.scheme=c2")).recording
    # At rest all that is felt comes from afar; moving, the port's own damping comes on top.
    still = np.linalg.norm(run.signal("sent_m_s"), axis=1) < 1e-4
    assert np.max(np.linalg.norm(run.signal("felt_n")[still], axis=1)) < 0.05 + 1e-3
    assert np.min(run.signal("channel_j")) >= -ROUNDING


BAD = {
    "loss of all": (["teleop.link.loss=1"], ["teleop.link.loss"]),
    "short bursts": (
        ["teleop.link.loss=0.8", "teleop.link.burst=2"],
        ["teleop.link.burst", "at least 4 packets"],
    ),
    "outage backwards": (["teleop.link.outages_s=[[2, 1]]"], ["teleop.link.outages", "later end"]),
    "course backwards": (
        ["teleop.link.course_s=[[2, 0], [1, 0]]"],
        ["teleop.link.course", "in order of time"],
    ),
    "no playout": (
        ["teleop.passivity.receiver=interpolate"],
        ["teleop.passivity.playout", "a time"],
    ),
    "playout of hold": (["teleop.passivity.playout_ms=100"], ["teleop.passivity.playout", "none"]),
    "time without a force": (["teleop.limits.force_time_ms=10"], ["teleop.limits.force_time"]),
    "active ports under control": (
        ["teleop.waves.gain=0.3", "teleop.waves.allow_active=true"],
        ["teleop.waves.gain", "passivity control"],
    ),
    "no trace": (["teleop.link.trace=nowhere.csv"], ["teleop.link.trace", "nothing at"]),
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
