"""From recordings to a calibrated robot: identification, joint fit, cross-validation."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from sinuous.arrays import Array
from sinuous.calibration.cross_validation import cross_validate, from_single_segments
from sinuous.calibration.fit import Fit, fit
from sinuous.calibration.found import Estimate, estimates
from sinuous.calibration.guess import guess
from sinuous.calibration.judge import Judgement
from sinuous.calibration.parameters import parameters
from sinuous.calibration.problem import Problem, Sequence
from sinuous.calibration.pulls import Identified, are_pulls, identify
from sinuous.calibration.recording import Recording, check_fits, check_units
from sinuous.errors import InputError
from sinuous.robots.pcc import PccRobot

# A recording without names of movements is cut into so many pieces of equal length.
PIECES = 10

Observer = Callable[[str], None]


@dataclass(frozen=True, kw_only=True, eq=False)
class Calibration:
    """What came out.

    Arguments:
        problem: what was fitted to what
        fit: its parameters
        motors: names of the motors, in the order of the recording
        found: values in the words of the robot, with intervals
        names: of the movements
        errors: of all rows (T, 3) [m]
        left_out: the same, predicted without their own movements; nan for single pulls
        from_single: the same of movements of several segments, predicted from those of one
        pulls_given: whether there were single pulls to identify the motors by
    """

    problem: Problem
    fit: Fit
    motors: tuple[str, ...]
    found: Mapping[str, Estimate]
    names: tuple[str, ...]
    errors: Array
    left_out: Array
    from_single: Array
    pulls_given: bool

    def judge(self, errors: Array) -> Judgement | None:
        """Judge the rows (T, 3) that are not nan; None if all are."""
        rows = np.all(np.isfinite(errors), axis=1)
        if not np.any(rows):
            return None
        return Judgement(
            errors=errors[rows], patterns=self.problem.patterns[rows], names=self.names
        )

    @property
    def train(self) -> Judgement:
        """Of what was fitted, single pulls aside if there is more."""
        free = ~self.problem.own_zeros
        rows = free if np.any(free) else ~free
        return Judgement(
            errors=self.errors[rows], patterns=self.problem.patterns[rows], names=self.names
        )

    @property
    def pulls(self) -> Judgement | None:
        """Of the single pulls."""
        own = self.problem.own_zeros[:, None]
        return self.judge(np.where(own, self.errors, np.nan))

    @property
    def cross_validation(self) -> Judgement | None:
        """Of what was left out; None if there was one movement only."""
        return self.judge(self.left_out)

    def predict(self, recording: Recording) -> Array:
        """Tips (T, 3) [m] of another recording of the same robot, in time order.

        Raises:
            InputError: if it has other motors
        """
        return self.problem.tips(self.fit.x, self._sequence(recording))

    def validate(self, recording: Recording) -> Judgement:
        """Judge a recording that was not fitted.

        Raises:
            InputError: if it has other motors, or a unit is wrong
        """
        sequence = self._sequence(recording)
        check_units(recording, self.problem.robot)
        return Judgement(
            errors=self.problem.tips(self.fit.x, sequence) - sequence.tips,
            patterns=recording.patterns,
            names=recording.names,
        )

    def _sequence(self, recording: Recording) -> Sequence:
        return _sequence(in_order(recording, self.motors), self.problem.identified, own_zeros=False)


def calibrate(
    data: Recording, robot: PccRobot, *, pulls: Recording | None = None,
    observe: Observer = lambda note: None,
) -> Calibration:  # fmt: skip
    """Fit a robot to a recording.

    Arguments:
        data: movements of the robot; rows that `pulls` has as well count once
        robot: as its file says, cables counted at the motors
        pulls: every cable pulled alone, all others let go; without, such movements in `data`, or
            if there are none, motors are taken to be in the order of the robot's cables
        observe: told what is done

    Raises:
        InputError: if recordings and robot do not fit
    """
    _check_kind(robot)
    check_fits(data, robot)
    if pulls is None:
        alone = are_pulls(data)
        single = data.rows(alone) if np.any(alone) else None
        moves = data.rows(~alone)
    else:
        single = in_order(pulls, data.motors)
        check_fits(single, robot)
        moves = data.rows(~np.isin(data.times, single.times))
    observe("identifying the motors")
    identified = guess(moves, robot) if single is None else identify(single, robot)
    names, sequences = list[str](), list[Sequence]()
    for recording in (single, moves):
        if recording is not None and len(recording.times):
            sequence = _sequence(recording, identified, own_zeros=recording is single)
            sequences.append(replace(sequence, patterns=sequence.patterns + len(names)))
            names += recording.names
    problem = Problem(
        robot=robot,
        identified=identified,
        parameters=parameters(robot, own_zeros=single is not None and len(sequences) > 1),
        sequences=tuple(sequences),
    )
    fitted = fit(problem, np.ones(len(problem.patterns), dtype=np.bool_), observe=observe)
    return Calibration(
        problem=problem,
        fit=fitted,
        motors=data.motors,
        found=estimates(problem, fitted),
        names=tuple(names),
        errors=problem.residuals(fitted.x),
        left_out=cross_validate(problem, fitted, observe=observe),
        from_single=from_single_segments(problem, fitted, observe=observe),
        pulls_given=single is not None,
    )


def in_order(recording: Recording, motors: tuple[str, ...]) -> Recording:
    """The recording with its motors in another order.

    Raises:
        InputError: if it has other motors
    """
    if set(recording.motors) != set(motors):
        raise InputError(
            file=recording.file,
            field="row 1",
            expected=f"the motors {', '.join(motors)}, as in the recording that is fitted",
            found=", ".join(recording.motors),
            remedy="Give the motors the same names in all files.",
        )
    order = [recording.motors.index(name) for name in motors]
    return replace(recording, motors=motors, readings=recording.readings[:, order])


def _sequence(recording: Recording, identified: Identified, *, own_zeros: bool) -> Sequence:
    return Sequence(
        pulls=identified.pulls(recording),
        tips=recording.tips,
        patterns=recording.patterns,
        own_zeros=own_zeros,
    )


def in_pieces(recording: Recording) -> Recording:
    """The recording, cut into pieces if its movements have no names."""
    if len(recording.names) > 1:
        return recording
    count = min(PIECES, len(recording.times))
    return replace(
        recording,
        patterns=(np.arange(len(recording.times)) * count) // len(recording.times),
        names=tuple(f"piece {k + 1}" for k in range(count)),
    )


def _check_kind(robot: PccRobot) -> None:
    fixed = robot.insertion is None and not any(s.extensible for s in robot.segments)
    if not fixed or robot.convention.value != "motor":
        raise InputError(
            file=robot.name,
            expected="a robot of segments of fixed length on a fixed base, with "
            'cable_convention = "motor"',
            found="another one",
            remedy="Only such robots can be calibrated; correct the robot file.",
        )
