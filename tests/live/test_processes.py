"""Real processes: how they end, whatever happens to them."""

import json
import os
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import pytest

from sinuous.cli.teleop_leaders import csv_hand
from sinuous.live import LiveEnd, LiveSession, PathHand, Recipe, Snapshot
from sinuous.live.orders import Pause, Record, Reset, SetLink, Stop
from sinuous.live.session import following
from sinuous.recording import read

SCENARIOS = Path(__file__).parents[2] / "examples" / "scenarios"
WATCHDOG = SCENARIOS / "live_watchdog.toml"
SINUOUS = [str(Path(sys.executable).with_name("sinuous"))]
PATIENCE = 60.0  # for a busy machine [s]

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="finds processes in /proc")


def children(pid: int) -> set[int]:
    """Processes whose parent has that number, and theirs."""
    found = set[int]()
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # it has ended meanwhile
        if int(fields[1]) == pid and fields[0] != "Z":
            child = int(path.parent.name)
            found |= {child} | children(child)
    return found


def wait_until_gone(pids: set[int]) -> None:
    end = time.monotonic() + PATIENCE
    while left := {pid for pid in pids if Path(f"/proc/{pid}/stat").exists()}:
        assert time.monotonic() < end, left
        time.sleep(0.05)


def started(*arguments: str) -> tuple["subprocess.Popen[str]", set[int]]:
    """The program in its own session, once it runs, and the processes it has started."""
    program = subprocess.Popen(
        [*SINUOUS, "teleop", str(WATCHDOG), "--no-browser", *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert program.stdout is not None
    assert "Live" in program.stdout.readline()
    return program, children(program.pid)


def test_the_program_tells_its_numbers_and_leaves_nothing(tmp_path: Path) -> None:
    file = tmp_path / "numbers.json"
    program, pids = started("--duration", "2", "--json", str(file), "--out", str(tmp_path / "run"))
    _, errors = program.communicate(timeout=PATIENCE)
    assert (program.returncode, errors) == (0, "")  # Python would complain of memory that is left
    wait_until_gone(pids)
    numbers = json.loads(file.read_text())
    assert numbers["margin_violations"] == 0
    assert numbers["channel_energy_least_j"] >= -1e-9
    assert 0.0 <= numbers["mpc_deadline_miss_fraction"] <= 1.0
    assert set(numbers["tick_lateness_s"]) == {"median", "p99", "max"}
    assert "memory_growth_bytes" in numbers
    recording = read(tmp_path / "run" / "run.mcap")
    assert recording.complete
    assert len(recording) > 20
    assert len(recording.signals) == 10 * len(recording)


def test_a_scenario_that_cannot_run_live_is_one_message_and_leaves_nothing() -> None:
    program = subprocess.run(
        [*SINUOUS, "teleop", str(WATCHDOG.parent / "free_space.toml"), "--no-browser"],
        capture_output=True,
        text=True,
        timeout=PATIENCE,
    )
    assert program.returncode == 2
    assert "mpc.rate_hz" in program.stderr
    assert program.stderr.count("\n") == 1  # Python would complain of memory that is left


def test_ctrl_c_ends_everything() -> None:
    program, pids = started()  # until somebody ends it: its output is no terminal, so 20 s
    assert len(pids) >= 2
    os.killpg(program.pid, signal.SIGINT)  # as a terminal does it: all of them get it
    _, errors = program.communicate(timeout=PATIENCE)
    assert program.returncode == 130
    assert "Traceback" not in errors
    wait_until_gone(pids)


def test_nothing_is_left_if_the_program_is_killed() -> None:
    program, pids = started()
    program.kill()
    program.communicate(timeout=PATIENCE)
    wait_until_gone(pids)


class Kills:
    """Kills the second process that a session has started, once."""

    def __init__(self, before: set[int]) -> None:
        self._before, self.done = before, False

    def __call__(self, snapshot: Snapshot) -> None:
        if not self.done:
            self.done = True
            robots = sorted(
                pid
                for pid in children(os.getpid()) - self._before
                if b"spawn_main" in Path(f"/proc/{pid}/cmdline").read_bytes()
            )
            os.kill(robots[1], signal.SIGKILL)


def test_a_process_that_dies_is_said_and_a_patient_session_begins_again() -> None:
    kills, told = Kills(children(os.getpid())), list[str]()

    def failed(fault: str) -> None:
        told.append(fault)
        session.order(Reset(set=("mpc.horizon=4",)))

    def started(scenario: object, recipe: Recipe) -> None:
        if told:
            session.order(Stop())

    session = LiveSession(
        Recipe(str(WATCHDOG)),
        PathHand,
        patient=True,
        observe=kills,
        failed=failed,
        started=started,
    )
    result = session.run(PATIENCE)
    assert result.end is LiveEnd.STOPPED
    assert told == ["the robot's side ended with code -9"]


def test_orders_reach_the_loop() -> None:
    seen = list[Snapshot]()

    def observe(snapshot: Snapshot) -> None:
        if not seen:
            session.order(SetLink(delay=0.05, jitter=0.02, loss=0.2))
            session.order(Pause())
        seen.append(snapshot)
        if snapshot.paused:
            session.order(Stop())

    session = LiveSession(Recipe(str(WATCHDOG)), PathHand, observe=observe)
    assert session.run(PATIENCE).end is LiveEnd.STOPPED
    assert seen[-1].advice == "paused"
    assert seen[0].nominal.shape == seen[0].actual.shape
    assert seen[0].clearance > 0.0


def test_a_device_that_is_not_there_is_said() -> None:
    nowhere = partial(csv_hand, "nowhere.csv")
    result = LiveSession(Recipe(str(WATCHDOG)), nowhere).run(PATIENCE)
    assert result.end is LiveEnd.FAILED
    assert "the operator's side: nowhere.csv" in result.fault


def test_what_cannot_be_is_refused_and_a_recording_goes_on_in_another_folder(
    tmp_path: Path,
) -> None:
    why, recipes, seen = list[str](), list[Recipe](), list[Snapshot]()
    folders = list[str | None]()
    nowhere = tmp_path / "a file, not a folder"
    nowhere.write_text("", encoding="utf-8")

    def observe(snapshot: Snapshot) -> None:
        seen.append(snapshot)
        if len(seen) == 1:
            session.order(Reset(scenario="nowhere.toml"))
        elif len(seen) == 5:
            assert len(recipes) == 1, "nothing has changed"
            session.order(Reset(set=("mpc.horizon=3",)))
        elif len(recipes) == 2 and len(why) == 1:
            session.order(Record(str(nowhere / "run")))
        elif len(why) == 2:
            session.order(Stop())

    session = LiveSession(
        Recipe(str(WATCHDOG)),
        PathHand,
        started=lambda _, recipe: recipes.append(recipe),
        observe=observe,
        recording=folders.append,
        refused=why.append,
    )
    result = session.run(PATIENCE, record=str(tmp_path / "run"))
    assert result.end is LiveEnd.STOPPED
    assert "nowhere.toml" in why[0]
    assert "recording has ended" in why[1]
    assert folders == [str(tmp_path / "run"), str(tmp_path / "run-2"), None]
    assert [recipe.set for recipe in recipes] == [(), ("mpc.horizon=3",)]
    for name, horizon in (("run", "horizon = 5"), ("run-2", "horizon = 3")):
        assert horizon in read(str(tmp_path / name / "run.mcap")).header.scenario


@pytest.mark.parametrize(
    ("before", "after"),
    [
        (None, None),
        ("run", "run-2"),
        ("run-2", "run-3"),
        ("run-9", "run-10"),
        ("live-2026-11-25-101500", "live-2026-11-25-101500-2"),
        ("far-away/run", "far-away/run-2"),
    ],
)
def test_recordings_that_follow_one_another(before: str | None, after: str | None) -> None:
    assert following(before) == after
