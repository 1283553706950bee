"""A live run on a stepped clock is the simulated session, bit by bit."""

from collections import deque
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.leaders.leader import About, ForceKind, Hand, Leader
from sinuous.live.board import Board
from sinuous.live.clock import SteppedClock
from sinuous.live.in_step import InStep
from sinuous.live.layout import Timed
from sinuous.live.loops import LATE_STEPS, HandLoop
from sinuous.live.orders import HandOrder, Pause, Resume, SetFeel, SetLink
from sinuous.live.path_hand import PathHand
from sinuous.live.scenario import Recipe
from sinuous.live.snapshot import Looker
from sinuous.live.watch import Watch
from sinuous.recording import Sample
from sinuous.scenario import Scenario
from sinuous.scenario.teleop_tables import SchemeChoice
from sinuous.session.loop import steps

SCENARIOS = Path(__file__).parents[2] / "examples" / "scenarios"
NAMES = ("live_watchdog", "live_jointed", "bad_link")
ROUNDING = 1e-12  # of sums of energy that are added in another order [J]
TIP = slice(21, 24)  # X_s among the signals
UNTIMED = set(Sample.__dataclass_fields__) - {"solve_time", "signals"}


def scenario(name: str = "live_watchdog", *set: str) -> Scenario:
    return Recipe(str(SCENARIOS / f"{name}.toml"), set).make()


class Kept:
    """Stands for a recorder."""

    def __init__(self) -> None:
        self.samples = list[Sample]()

    def write(self, sample: Sample) -> None:
        self.samples.append(sample)


class Asked:
    """Orders by the tick at which they are asked."""

    def __init__(self) -> None:
        self.orders = deque[HandOrder]()

    def poll(self) -> bool:
        return bool(self.orders)

    def recv(self) -> HandOrder:
        return self.orders.popleft()


class Scripted(Leader):
    """A hand that goes round, is unplugged when told, and notes what it feels."""

    about = About(name="script", axes="", force=ForceKind.TRUE, run_on_hardware=None)

    def __init__(self) -> None:
        self.connected, self.felt, self.size = True, list[Array](), 0.01

    def read(self, time: float) -> Hand:
        turn = 2.0 * np.pi * time
        place = self.size * np.array([np.sin(turn), 1.0 - np.cos(turn), np.sin(2.0 * turn)])
        return Hand(place, held=True, connected=self.connected, age=0.0)

    def feel(self, force: Array) -> None:
        self.felt.append(force)


class Play:
    """A session in step, with orders by tick."""

    def __init__(self, scene: Scenario, leader: Leader) -> None:
        self.asked = Asked()
        self.live = InStep(scene, leader, SteppedClock(), orders=self.asked)
        self._ticks = self.live.ticks()
        self._orders = 0

    def order(self, order: HandOrder) -> None:
        self.asked.orders.append(order)
        self._orders += 1
        self.live.board.put("orders", self._orders)

    def run(self, ticks: int) -> None:
        for _ in islice(self._ticks, ticks):
            pass

    @property
    def board(self) -> Board:
        return self.live.board

    def column(self, name: str, last: int) -> Array:
        block = self.board.ticks.block(self.board.ticks.written - last, last, name)
        assert block is not None
        return block


@pytest.mark.parametrize(
    ("name", "set"),
    [*((name, ()) for name in NAMES), ("live_watchdog", ("teleop.force.nearness_mm=20",))],
)
def test_it_is_the_simulated_session(name: str, set: tuple[str, ...]) -> None:
    scene, samples = scenario(name, *set), 60
    expected = list(islice(steps(scene), samples))
    live = InStep(scene, PathHand(scene), SteppedClock())
    watch, kept = Watch(scene, live.board), Kept()
    watch.recorder = kept  # pyright: ignore[reportAttributeAccessIssue]
    for _ in live.ticks():
        watch.catch_up(1)
        if len(kept.samples) == samples:
            break
    for one, other in zip(expected, kept.samples, strict=True):
        for field in UNTIMED:
            assert np.array_equal(getattr(one, field), getattr(other, field)), field
        assert np.array_equal(one.signals[:, :-4], other.signals[:, :-4])
        assert np.allclose(one.signals, other.signals, rtol=0.0, atol=ROUNDING)
    assert watch.fine == watch.samples == samples
    assert watch.lost == watch.violations == 0


def test_a_snapshot_says_what_the_hand_and_the_body_feel() -> None:
    """The hand goes into the wall; force at the tip, and of the wall on the body, point inward."""
    leader = Scripted()
    scene = scenario("live_watchdog", "teleop.delay_ms=1", "teleop.force.stiffness_n_m=40")
    leader.size = 0.03
    play, most = Play(scene, leader), 0.0
    looker, zone = Looker(scene, play.board), scene.zone
    for _ in range(30):
        play.run(50)
        seen = looker.look(1.0)
        assert seen is not None
        assert np.array_equal(seen.tip_force, -seen.virtual)  # axes are those of the world
        if np.any(seen.body_force):
            normal = zone.nearest(seen.nominal).gradient[seen.pushed]
            assert seen.body_force @ normal > 0.9 * np.linalg.norm(seen.body_force)
            most = max(most, float(np.linalg.norm(seen.body_force)))
    assert most > 0.05


