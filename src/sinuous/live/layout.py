"""What the processes of a session share: rows of a fixed layout."""

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from sinuous.live.times import BINS
from sinuous.scenario import Scenario
from sinuous.session.by_hand import signal_names
from sinuous.teleop.motion import NO_WALLS

TICKS, TIPS, STEPS = 16384, 1024, 1024
"""Ticks, tips and samples that are kept: about 16, 1 and 10 s."""

WALLS = np.array(NO_WALLS).shape
"""Of `teleop.motion.Walls` as an array."""

TEXT = 1024  # bytes of what limits the robot, and of faults


class Timed(IntEnum):
    """What is timed."""

    TICK = 0  # how late the 1 kHz loop is
    WORK = 1  # what a tick of it takes
    STEP = 2  # how late the controller begins
    SOLVE = 3  # what it takes
    COMMAND = 4  # from when a step was due to its command
    MESSAGE = 5  # from a message's arrival to the first command that knows of it
    IDLE = 6  # how late a loop beside it is that does nothing


class Part(IntEnum):
    """Who may fail."""

    HAND = 0
    ROBOT = 1


@dataclass(frozen=True, kw_only=True)
class Sizes:
    """How much there is of a robot and its operator.

    Arguments:
        configuration: its coordinates
        actuators: their number
        points: of the body
        signals: of the operator, recorded at every tick
    """

    configuration: int
    actuators: int
    points: int
    signals: int

    @classmethod
    def of(cls, scenario: Scenario) -> "Sizes":
        """Those of a scenario with an operator."""
        assert scenario.teleop is not None
        return cls(
            configuration=len(scenario.first_configuration),
            actuators=len(scenario.robot.actuator_names),
            points=len(scenario.robot.radii),
            signals=len(signal_names(scenario.teleop.axes)),
        )

    @property
    def board(self) -> np.dtype[Any]:
        """All that is shared."""
        return np.dtype(
            [
                ("go", "f8"),  # when tick 0 is due [s]; zero: not yet
                ("stop", "i8"),  # set: end
                ("ready", "i8", (2,)),  # by `Part`
                ("ticks", "i8"),  # written
                ("tips", "i8"),  # written
                ("steps", "i8"),  # taken
                ("samples", "i8"),  # written
                ("orders", "i8"),  # sent to the hand's side
                ("late", "i8"),  # set: simulated time stands, because the robot's side is late
                ("misses", "i8"),  # commands after the next step was due
                ("holding", "i8"),  # steps in which no safe command was found
                ("slipped", "f8"),  # what simulated time has lost [s]
                ("least_j", "f8"),  # smallest energy of the channel [J]
                ("fault", f"S{TEXT}", (2,)),  # by `Part`
                ("counts", "i8", (len(Timed), BINS)),
                ("worst", "f8", (len(Timed), 1)),
                ("tick", self.tick, (TICKS,)),
                ("tip", "f8", (TIPS, 3)),  # after so many ticks [m]
                ("wall", "f8", (TIPS, *WALLS)),  # what was known of them then [m]
                ("sample", self.sample, (STEPS,)),
            ],
            align=True,
        )

    @property
    def tick(self) -> np.dtype[Any]:
        """A tick of the operator's side."""
        return np.dtype(
            [
                ("number", "i8"),
                ("due", "f8"),  # [s]
                ("began", "f8"),  # when what had arrived was read [s]
                ("target", "f8", (3,)),  # for the tip [m]
                ("hand", "f8", (3,)),  # where the device says the hand is [m]
                ("felt", "f8", (3,)),  # force on the hand [N]
                ("stiffness", "f8"),  # of walls [N/m]
                ("share", "f8"),  # by which the leader's end takes part
                ("held", "i8"),
                ("connected", "i8"),
                ("paused", "i8"),  # by `hand.Pause`
                ("signals", "f8", (self.signals,)),
            ],
            align=True,
        )

    @property
    def sample(self) -> np.dtype[Any]:
        """A control step, or some of a fast controller: see `recording.Sample`."""
        p, s = self.actuators, self.points
        return np.dtype(
            [
                ("number", "i8"),
                ("first_tick", "i8"),
                ("ticks", "i8"),  # of the hand's side that belong to it
                ("time", "f8"),
                ("target", "f8", (3,)),
                ("before", "f8", (self.configuration,)),  # nominal, when it begins
                ("c", "f8", (self.configuration,)),
                ("rates", "f8", (p,)),
                ("local", "f8", (p,)),
                ("clipped", "f8"),
                ("offset", "f8", (3,)),
                ("nominal", "f8", (s, 3)),
                ("seen", "i8"),  # points that were measured
                ("measured", "f8", (s, 3)),
                ("measured_tip", "f8", (3,)),
                ("measured_lengths", "f8", (p,)),
                ("actual", "f8", (s, 3)),
                ("actual_tip", "f8", (3,)),
                ("known", "i8"),  # cables whose tension the plant knows
                ("tensions", "f8", (p,)),
                ("contacts", "f8", (3,)),
                ("pushed", "i8"),  # body point that walls push the most, see `control.wall_force`
                ("push", "f8", (3,)),  # on it, by the stiffness [m]
                ("status", "i8"),  # place in `Status`
                ("solve_time", "f8"),
                ("iterations", "i8"),
                ("planes", "i8"),
                ("step_fraction", "f8"),
                ("active", f"S{TEXT}"),
                ("reason", f"S{TEXT}"),
            ],
            align=True,
        )
