"""Judges and records what both loops have written, in its own time."""

import numpy as np

from sinuous.arrays import Array
from sinuous.live.board import Board, Row
from sinuous.live.samples import sample_of
from sinuous.recording import Recorder
from sinuous.scenario import Scenario
from sinuous.session.surface import SurfaceClearance, least_clearance
from sinuous.summary import MARGIN_TOLERANCE

BACKLOG = 30
"""Samples that may wait to be judged finely; if more do, some are judged by the controller's own
body points, which takes a tenth of the time."""


class Watch:
    """Follows a board from sample to sample; it reads, and nobody waits for it.

    Arguments:
        scenario: what is done
        board: where both loops write
    """

    def __init__(self, scenario: Scenario, board: Board) -> None:
        self._scenario, self._board = scenario, board
        self._surface = SurfaceClearance.of(scenario.robot, scenario.zone)
        self._next = 0
        self.recorder: Recorder | None = None
        self.samples = self.fine = self.lost = self.violations = 0
        self.least = self.clearance = np.inf

    @property
    def is_behind(self) -> bool:
        """Whether more than one sample waits."""
        return self._next + 1 < self._board.samples.written

    def catch_up(self, most: int) -> None:
        """Deal with what is there, as far as that many samples.

        Raises:
            InputError: if the recording cannot be written
        """
        for _ in range(most):
            written = self._board.samples.written
            if self._next >= written:
                return
            row = self._board.samples.read(self._next)
            if row is None:  # overwritten: this process was kept from running for long
                behind = written - self._board.samples.capacity // 2
                self.lost += behind - self._next
                self._next = behind
                continue
            signals = self._signals(row)
            if signals is None:
                return  # its last tick is still to come
            self._deal(row, signals, fine=written - self._next <= BACKLOG)
            self._next += 1

    def _signals(self, row: Row) -> Array | None:
        """Those of its ticks (k, C); None if they are not all there yet, empty if no longer."""
        first, ticks = int(row["first_tick"]), int(row["ticks"])
        if first + ticks > self._board.ticks.written:
            return None
        block = self._board.ticks.block(first, ticks, "signals")
        return np.zeros((0, self._board.sizes.signals)) if block is None else block

    def _stiffness(self, row: Row) -> float:
        """Of walls, in the first of its ticks [N/m]; zero if that is no longer there."""
        block = self._board.ticks.block(int(row["first_tick"]), 1, "stiffness")
        return 0.0 if block is None else float(block[0])

    def _deal(self, row: Row, signals: Array, *, fine: bool) -> None:
        robot, zone = self._scenario.robot, self._scenario.zone
        if fine:
            self.clearance = self._surface.least(row["before"], row["c"])
        else:
            self.clearance = least_clearance(zone, robot, row["nominal"])
        self.samples += 1
        self.fine += fine
        self.least = min(self.least, self.clearance)
        # Written so that a clearance that is no number counts.
        margin = self._scenario.mpc.margin
        self.violations += not self.clearance >= margin - MARGIN_TOLERANCE
        if self.recorder is not None:
            self.recorder.write(
                sample_of(
                    robot,
                    row,
                    signals=signals,
                    stiffness=self._stiffness(row),
                    nominal_clearance=self.clearance,
                    actual_clearance=least_clearance(zone, robot, row["actual"]),
                )
            )
