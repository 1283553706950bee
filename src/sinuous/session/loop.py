"""The loop on simulated time: operator or path, controller, plant, sample."""

from collections.abc import Iterator
from dataclasses import replace
from math import ceil

import numpy as np

from sinuous.arrays import Array
from sinuous.control.controller import ControllerState
from sinuous.control.report import Command, Report
from sinuous.measurement import Measurement
from sinuous.plants.plant import NO_CONTACT, Contacts, PlantFault, Truth
from sinuous.recording import Sample, status_name
from sinuous.robots.cables import cable_rows
from sinuous.robots.robot import Robot
from sinuous.scenario import Scenario
from sinuous.scenario.path import Leg
from sinuous.session.guide import guide_of
from sinuous.session.lookout import Lookout
from sinuous.session.surface import SurfaceClearance, least_clearance
from sinuous.teleop.motion import NO_WALLS

# A body whose points all move slower than this [m/s], for that many steps, rests.
REST_SPEED = 1e-4
REST_STEPS = 10

# Controllers whose steps are shorter than that are looked at every so often, not at every step [s].
FAST, SAMPLE = 0.005, 0.03


def steps(scenario: Scenario) -> Iterator[Sample]:
    """Yield every sample of a scenario's run; a sample's time is that of its end.

    A sample is one control step, or some of a fast controller. A leg ends when its target no
    longer moves and the body rests, or after its largest number of steps. The wall clock is never
    read but for the controller's own solve time. The controller sees what sensors yield, never
    how the plant is.

    Raises:
        PlantFault: if the plant fails, or measures something that is not a finite number
    """
    loop = _Loop(scenario)
    for leg in loop.legs:
        yield from loop.leg(leg)


class _Loop:
    """One run: what happens on its clock, from tick to tick."""

    def __init__(self, scenario: Scenario) -> None:
        self._scenario = scenario
        self._controller, self._plant = scenario.controller, scenario.new_plant()
        self._dt, start = scenario.controller.dt, scenario.first_configuration
        self._guide = guide_of(scenario)
        self._ticks = round(self._dt / self._guide.tick)
        self._surface = SurfaceClearance.of(scenario.robot, scenario.zone)
        self._state: ControllerState = self._controller.init(start)
        self._measured: Measurement | None = None
        self._tip, self._walls = scenario.robot.tip(start), NO_WALLS
        self._lookout = Lookout(scenario)
        self._steps = 0

    @property
    def legs(self) -> tuple[Leg, ...]:
        """The legs of the path; one for all for an operator who goes along it in his own time."""
        path, teleop = self._scenario.path, self._scenario.teleop
        if teleop is None or not teleop.is_free:
            return path
        steps = sum(leg.steps(self._dt) for leg in path)
        return (replace(path[-1], moving=0.0, max_steps=steps),)

    def leg(self, leg: Leg) -> Iterator[Sample]:
        """Yield the samples of one leg."""
        stride = steps_per_sample(self._dt)
        rest = Rest(stride * self._dt, self._guide.patience)
        left, done = leg.steps(self._dt), 0
        self._guide.begin(leg)
        while done < left:
            last = min(done + stride, left)
            sample, points = self._sample(last - done)
            yield sample
            done = last
            if rest.after(points) and done * self._dt >= leg.moving:
                break

    def _sample(self, steps: int) -> tuple[Sample, Array]:
        """Take some control steps; what happened, and where the nominal body then is."""
        clearance, clipped, longest, before = np.inf, 0.0, 0.0, self._state.c
        command, target, contacts = None, None, NO_CONTACT
        for _ in range(steps):
            command, target = self._step()
            contacts = contacts.worst(self._plant.truth.contacts)
            clipped = max(clipped, command.clipped)
            longest = max(longest, command.report.solve_time)
            if self._scenario.zone.surfaces:
                after = self._state.c
                clearance, before = min(clearance, self._surface.least(before, after)), after
        assert command is not None
        assert target is not None
        assert self._measured is not None
        self._steps += steps
        truth = self._plant.truth
        if not is_finite(self._measured, truth):
            raise PlantFault("it measured something that is not a finite number")
        sample = _sample(
            self._scenario,
            time=self._steps * self._dt,
            target=target,
            c=self._state.c,
            command=command,
            measured=self._measured,
            truth=truth,
            clearance=clearance,
            clipped=clipped,
            solve_time=longest,
            contacts=contacts,
            signals=self._guide.take(),
        )
        return sample, command.report.points

    def _step(self) -> tuple[Command, Array]:
        """One control step: the controller acts in the first of its ticks."""
        guide, plant, tick = self._guide, self._plant, self._guide.tick
        target = guide.target(self._tip, self._walls)
        self._state, command = self._controller.step(self._state, target, self._measured)
        walls = self._lookout.walls(self._state.c, target, command.report)
        measured = plant.step(command.rates, tick)
        for _ in range(1, self._ticks):
            guide.target(measured.tip, walls)
            measured = plant.step(command.rates, tick)
        self._measured, self._tip, self._walls = measured, measured.tip, walls
        return command, target


