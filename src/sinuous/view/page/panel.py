"""The panel of a live page: what goes on, and what can be done about it."""

from collections.abc import Callable
from time import monotonic, strftime

import viser

from sinuous.live import Snapshot
from sinuous.live.layout import Timed
from sinuous.live.orders import Order, Pause, Record, Reset, Resume
from sinuous.live.processes import LeaderMaker
from sinuous.scenario import Scenario
from sinuous.view.page.hands import DRAGGED
from sinuous.view.page.link_controls import LinkControls
from sinuous.view.page.robot_controls import RobotControls
from sinuous.view.page.status import status_of, told
from sinuous.view.units import MS_PER_S

RECORDINGS = "out/live-"
TOLD = 8.0  # how long what is told stays [s]


class Panel:
    """Status, buttons, and tabs.

    Arguments:
        server: of the page
        order: asks the session for something
        hands: makers of devices by what they are called, the one in use first
        resume: comes before every order to resume
    """

    def __init__(
        self,
        server: viser.ViserServer,
        order: Callable[[Order], None],
        hands: dict[str, LeaderMaker],
        resume: Callable[[], None],
    ) -> None:
        self._order, self._before = order, resume
        self._paused, self._told = False, ("", 0.0)
        self._folder: str | None = None
        self._shown = ""
        gui = server.gui
        self._title = gui.add_markdown("**starting ...**")
        self._status = gui.add_html(told("Both sides of the session are starting."))
        self._pause = gui.add_button("Pause", hint="hand and robot part; the robot holds still")
        self._again = gui.add_button("Reset", hint="begin again from the start")
        self._record = gui.add_button("Record", hint=f"into {RECORDINGS}DATE-TIME")
        self._photo = gui.add_button("Snapshot", hint="this view as a PNG file")
        self._pause.on_click(lambda _: self._pause_or_resume())
        self._again.on_click(lambda _: order(Reset()))
        self._record.on_click(lambda _: self._record_or_not())
        self._photo.on_click(_photograph)
        self.tabs = gui.add_tab_group()
        with self.tabs.add_tab("Link"):
            self._link = LinkControls(gui, order)
        with self.tabs.add_tab("Robot"):
            self._hand = gui.add_dropdown("the hand", tuple(hands))
            self._robot = RobotControls(gui, order)
        self._hand.on_update(lambda _: order(Reset(leader=hands[self._hand.value])))
        with self.tabs.add_tab("Timing"):
            self._timing = gui.add_markdown("")

    @property
    def is_dragged(self) -> bool:
        """Whether the hand is the one on this page."""
        return self._hand.value == DRAGGED

    def begin(self, scenario: Scenario) -> None:
        """Show what a scenario has."""
        assert scenario.teleop is not None
        self._told = ("", 0.0)  # what stood in the way is over
        self._title.content = f"**{scenario.name}**: {scenario.robot.name}"
        self._link.take(scenario.teleop.table)
        self._robot.take(scenario)

    def recording(self, folder: str | None) -> None:
        """Show whether what happens is recorded, as the session says."""
        self._folder = folder
        self._record.label = "Record" if folder is None else "Stop recording"

    def tell(self, text: str, *, lasting: bool) -> None:
        """Say something above everything else."""
        self._told = (text, float("inf") if lasting else monotonic() + TOLD)
        self._write(told(text))

    def show(self, snapshot: Snapshot) -> None:
        """How things are."""
        if snapshot.paused != self._paused:
            self._paused = snapshot.paused
            self._pause.label = "Resume" if self._paused else "Pause"
        text, until = self._told
        status = status_of(snapshot, dragged=self.is_dragged)
        self._write(told(text) if monotonic() < until else status)

    def settle(self) -> None:
        """Send what has come to rest."""
        self._link.settle()

    def show_timing(self, snapshot: Snapshot) -> None:
        """How late the loops are."""
        tick, solve = snapshot.times[Timed.TICK], snapshot.times[Timed.SOLVE]
        command = snapshot.times[Timed.COMMAND]
        rows = (
            ("1 kHz loop late by", tick),
            ("controller takes", solve),
            ("command after its step was due", command),
        )
        table = "\n".join(
            f"| {name} | "
            + " | ".join(f"{MS_PER_S * value:.2f}" for value in (t.median, t.p99, t.max))
            + " |"
            for name, t in rows
        )
        self._timing.content = (
            f"| [ms] | median | p99 | max |\n|---|---|---|---|\n{table}\n\n"
            f"{snapshot.real_time_factor:.3f} of real time; {snapshot.misses} of {snapshot.steps} "
            "commands after the next step was due"
        )

    def _write(self, text: str) -> None:
        if text != self._shown:
            self._shown = self._status.content = text

    def _pause_or_resume(self) -> None:
        if self._paused:
            self._told = ("", 0.0)
            self._before()
            self._order(Resume())
        else:
            self._order(Pause())

    def _record_or_not(self) -> None:
        if self._folder is None:
            self._order(Record(RECORDINGS + strftime("%Y-%m-%d-%H%M%S")))
        else:
            self.tell(f"Recorded. To look at it: sinuous replay {self._folder}", lasting=False)
            self._order(Record(None))


def _photograph(event: "viser.GuiEvent[viser.GuiButtonHandle]") -> None:
    client = event.client
    if client is not None:
        from imageio.v3 import imwrite  # late: viser itself loads it for pictures only

        picture = client.get_render(client.camera.image_height, client.camera.image_width)
        client.send_file_download("sinuous.png", imwrite("<bytes>", picture, extension=".png"))
