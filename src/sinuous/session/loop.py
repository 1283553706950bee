"""The loop on simulated time: target, controller, plant, sample."""

from collections.abc import Iterator

import numpy as np

from sinuous.arrays import Array
from sinuous.control.report import Command
from sinuous.measurement import Measurement
from sinuous.plants.plant import Truth
from sinuous.recording import Sample, status_name
from sinuous.scenario import Scenario
from sinuous.session.surface import SurfaceClearance, least_clearance

# A body whose points all move slower than this [m/s], for that many steps, rests.
REST_SPEED = 1e-4
REST_STEPS = 10


class PlantFailure(Exception):
    """The plant measured something that is not a finite number."""


def steps(scenario: Scenario) -> Iterator[Sample]:
    """Yield every step of a scenario; a sample's time is that of the step's end.

    A leg ends when its target no longer moves and the body rests, or after its largest
    number of steps. The wall clock is never read but for the controller's own solve time.
    The controller sees what sensors yield, never how the plant is.

    Raises:
        PlantFailure: if the plant measures something that is not a finite number
    """
    controller, plant = scenario.controller, scenario.new_plant()
    dt, measured = controller.dt, None
    surface = SurfaceClearance.of(scenario.robot, scenario.zone)
    state, count = controller.init(scenario.first_configuration), 0
    for leg in scenario.path:
        rest = Rest(dt)
        for step in range(1, leg.steps(dt) + 1):
            count += 1
            before, target = state.c, leg.at(step * dt)
            state, command = controller.step(state, target, measured)
            measured = plant.step(command.rates, dt)
            truth = plant.truth
            if not _finite(measured, truth):
                raise PlantFailure
            yield _sample(
                scenario,
                time=count * dt,
                target=target,
                c=state.c,
                command=command,
                measured=measured,
                truth=truth,
                clearance=surface.least(before, state.c),
            )
            if rest.after(command.report.points) and step * dt >= leg.moving:
                break


class Rest:
    """Tells when a body has come to rest.

    Arguments:
        dt: time between shapes [s]
    """

    def __init__(self, dt: float) -> None:
        self._largest_step = REST_SPEED * dt
        self._points: Array | None = None
        self._still = 0

    def after(self, points: Array) -> bool:
        """Whether the body rests, now that its points are (S, 3) [m]."""
        if self._points is not None:
            moved = float(np.max(np.linalg.norm(points - self._points, axis=1)))
            self._still = self._still + 1 if moved < self._largest_step else 0
        self._points = points
        return self._still >= REST_STEPS


def _finite(measured: Measurement, truth: Truth) -> bool:
    values = (
        measured.points,
        measured.tip,
        measured.lengths,
        truth.points,
        truth.T_w_t,
        truth.lengths,
    )
    return all(bool(np.all(np.isfinite(value))) for value in values)


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
) -> Sample:
    robot, report = scenario.robot, command.report
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
        clipped=command.clipped,
        offset=command.offset,
        actual_points=truth.points,
        actual_tip=truth.T_w_t[:3, 3],
        actual_clearance=least_clearance(scenario.zone, robot, truth.points),
        status=status_name(report.status),
        solve_time=report.solve_time,
        iterations=report.iterations,
        planes=report.planes,
        step_fraction=report.step_fraction,
        active=tuple(active.name for active in report.active),
    )
