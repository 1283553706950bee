"""Makes the pictures of the gallery: runs scenarios, replays them, and looks at the page.

    python scripts/gallery.py [CHROMIUM]

needs Playwright for Python and a Chromium.
"""

import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from playwright.sync_api import Page, sync_playwright

from sinuous.recording import read
from sinuous.view.page.recorded import Recorded
from sinuous.view.page.replay import Replay

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "pictures"
WIDTH, HEIGHT = 1200, 760
DRAWN = 6000.0  # time for the page to draw [ms]
FLAGS = [
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
]  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Picture:
    """One picture: of a scenario, at the moment of the largest force on hand or cables."""

    name: str
    scenario: str


GALLERY = (
    Picture(name="replay_rod", scenario="watchdog"),
    Picture(name="replay_jointed", scenario="jointed_teleop"),
    Picture(name="replay_physics", scenario="cables_physics"),
)


def moment(recorded: Recorded) -> int:
    """The step with the most to see."""
    forces = np.linalg.norm(recorded.forces, axis=1)
    if np.any(forces > 0.0):
        return int(np.argmax(forces))
    tensions = recorded.recording.tensions
    return int(np.argmax(tensions.max(axis=1))) if tensions.size else len(recorded) - 1


def take(picture: Picture, page: Page, folder: Path) -> Path:
    """Run, replay, and save what the page shows."""
    scenario = ROOT / "examples" / "scenarios" / f"{picture.scenario}.toml"
    out = folder / picture.name
    command = [str(Path(sys.executable).with_name("sinuous")), "run", str(scenario)]
    # A run that ends short of its goal still has something to show.
    subprocess.run([*command, "--out", str(out)], check=False, stdout=subprocess.DEVNULL)
    recorded = Recorded.of(read(out / "run.mcap"), file=picture.scenario)
    with Replay(recorded, port=8600) as replay:
        replay.show(moment(recorded))
        page.goto(replay.address)
        page.wait_for_timeout(DRAWN)
        for button in page.locator(".mantine-Notification-closeButton").all():
            button.click()
        page.wait_for_timeout(0.2 * DRAWN)
        path = PICTURES / f"{picture.name}.png"
        page.screenshot(path=path)
    return path


def main() -> None:
    """Make them all."""
    chromium = sys.argv[1] if len(sys.argv) > 1 else "/usr/bin/chromium"
    with TemporaryDirectory() as folder, sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=chromium, args=FLAGS)
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        for picture in GALLERY:
            path = take(picture, page, Path(folder))
            print(f"{path.relative_to(ROOT)}: {path.stat().st_size // 1024} KiB")
        browser.close()


if __name__ == "__main__":
    main()
