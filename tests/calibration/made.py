"""Recordings of a robot that nobody built: simulated with parameters that are known."""

from dataclasses import replace

import numpy as np

from sinuous.arrays import Array
from sinuous.calibration.parameters import Parameters, parameters
from sinuous.calibration.problem import Problem, Sequence
from sinuous.calibration.pulls import Identified, base_pose
from sinuous.calibration.recording import Recording
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_pcc

ROBOT = load_pcc("opencr_v4")
LENGTH = sum(segment.home_length for segment in ROBOT.segments)
# Which cable every motor pulls, and which way: what a recording does not say.
ORDER = np.array([4, 7, 2, 0, 8, 1, 6, 3, 5])
SIGNS = np.array([1, -1, 1, 1, -1, -1, 1, 1, -1])
NAMES = tuple(f"motor_{k}_mm" for k in range(9))
TURN = np.deg2rad(-172.0)
NOISE = 0.5e-3  # of the tracker [m]


def truth(seed: int, layout: Parameters) -> Array:
    """Parameters drawn from half of what is expected of a real robot."""
    rng = np.random.default_rng(seed)
    x = layout.start + 0.5 * layout.spread * rng.normal(size=len(layout))
    x[layout.place("play")] = 0.1e-3
    x[layout.place("log_friction")] = layout.start[layout.place("log_friction")]
    x[layout.place("base_rotation")] = rng.normal(0.0, 0.05, 3)
    return x


def commands(robot: PccRobot = ROBOT) -> list[Array]:
    """Pulls (T, 9) [m] of movements: single segments there and back, two at once, a spiral."""
    straight = robot.lengths(np.zeros(6))
    ramp = np.concatenate([np.linspace(0, 1, 5), np.linspace(0.9, 0, 4)])
    out = list[Array]()
    for j in range(3):
        for angle in np.deg2rad([20, 140, 260]):
            c = np.zeros((len(ramp), 6))
            c[:, 2 * j] = 0.9 * ramp * np.cos(angle)
            c[:, 2 * j + 1] = 0.9 * ramp * np.sin(angle)
            out.append(straight - robot.lengths(c))
    for first, second, sign in ((0, 1, 1), (0, 2, -1), (1, 2, 1)):
        c = np.zeros((len(ramp), 6))
        c[:, 2 * first], c[:, 2 * second + 1] = 0.7 * ramp, 0.6 * sign * ramp
        out.append(straight - robot.lengths(c))
    spin = np.linspace(0, 4 * np.pi, 24)
    c = np.zeros((24, 6))
    for j in range(3):
        c[:, 2 * j] = 0.4 * spin / spin[-1] * np.cos(spin + j)
        c[:, 2 * j + 1] = 0.4 * spin / spin[-1] * np.sin(spin + j)
    out.append(straight - robot.lengths(c))
    return out


def single_pulls() -> list[Array]:
    """Pulls (T, 9) [m] of every cable alone, the others let go."""
    way = np.concatenate([np.linspace(-4, 3.5, 7), np.linspace(2, -4, 3)]) * 1e-3
    out = list[Array]()
    for cable in range(9):
        pulls = np.full((len(way), 9), -10e-3)
        pulls[:, cable] = way
        out.append(pulls)
    return out


def problem(movements: list[Array], alone: list[Array]) -> Problem:
    """The robot as it is built, tips still to come."""
    rest = np.array([1e-3, -2e-3, LENGTH])
    sequences = [
        Sequence(
            pulls=np.concatenate(pulls),
            tips=np.zeros((sum(map(len, pulls)), 3)),
            patterns=np.repeat(np.arange(len(pulls)), [len(each) for each in pulls]),
            own_zeros=own,
        )
        for pulls, own in ((alone, True), (movements, False))
        if pulls
    ]
    return Problem(
        robot=ROBOT,
        identified=Identified(
            motors=np.arange(9),
            directions=np.ones(9),
            T_t_b=base_pose(np.array([0.0, 0.0, 1.0]), TURN, rest, LENGTH),
            mismatch=0.0,
        ),
        parameters=parameters(ROBOT, own_zeros=bool(alone)),
        sequences=tuple(sequences),
    )


def simulated(
    x: Array, movements: list[Array], alone: list[Array], *, seed: int, noise: float = NOISE
) -> Problem:
    """The problem with the tips that parameters x make, as a tracker sees them."""
    bare, rng = problem(movements, alone), np.random.default_rng(seed)
    seen = tuple(
        replace(
            each,
            tips=bare.tips(x, each) + rng.normal(0, noise, each.tips.shape),
            patterns=each.patterns + (len(alone) if not each.own_zeros else 0),
        )
        for each in bare.sequences
    )
    return replace(bare, sequences=seen)


def recording(made: Problem, number: int, *, start: float) -> Recording:
    """One of its sequences as a recording, motors in their own order and directions."""
    sequence = made.sequences[number]
    patterns = sequence.patterns - sequence.patterns.min()
    return Recording(
        file=f"made {number}.csv",
        times=start + 0.5 * np.arange(len(sequence.tips)),
        motors=NAMES,
        readings=sequence.pulls[:, ORDER] * SIGNS,
        tips=sequence.tips,
        patterns=patterns,
        names=tuple(f"movement {k}" for k in range(int(patterns.max()) + 1)),
    )


def as_csv(recorded: Recording, *, unit: float = 1e3, header: dict[str, str] | None = None) -> str:
    """A recording as the text of a file."""
    names = ["timestamp", "pattern_label", *recorded.motors, "tip_x", "tip_y", "tip_z"]
    lines = [",".join((header or {}).get(name, name) for name in names)]
    for k, time in enumerate(recorded.times):
        numbers = [*(unit * recorded.readings[k]), *(unit * recorded.tips[k])]
        label = recorded.names[recorded.patterns[k]]
        lines.append(",".join([repr(float(time)), label, *(repr(float(v)) for v in numbers)]))
    return "\n".join(lines) + "\n"
