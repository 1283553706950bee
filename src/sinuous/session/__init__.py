"""Runs a scenario: target, controller, plant and recording on one simulated clock."""

from sinuous.session.loop import REST_SPEED, REST_STEPS, Rest, steps, steps_per_sample
from sinuous.session.runner import End, Result, run

__all__ = [
    "REST_SPEED",
    "REST_STEPS",
    "End",
    "Rest",
    "Result",
    "run",
    "steps",
    "steps_per_sample",
]
