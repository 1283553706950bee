"""What there is to see of a session at a moment, for a view or for anybody."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.control.report import Status
from sinuous.live.board import Board
from sinuous.live.layout import Timed
from sinuous.live.robot import STATUSES
from sinuous.live.samples import active_names
from sinuous.live.times import Quantiles
from sinuous.scenario import Scenario
from sinuous.session.by_hand import signal_names


@dataclass(frozen=True, kw_only=True, eq=False)
class Snapshot:
    """A moment.

    Arguments:
        time: simulated [s]
        target: for the tip (3,) [m]
        nominal: body points of the model (S, 3) [m]
        actual: of the plant (S, 3) [m]
        lengths: of the actuators, as measured (P,) [m]
        tensions: of the plant's cables (C,) [N]; empty if it does not know them
        contacts: deepest penetration [m], largest and total force [N] at walls (3,)
        nearest: of the body points that can move, the one that is closest to a wall
        wall: the point of the wall that is closest to it (3,) [m]; nan without walls
        clearance: between the two, less the body's radius there [m]; inf without walls
        hand: where the device says the operator's hand is (3,) [m]
        felt: force on the hand (3,) [N]
        virtual: force at the robot's end (A,) [N]
        tip_force: on the hand, as it is at the robot's end, drawn at the tip (3,) [N]
        pushed: of the model's body points, the one that walls push the most
        body_force: of the walls on that point (3,) [N]; zero if none is in the way
        tracking_error: from the tip to where it should be [m]
        energies: taken in by channel, operator and follower since the start (3,) [J]
        energy_least: smallest of the channel's so far [J]
        status: of the controller
        limits: what limits the robot right now, the strongest first
        reason: why the robot holds still, if it does
        solve_time: of the last sample [s]
        connected: whether the device is there
        held: whether the operator means it
        paused: whether hand and robot are apart, or part
        share: by which they are together, 0 to 1
        late: whether simulated time stands because the controller is late
        real_time_factor: of simulated time by the clock, so far
        misses: steps whose command came after the next step was due
        steps: of the controller, so far
        times: quantiles by `Timed`
    """

    time: float
    target: Array
    nominal: Array
    actual: Array
    lengths: Array
    tensions: Array
    contacts: Array
    nearest: int
    wall: Array
    clearance: float
    hand: Array
    felt: Array
    virtual: Array
    tip_force: Array
    pushed: int
    body_force: Array
    tracking_error: float
    energies: Array
    energy_least: float
    status: Status
    limits: tuple[str, ...]
    reason: str
    solve_time: float
    connected: bool
    held: bool
    paused: bool
    share: float
    late: bool
    real_time_factor: float
    misses: int
    steps: int
    times: tuple[Quantiles, ...]

    @property
    def advice(self) -> str:
        """What stands in the way of the whole session right now; empty if nothing does."""
        if not self.connected:
            return "the device is gone: plug it in and resume"
        if self.late:
            return "slower than real time: the controller is late"
        if self.status is Status.HOLDING:
            return f"holding still: {self.reason}"
        if self.paused:
            return "paused"
        return ""


class Looker:
    """Takes snapshots of a board.

    Arguments:
        scenario: what is done
        board: where both loops write
    """

    def __init__(self, scenario: Scenario, board: Board) -> None:
        assert scenario.teleop is not None
        self._scenario, self._board = scenario, board
        self._tick, self._axes = scenario.teleop.dt, scenario.teleop.mapping.axes
        axes = len(scenario.teleop.axes)
        names = signal_names(scenario.teleop.axes)
        stems = [name.rpartition("_")[0] for name in names]
        self._virtual, self._desired, self._tip = (
            slice(stems.index(stem), stems.index(stem) + axes)
            for stem in ("virtual_n", "desired_m", "tip_m")
        )
        self._energy = slice(names.index("channel_j"), names.index("channel_j") + 3)

    def look(self, now: float) -> Snapshot | None:
        """How things are at a time of the clock [s]; None before the first sample."""
        board, zone, robot = self._board, self._scenario.zone, self._scenario.robot
        tick = board.ticks.read(board.ticks.written - 1)
        row = board.samples.read(board.samples.written - 1)
        if tick is None or row is None:
            return None
        near = zone.nearest(row["actual"])
        room = near.clearance - robot.radii
        room[~robot.movable] = np.inf  # what cannot move has no part in the clearance
        place = int(np.argmin(room))
        signals, done = tick["signals"], board.ticks.written * self._tick
        passed = now - board.get("go")
        return Snapshot(
            time=done,
            target=tick["target"],
            nominal=row["nominal"],
            actual=row["actual"],
            lengths=row["measured_lengths"],
            tensions=np.array(row["tensions"][: row["known"]]),
            contacts=row["contacts"],
            nearest=place,
            wall=near.foot[place],
            clearance=float(room[place]),
            hand=tick["hand"],
            felt=tick["felt"],
            virtual=signals[self._virtual],
            tip_force=-self._axes @ signals[self._virtual],
            pushed=int(row["pushed"]),
            body_force=float(tick["stiffness"]) * row["push"],
            tracking_error=float(np.linalg.norm(signals[self._desired] - signals[self._tip])),
            energies=signals[self._energy],
            energy_least=board.get("least_j"),
            status=STATUSES[int(row["status"])],
            limits=active_names(row),
            reason=bytes(row["reason"]).decode(),
            solve_time=float(row["solve_time"]),
            connected=bool(tick["connected"]),
            held=bool(tick["held"]),
            paused=bool(tick["paused"]),
            share=float(tick["share"]),
            late=bool(board.get("late")),
            real_time_factor=min(done / passed, 1.0) if passed > 0.0 else 1.0,
            misses=board.get("misses"),
            steps=board.get("steps"),
            times=tuple(board.times[kind].quantiles for kind in Timed),
        )
