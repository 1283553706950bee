"""The shapes of a run as plain data, enough to draw them again."""

from typing import Any

import numpy as np

from sinuous.papers.experiment import Data
from sinuous.recording import Header, Recording, Sample

STEPS = 40
"""How many of a run's steps are kept."""

DIGITS = 6
"""Of metres: a micrometre, far below what a picture shows."""


def sketch(recording: Recording) -> dict[str, Any]:
    """Some of the true shapes of a run and their targets, the first and the last too.

    They are evenly spaced along the way of the tip, so that no time at rest is kept.
    """
    moves = np.linalg.norm(np.diff(recording.actual_tip, axis=0), axis=1)
    way = np.concatenate(([0.0], np.cumsum(moves)))
    kept = np.unique(np.searchsorted(way, np.linspace(0.0, way[-1], STEPS)))
    jumps = np.flatnonzero(np.any(np.diff(recording.target, axis=0) != 0.0, axis=1))
    kept = np.unique(np.concatenate([kept, jumps, jumps + 1, [len(recording) - 1]]))
    return {
        "time_s": recording.time[kept].tolist(),
        "target_m": recording.target[kept].round(DIGITS).tolist(),
        "points_m": recording.actual_points[kept].round(DIGITS).tolist(),
    }


def unsketch(data: Data, header: Header) -> Recording:
    """A recording that holds what a sketch kept; what it left out is zero."""
    nothing = np.zeros(len(header.actuator_names))
    samples = [
        Sample(
            time=time,
            target=np.array(target),
            configuration=np.zeros(0),
            lengths=nothing,
            rates=nothing,
            nominal_points=points,
            nominal_tip=points[-1],
            nominal_clearance=0.0,
            local_rates=nothing,
            clipped=0.0,
            offset=np.zeros(3),
            measured_points=points,
            measured_tip=points[-1],
            measured_lengths=nothing,
            actual_points=points,
            actual_tip=points[-1],
            actual_clearance=0.0,
            status="",
            solve_time=0.0,
            iterations=0,
            planes=0,
            step_fraction=0.0,
            active=(),
        )
        for time, target, points in zip(
            data["time_s"], data["target_m"], np.array(data["points_m"]), strict=True
        )
    ]
    return Recording.from_samples(header, samples)
