"""Makes the pictures of the live page: runs sessions by themselves and looks at two sizes.

    python scripts/live_gallery.py [CHROMIUM]

needs Playwright for Python and a Chromium.
"""

import os
import re
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, sync_playwright

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "pictures"
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
UNHURRIED = 60_000  # for a computer without a graphics card [ms]


@dataclass(frozen=True, kw_only=True)
class Picture:
    """One picture: of a scenario, some time after its page was opened, at a size [pixels]."""

    name: str
    scenario: str
    after: float
    width: int
    height: int


GALLERY = (
    Picture(name="live_1400", scenario="live_watchdog", after=4.0, width=1400, height=900),
    Picture(name="live_1000", scenario="live_jointed", after=10.5, width=1000, height=700),
)


def take(picture: Picture, browser: Browser) -> None:
    """Run the scenario and look at its page."""
    scenario = ROOT / "examples" / "scenarios" / f"{picture.scenario}.toml"
    command = [str(Path(sys.executable).with_name("sinuous")), "teleop", str(scenario)]
    with subprocess.Popen(
        [*command, "--leader", "recorded", "--duration", "120"],
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1", "DISPLAY": "", "WAYLAND_DISPLAY": ""},
    ) as program:
        assert program.stdout is not None
        found = re.search(r"http://\S+", program.stdout.readline())
        assert found is not None
        page = browser.new_page(viewport={"width": picture.width, "height": picture.height})
        page.set_default_timeout(UNHURRIED)
        page.goto(found.group())
        page.get_by_text("from the nearest wall").wait_for()
        page.wait_for_timeout(1e3 * picture.after)
        warning = page.get_by_role("alert").get_by_role("button")
        if warning.count():  # of drawing without a graphics card
            warning.first.click()
            page.wait_for_timeout(500.0)
        page.screenshot(path=PICTURES / f"{picture.name}.png")
        page.close()
        program.send_signal(signal.SIGINT)


def main(chromium: str = "/usr/bin/chromium") -> None:
    """Take all pictures."""
    with sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=chromium, args=FLAGS)
        for picture in GALLERY:
            take(picture, browser)
        browser.close()


if __name__ == "__main__":
    main(*sys.argv[1:])
