"""A recording on a page: with a slider for time, or as one file that needs no server."""

from threading import Lock
from typing import Self

import numpy as np
import viser

from sinuous.arrays import IntArray
from sinuous.view.page.limits import few
from sinuous.view.page.recorded import Recorded
from sinuous.view.page.replay_plots import ReplayPlots
from sinuous.view.page.server import address_of, start_server, stop_server
from sinuous.view.page.stage import Stage
from sinuous.view.units import MM_PER_M

FRAME = 1.0 / 30.0  # [s]
MOST_FRAMES = 1800  # in one file: a minute at 30 per second
SPEEDS = {"0.1 x": 0.1, "0.25 x": 0.25, "0.5 x": 0.5, "1 x": 1.0, "2 x": 2.0, "5 x": 5.0}


class Replay:
    """A page that plays a recording.

    Arguments:
        recorded: what is played
        port: to begin with; a later one if it is taken
    """

    def __init__(self, recorded: Recorded, *, port: int) -> None:
        self._recorded, self._lock = recorded, Lock()
        times = recorded.recording.time
        self._first, self._last = float(times[0]), float(times[-1])
        self._server = start_server(port, recorded.recording.header.name)
        self._stage = Stage(self._server.scene, recorded.recording.header, recorded.robot)
        _look(self._server, self._stage)
        self._step = -1
        self._now, self._playing = self._first, True
        self._build()
        self.show(0)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        stop_server(self._server)

    @property
    def address(self) -> str:
        """Where the page is."""
        return address_of(self._server)

    def _build(self) -> None:
        gui, period = self._server.gui, self._recorded.recording.header.dt
        self._status = gui.add_markdown("")
        last = max(self._last, self._first + period)
        self._slider = gui.add_slider("time [s]", self._first, last, 0.001, self._first)
        self._button = gui.add_button("Pause")
        self._speed = gui.add_dropdown("speed", tuple(SPEEDS), initial_value="1 x")
        steps = gui.add_button_group("step", ("- 1", "+ 1"))
        self._plots = ReplayPlots(gui, self._recorded)

        @self._button.on_click
        def _(_: object) -> None:
            self._play(not self._playing)

        @steps.on_click
        def _(_: object) -> None:
            self._play(False)
            self.show(self._step + (1 if steps.value == "+ 1" else -1))

        @self._slider.on_update
        def _(event: viser.GuiEvent[viser.GuiSliderHandle[float]]) -> None:
            if event.client is not None:  # moved by somebody, not by `show`
                self._play(False)
                self.show(self._at(event.target.value))

    def _play(self, playing: bool) -> None:
        self._playing = playing
        self._button.label = "Pause" if playing else "Play"

    def _at(self, time: float) -> int:
        """The last step that is not later."""
        return int(np.searchsorted(self._recorded.recording.time, time + 1e-9, side="right")) - 1

    def advance(self, passed: float) -> None:
        """Let time pass [s] by the clock; at its end a recording begins again."""
        if not self._playing:
            return
        self._now += passed * SPEEDS[self._speed.value]
        if self._now > self._last:
            self._now = self._first
        self.show(self._at(self._now), self._now)

    def show(self, step: int, now: float | None = None) -> None:
        """Show a step, at a time [s] between it and the next."""
        with self._lock:
            step = int(np.clip(step, 0, len(self._recorded) - 1))
            self._now = float(self._recorded.recording.time[step]) if now is None else now
            if step == self._step:
                return
            self._step = step
            self._stage.show(self._recorded.moment(step))
            self._slider.value = float(np.clip(self._now, self._first, self._slider.max))
            self._status.content = status_line(self._recorded, step)
            self._plots.show(self._now)


def status_line(recorded: Recorded, step: int) -> str:
    """What the robot does at a step and what limits it, as Markdown."""
    recording = recorded.recording
    limits = recording.active[step]
    clearance = float(recording.actual_clearance[step])
    room = f"{clearance * MM_PER_M:.1f} mm" if np.isfinite(clearance) else "no walls"
    cut = "" if recording.complete else "\n\nThe recording was cut off."
    state = recording.status[step].replace("_", " ")
    return f"**{state}**, clearance {room}  \nlimited by: {few(tuple(limits))}{cut}"


def frames_of(recorded: Recorded) -> tuple[IntArray, float]:
    """Steps that one file shows, and the time between them [s]: fewer than 30 per second if long.

    Every frame is the last step that is not later.
    """
    times = recorded.recording.time
    span = float(times[-1] - times[0])
    period = max(FRAME, span / (MOST_FRAMES - 1))
    moments = times[0] + period * np.arange(int(span / period + 1e-9) + 1)
    steps = np.searchsorted(times, moments + 1e-9, side="right") - 1
    return steps.astype(np.int64), period


def as_html(recorded: Recorded, *, port: int) -> str:
    """One page that shows it all and needs nothing else."""
    server = start_server(port, recorded.recording.header.name)
    try:
        stage = Stage(server.scene, recorded.recording.header, recorded.robot)
        _look(server, stage)
        steps, period = frames_of(recorded)
        stage.show(recorded.moment(int(steps[0])))
        serializer = server.get_scene_serializer()
        serializer.insert_sleep(period)
        for step in steps[1:]:
            stage.show(recorded.moment(int(step)))
            serializer.insert_sleep(period)
        return serializer.as_html()
    finally:
        stop_server(server)


def _look(server: viser.ViserServer, stage: Stage) -> None:
    position, target = stage.home_camera()
    server.initial_camera.position = position
    server.initial_camera.look_at = target
    server.initial_camera.up = np.array([0.0, 0.0, 1.0])