def test_on_a_clock_that_keeps_up_nothing_is_late() -> None:
    play = Play(scenario(), Scripted())
    play.run(300)
    for kind in (Timed.TICK, Timed.STEP, Timed.COMMAND):
        assert play.board.times[kind].quantiles.max == 0.0
    assert play.board.get("misses") == 0
    assert play.board.get("steps") == 30
    # The first message after a step waits for the next one: 9 ms.
    assert play.board.times[Timed.MESSAGE].quantiles.max == pytest.approx(9e-3)


def test_time_stands_while_the_controller_is_late() -> None:
    scene, leader = scenario(), Scripted()
    live = InStep(scene, leader, SteppedClock())
    hand: HandLoop = live.hand
    wanted = [hand.turn() for _ in range(200)]  # and nobody takes a step
    assert live.board.ticks.written == 10 * LATE_STEPS + 1
    assert live.board.get("late") == 1
    assert live.board.get("slipped") == pytest.approx((199 - 10 * LATE_STEPS) * 1e-3)
    assert not any(wanted[10 * LATE_STEPS + 1 :])
    assert np.all(leader.felt[-1] == 0.0)
    while live.robot.is_due:
        live.robot.turn()
    hand.turn()
    assert live.board.get("late") == 0


def test_a_device_that_is_unplugged_is_a_pause_without_a_kick() -> None:
    leader = Scripted()
    play = Play(scenario("live_watchdog", "teleop.delay_ms=10"), leader)
    play.run(1000)
    leader.connected = False
    play.run(1500)
    assert np.all(play.column("paused", 1400))
    assert not np.any(play.column("connected", 1400))
    assert np.all(play.column("share", 900) == 0.0)
    still = play.column("target", 300)
    assert np.array_equal(still, np.broadcast_to(still[0], still.shape))
    leader.connected = True
    play.run(200)
    assert np.all(play.column("share", 100) == 0.0)  # it is the operator who goes on
    play.order(Resume())
    play.run(1500)
    assert np.all(play.column("share", 500) == 1.0)
    steps_m = np.linalg.norm(np.diff(play.column("target", 3000), axis=0), axis=1)
    assert steps_m.max() < 0.5e-3  # 0.5 m/s: fast, but no jump
    assert play.board.get("least_j") >= -1e-9


@pytest.mark.parametrize("choice", list(SchemeChoice))
def test_another_scheme_is_taken_up_without_a_jump(choice: SchemeChoice) -> None:
    play = Play(scenario("live_watchdog", "teleop.delay_ms=20"), Scripted())
    play.run(700)
    play.order(SetFeel(scheme=choice, impedance=15.0, stiffness=200.0))
    play.run(2500)
    assert np.all(play.column("share", 500) == 1.0)
    tips = play.column("signals", 3200)[:, TIP]
    speed = np.linalg.norm(np.diff(tips, axis=0), axis=1) / 1e-3
    assert speed.max() < 1.05 * 0.06  # the tip's speed limit, which holds for the model
    assert np.ptp(tips[-1000:], axis=0).max() > 1e-3  # and the hand moves it again
    felt = np.linalg.norm(np.diff(play.column("felt", 3200), axis=0), axis=1)
    assert felt.max() < 0.1  # [N] in a millisecond, as in motion without any change
    # Position and force have a loan of 0.75 mJ.
    assert play.board.get("least_j") >= -0.8e-3


def test_a_scheme_that_is_chosen_in_a_pause_waits_for_its_end() -> None:
    play = Play(scenario("live_watchdog", "teleop.delay_ms=10"), Scripted())
    play.run(300)
    play.order(Pause())
    play.order(SetFeel(scheme=SchemeChoice.STANDARD))
    play.run(1500)
    assert np.all(play.column("share", 500) == 0.0)
    play.order(Resume())
    play.run(1000)
    assert np.all(play.column("share", 300) == 1.0)


@pytest.mark.parametrize("choice", [SchemeChoice.C2, SchemeChoice.STANDARD])
def test_a_link_that_changes_all_the_time_makes_no_energy(choice: SchemeChoice) -> None:
    rng = np.random.default_rng(5)
    play = Play(scenario("live_watchdog", f"teleop.scheme={choice.value}"), Scripted())
    for _ in range(40):
        delay, jitter, loss = rng.uniform(0.0, (0.3, 0.1, 0.5))
        play.order(SetLink(delay=delay, jitter=min(jitter, delay), loss=loss))
        play.run(int(rng.integers(1, 300)))
        channel = play.column("signals", 1)[0, -4]
        assert channel >= -1e-9
    assert play.board.get("least_j") >= -1e-9