def steps_per_sample(dt: float) -> int:
    """Control steps in one sample: one, or of fast controllers as many as make up `SAMPLE`."""
    return round(SAMPLE / dt) if dt < FAST else 1


class Rest:
    """Tells when a body has come to rest.

    Arguments:
        dt: time between shapes [s]
        patience: time for which it must rest, at least [s]
    """

    def __init__(self, dt: float, patience: float = 0.0) -> None:
        self._largest_step = REST_SPEED * dt
        self._enough = max(REST_STEPS, ceil(patience / dt))
        self._points: Array | None = None
        self._still = 0

    def after(self, points: Array) -> bool:
        """Whether the body rests, now that its points are (S, 3) [m]."""
        if self._points is not None:
            moved = float(np.max(np.linalg.norm(points - self._points, axis=1)))
            self._still = self._still + 1 if moved < self._largest_step else 0
        self._points = points
        return self._still >= self._enough


def slack_cables(robot: Robot, tensions: Array) -> Iterator[str]:
    """Cables without tension, as far as tensions (C,) [N] are known."""
    if len(tensions):
        for row in cable_rows(robot)[tensions <= 0.0]:
            yield f"{robot.actuator_names[row]} is slack"


def is_finite(measured: Measurement, truth: Truth) -> bool:
    """Whether all that is measured, and all that is true, can be computed with."""
    values = (
        measured.points,
        measured.tip,
        measured.lengths,
        truth.points,
        truth.T_w_t,
        truth.lengths,
    )
    return all(bool(np.all(np.isfinite(value))) for value in values)


def _body_force(scenario: Scenario, report: Report) -> Array:
    """Of walls on the point that they push the most (3,) [N]; zero without an operator."""
    if scenario.teleop is None or report.walls is None:
        return np.zeros(3)
    return scenario.teleop.table.force.stiffness * report.walls.body


def _sample(
    scenario: Scenario,
    *,
    time: float,
    target: Array,
    c: Array,
    command: Command,
    measured: Measurement,
    truth: Truth,
    clearance: float,
    clipped: float,
    solve_time: float,
    contacts: Contacts,
    signals: Array,
) -> Sample:
    robot, report = scenario.robot, command.report
    known = command.tensions if len(command.tensions) else measured.tensions
    return Sample(
        time=time,
        target=target,
        configuration=c,
        lengths=robot.lengths(c),
        rates=command.rates,
        nominal_points=report.points,
        nominal_tip=report.points[-1],
        nominal_clearance=clearance,
        measured_points=measured.points,
        measured_tip=measured.tip,
        measured_lengths=measured.lengths,
        local_rates=command.local if len(command.local) else np.zeros(len(command.rates)),
        clipped=clipped,
        offset=command.offset,
        actual_points=truth.points,
        actual_tip=truth.T_w_t[:3, 3],
        actual_clearance=least_clearance(scenario.zone, robot, truth.points),
        status=status_name(report.status),
        solve_time=solve_time,
        iterations=report.iterations,
        planes=report.planes,
        step_fraction=report.step_fraction,
        active=(*(active.name for active in report.active), *slack_cables(robot, known)),
        tensions=truth.tensions,
        contacts=np.array(contacts),
        pushed=0 if report.walls is None else report.walls.pushed,
        body_force=_body_force(scenario, report),
        signals=signals,
    )
