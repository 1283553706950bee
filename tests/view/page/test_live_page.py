"""The live page in a real browser, with a real session behind it."""

import os
import shutil
import signal
import time
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.live import LiveEnd, LiveResult, LiveSession, Recipe, Snapshot
from sinuous.live.orders import Stop
from sinuous.scenario import Scenario
from sinuous.session.header import make_header
from sinuous.view.page.hands import gizmo_hand, hands_of
from sinuous.view.page.page import GIZMO
from sinuous.view.page.scale import PER_METRE
from sinuous.view.page.server import start_server, stop_server
from sinuous.view.page.stage import Stage
from sinuous.view.page.supervisor import PageSupervisor

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

SCENARIOS = Path(__file__).parents[3] / "examples" / "scenarios"
WATCHDOG = SCENARIOS / "live_watchdog.toml"
PATIENCE = 60.0  # for a busy machine [s]
DRAGGED = 0.010  # how far [m]
CHROMIUM = shutil.which("chromium")
BOX = "() => document.querySelector('canvas[data-engine]').getBoundingClientRect().toJSON()"
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
FIELD_OF_VIEW = np.radians(75.0)  # of viser's camera, from top to bottom
SLOW = 30_000  # for a busy machine [ms]


@contextmanager
def browser() -> "Generator[Browser]":
    """Chromium without a window; the test is skipped where there is none."""
    sync_api = pytest.importorskip("playwright.sync_api")
    if CHROMIUM is None:
        pytest.skip("there is no Chromium")
    with sync_api.sync_playwright() as browsers:
        chromium = browsers.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield chromium
        chromium.close()


def opened(chromium: "Browser", address: str, width: int = 1000, height: int = 700) -> "Page":
    """A tab that shows a robot."""
    page = chromium.new_page(viewport={"width": width, "height": height})
    page.set_default_timeout(SLOW)
    page.goto(address)
    page.get_by_text("from the nearest wall").wait_for()
    return page


class View:
    """Where things are on a page that nobody has turned yet.

    Arguments:
        scenario: that it shows
    """

    def __init__(self, scenario: Scenario) -> None:
        server = start_server(8300, "a page to ask for its camera")
        stage = Stage(server.scene, make_header(scenario), scenario.robot)
        self._from, to = stage.home_camera()
        self.size = GIZMO * stage.size
        stop_server(server)
        self._ahead = (to - self._from) / np.linalg.norm(to - self._from)
        right = np.cross(self._ahead, [0.0, 0.0, 1.0])
        self._right = right / np.linalg.norm(right)

    def pixel(self, page: "Page", place: Array) -> tuple[float, float]:
        """Of a place (3,) [m]."""
        box = page.evaluate(BOX)  # not by a locator, which waits for frames that software draws
        seen = PER_METRE * place - self._from
        far = 0.5 * box["height"] / np.tan(0.5 * FIELD_OF_VIEW) / (seen @ self._ahead)
        up = np.cross(self._right, self._ahead)
        x = box["x"] + 0.5 * box["width"] + far * (seen @ self._right)
        return float(x), float(box["y"] + 0.5 * box["height"] - far * (seen @ up))


class Live:
    """A session in a thread, and its page."""

    def __init__(self) -> None:
        self.seen = list[Snapshot]()
        self.recipes = list[Recipe]()
        self.addresses, self.lost = list[str](), list[str]()
        self.result: LiveResult | None = None
        self.page = PageSupervisor(
            port=8400,
            hands=hands_of("gizmo", gizmo_hand),
            ready=self.addresses.append,
            lost=self.lost.append,
        )
        self.session = LiveSession(
            Recipe(str(WATCHDOG)),
            gizmo_hand,
            patient=True,
            started=self._started,
            observe=self._observe,
            recording=self.page.recording,
            refused=self.page.tell,
        )
        self._thread = Thread(target=self._run)

    def __enter__(self) -> "Live":
        self.page.__enter__()
        self.page.serve(self.session)
        self._thread.start()
        self.wait(lambda: bool(self.addresses) and bool(self.seen))
        return self

    def __exit__(self, *_: object) -> None:
        self.session.order(Stop())
        self._thread.join(PATIENCE)
        self.page.__exit__()
        assert self.result is not None
        assert self.result.end is LiveEnd.STOPPED
        assert self.result.numbers["margin_violations"] == 0

    def _run(self) -> None:
        self.result = self.session.run()

    def _started(self, scenario: Scenario, recipe: Recipe) -> None:
        self.recipes.append(recipe)
        self.page.started(scenario, recipe)

    def _observe(self, snapshot: Snapshot) -> None:
        self.seen.append(snapshot)
        self.page.observe(snapshot)

    @property
    def now(self) -> Snapshot:
        """The newest snapshot."""
        return self.seen[-1]

    def wait(self, until: Callable[[], bool]) -> None:
        """Until something is so."""
        end = time.monotonic() + PATIENCE
        while not until():
            assert time.monotonic() < end, (self.lost, self.addresses, self.recipes)
            time.sleep(0.02)


