"""The tab in a real browser: what is typed and uploaded becomes one order, or a message."""

import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import viser

from sinuous.live import Recipe
from sinuous.live.orders import Order, Reset
from sinuous.view.page.setup import Setup

sync_api = pytest.importorskip("playwright.sync_api")

CHROMIUM = Path("/usr/bin/chromium")
FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]  # fmt: skip
EXAMPLES = Path(__file__).parents[3] / "examples"
WATCHDOG = str(EXAMPLES / "scenarios" / "live_watchdog.toml")
TUBE = EXAMPLES / "meshes" / "winding_tube.stl"
PATIENCE = 30_000  # of the browser on a busy machine [ms]

pytestmark = pytest.mark.skipif(not CHROMIUM.exists(), reason="needs Chromium")


class Stand:
    """A page with nothing but the tab."""

    def __init__(self) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.orders = list[Order]()
        self.said = list[str]()
        self.server = viser.ViserServer(host="127.0.0.1", port=port, verbose=False)
        self.address = f"http://127.0.0.1:{port}"
        tab = self.server.gui.add_tab_group().add_tab("Setup")
        self.setup = Setup(self.server, self.orders.append, self.said.append, tab=tab)
        self.setup.scenario_changed(Recipe(WATCHDOG).make(), WATCHDOG)

    def close(self) -> None:
        self.setup.close()
        self.server.stop()


@pytest.fixture(scope="module")
def stand() -> Iterator[Stand]:
    stand = Stand()
    yield stand
    stand.close()


@pytest.fixture(scope="module")
def page(stand: Stand) -> Iterator[Any]:
    with sync_api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=str(CHROMIUM), args=FLAGS)
        page = browser.new_page(viewport={"width": 1000, "height": 1100})
        page.set_default_timeout(PATIENCE)
        page.goto(stand.address)
        page.get_by_text("Check and begin again").wait_for()
        yield page
        browser.close()


@pytest.fixture(autouse=True)
def nothing_asked(stand: Stand) -> None:
    stand.orders.clear()
    stand.said.clear()
    stand.setup.scenario_changed(Recipe(WATCHDOG).make(), WATCHDOG)


def apply(page: Any, stand: Stand) -> None:
    page.get_by_role("button", name="Check and begin again with these").click()
    for _ in range(200):
        page.wait_for_timeout(50)
        if stand.orders or len(stand.said) > 1:
            return


def test_a_path_that_is_none_is_said_and_nothing_is_ordered(page: Any, stand: Stand) -> None:
    stand.setup._mesh.value = ""
    page.wait_for_timeout(300)
    fill_by_text(page, "mesh", "nowhere.stl")
    apply(page, stand)
    assert stand.orders == []
    assert "nowhere.stl" in stand.said[-1]
    page.get_by_text("nowhere.stl").last.wait_for()


def fill_by_text(page: Any, label: str, text: str) -> None:
    """Type into the field beside a label."""
    row = page.get_by_text(label, exact=True).first.locator("xpath=ancestor::*[.//input][1]")
    row.locator("input").first.fill(text)
    page.wait_for_timeout(400)


def test_a_mesh_that_is_uploaded_becomes_one_order(page: Any, stand: Stand) -> None:
    with page.expect_file_chooser() as choosing:
        page.get_by_role("button", name="Upload a mesh (STL, OBJ, PLY)").click()
    choosing.value.set_files(str(TUBE))
    for _ in range(100):
        page.wait_for_timeout(50)
        if "sinuous-" in stand.setup._mesh.value:
            break
    uploaded = Path(stand.setup._mesh.value)
    assert uploaded.read_bytes() == TUBE.read_bytes()
    apply(page, stand)
    (order,) = stand.orders
    assert isinstance(order, Reset)
    assert f'zone.mesh="{uploaded}"' in order.set
    Recipe(WATCHDOG, order.set).make()


def test_another_scenario_is_ordered_by_its_path(page: Any, stand: Stand) -> None:
    own = str(EXAMPLES / "scenarios" / "live_jointed.toml")
    fill_by_text(page, "or a path of your own", own)
    page.get_by_role("button", name="Change to it").click()
    for _ in range(100):
        page.wait_for_timeout(50)
        if stand.orders:
            break
    assert stand.orders == [Reset(scenario=own)]


def test_the_base_shows_its_handle_and_its_clearance(page: Any, stand: Stand) -> None:
    page.get_by_text("move base", exact=True).click()
    page.get_by_text("clear of walls by").wait_for()
    stand.setup._position.value = (300.0, 0.0, -70.0)
    stand.setup._show()
    page.get_by_text("beyond a wall by").wait_for()


def test_landmarks_give_the_base_and_a_click_finds_the_mesh(page: Any, stand: Stand) -> None:
    registering = stand.setup._registering
    base = np.array([2.0, 1.0, -68.0])
    for k, known in enumerate([(0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (0.0, 40.0, 5.0)]):
        registering._known[k].value = f"{known}"[1:-1]
        registering._places[k].value = f"{tuple(float(one) for one in base + known)}"[1:-1]
    page.get_by_text("Registration by landmarks").click()
    page.get_by_role("button", name="Compute the base").click()
    page.get_by_text("root mean square 0.0 mm").wait_for()
    np.testing.assert_allclose(stand.setup._position.value, base, atol=1e-3)
    stand.server.initial_camera.position = (0.0, -3.0, 1.0)
    client = next(iter(stand.server.get_clients().values()))
    client.camera.position, client.camera.look_at = (4.0, -2.0, 0.5), (0.0, 0.0, 0.5)
    registering._clicked.value = "landmark 4"
    page.wait_for_timeout(1000)
    page.mouse.click(500, 550)
    for _ in range(40):
        page.wait_for_timeout(50)
        if registering._places[3].value:
            break
    assert registering._places[3].value, "the middle of the page looks at the tube"