def drag(live: Live, page: "Page", view: View) -> None:
    """Take the target's upper arrow, move it, and wait until the tip has followed."""
    upward, before = np.array([0.0, 0.0, 1.0]), live.now.actual[-1]
    arrow = before + 0.9 * view.size * upward
    page.mouse.move(*view.pixel(page, arrow))
    page.mouse.down()
    for share in np.linspace(0.0, 1.0, 8):
        page.mouse.move(*view.pixel(page, arrow + share * DRAGGED * upward))
    page.mouse.up()
    live.wait(lambda: float((live.now.actual[-1] - before) @ upward) > 0.7 * DRAGGED)


@pytest.fixture
def live() -> Iterator[Live]:
    with Live() as session:
        yield session


def test_the_tip_follows_what_is_dragged_and_holds_still_when_the_page_is_closed(
    live: Live, tmp_path: Path
) -> None:
    view = View(Recipe(str(WATCHDOG)).make())
    with browser() as chromium:
        page = opened(chromium, live.addresses[0])
        drag(live, page, view)
        assert live.now.connected
        page.screenshot(path=tmp_path / "dragged.png")
        other = opened(chromium, live.addresses[0])
        page.reload()
        page.get_by_text("from the nearest wall").wait_for()
        assert not live.now.paused, "the other tab is still there"
        page.close()
        other.close()
        live.wait(lambda: live.now.paused)
        assert not live.now.connected
        page = opened(chromium, live.addresses[0], 800, 600)
        page.get_by_text("every page was closed").wait_for()
        page.get_by_role("button", name="Resume").click()
        live.wait(lambda: live.now.connected and not live.now.paused)
    assert not live.lost


def test_another_scenario_is_chosen_and_what_cannot_be_is_refused(live: Live) -> None:
    with browser() as chromium:
        page = opened(chromium, live.addresses[0])
        page.get_by_role("tab", name="Setup").click()
        own = page.get_by_text("or a path of your own").locator("xpath=following::input[1]")
        own.fill("nowhere.toml")
        page.get_by_role("button", name="Change to it").click()
        page.get_by_text("nowhere.toml").first.wait_for()
        assert len(live.recipes) == 1
        own.fill(str(SCENARIOS / "live_jointed.toml"))
        page.get_by_role("button", name="Change to it").click()
        live.wait(lambda: len(live.recipes) == 2)
        page.get_by_text("qin2020").first.wait_for()
    assert live.recipes[1].file.endswith("live_jointed.toml")


def test_a_page_that_is_killed_comes_back_and_the_robot_holds_still(live: Live) -> None:
    process = live.page.pid
    assert process is not None
    os.kill(process, signal.SIGKILL)
    live.wait(lambda: len(live.addresses) == 2)
    assert live.addresses[0] == live.addresses[1]
    assert "holds still" in live.lost[0]
    live.wait(lambda: live.now.paused)
    with browser() as chromium:
        page = opened(chromium, live.addresses[1])
        page.get_by_role("button", name="Resume").click()
        live.wait(lambda: not live.now.paused and live.now.share == 1.0)
        drag(live, page, View(Recipe(str(WATCHDOG)).make()))
