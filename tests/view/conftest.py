"""A made-up but plausible run: an arm of two arcs bends its way through a curved tube."""

from collections.abc import Callable

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.control.report import Status
from sinuous.recording import Header, Recording, Sample, ZonePart, status_name

DT = 1.0 / 30.0
POINTS = 41
BEND_RADIUS = 0.08
TUBE_RADIUS = 0.022
BODY_RADIUS = 0.008
MARGIN = 0.0047
PITCH = 0.007
ANGLES = np.array([0.0, 2.0, 4.0]) * np.pi / 3.0
RATES = np.array([0.02, 0.02, 0.02, 0.01] * 2 + [0.015])
NAMES = (
    *(
        f"segment {s} {part}"
        for s in (1, 2)
        for part in ("cable 1", "cable 2", "cable 3", "backbone")
    ),
    "insertion",
)
# One row per way-point: bend about y and x of both segments [rad], their lengths and the
# insertion [m].
WAY_POINTS = np.array(
    [
        [0.30, 0.00, 0.35, 0.00, 0.028, 0.030, 0.000],
        [0.48, 0.12, 0.60, 0.05, 0.042, 0.048, 0.002],
        [0.62, -0.08, 0.80, -0.05, 0.052, 0.064, 0.004],
        [0.68, 0.08, 0.76, 0.06, 0.054, 0.062, 0.004],
    ]
)


def arc(
    bend_x: float, bend_y: float, length: float, pose: Array, count: int
) -> tuple[Array, Array]:
    """Points along a constant-curvature arc and the pose at its end."""
    angle = max(float(np.hypot(bend_x, bend_y)), 1e-9)
    direction = np.array([bend_x, bend_y]) / angle
    s = np.linspace(0.0, angle, count)
    radius = length / angle
    across, along = radius * (1.0 - np.cos(s)), radius * np.sin(s)
    local = np.column_stack((across * direction[0], across * direction[1], along))
    axis = np.array([-direction[1], direction[0], 0.0])
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turn = np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * (k @ k)
    end = pose.copy()
    end[:3, 3] = pose[:3, :3] @ local[-1] + pose[:3, 3]
    end[:3, :3] = pose[:3, :3] @ turn
    return local @ pose[:3, :3].T + pose[:3, 3], end


def body(c: Array) -> Array:
    """Points of the arm's backbone."""
    pose = np.eye(4)
    pose[2, 3] = c[6]
    first, pose = arc(c[0], c[1], c[4], pose, POINTS // 2 + 1)
    second, _ = arc(c[2], c[3], c[5], pose, POINTS // 2 + 1)
    return np.concatenate((first, second[1:]))


def lengths(c: Array) -> Array:
    """Cable and backbone lengths of both segments, and the insertion."""
    parts = [
        (
            *(c[4 + i] - PITCH * (c[2 * i] * np.cos(ANGLES) + c[2 * i + 1] * np.sin(ANGLES))),
            c[4 + i],
        )
        for i in range(2)
    ]
    return np.array([*parts[0], *parts[1], c[6]])


def clearance(points: Array) -> float:
    """Least distance of the body surface to a tube around a circular arc in the x-z plane."""
    across = np.hypot(points[:, 0] - BEND_RADIUS, np.maximum(points[:, 2], 0.0)) - BEND_RADIUS
    return float(np.min(TUBE_RADIUS - np.hypot(across, points[:, 1])) - BODY_RADIUS)


def tube() -> Array:
    """Triangles of that tube."""
    s = np.linspace(-0.05, 1.9, 30)
    around = np.linspace(0.0, 2.0 * np.pi, 25)
    reach = BEND_RADIUS - TUBE_RADIUS * np.cos(around)
    x = BEND_RADIUS - np.cos(s)[:, None] * reach
    z = np.sin(s)[:, None] * reach
    y = np.broadcast_to(TUBE_RADIUS * np.sin(around), x.shape)
    p = np.stack((x, y, z), axis=-1)
    a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    return np.concatenate((np.stack((a, b, c), axis=2), np.stack((a, c, d), axis=2))).reshape(
        -1, 3, 3
    )


def header(zone: Array) -> Header:
    return Header(
        name="winding tube",
        robot='name = "arm"\n',
        scenario='[target]\nkind = "waypoints"\n',
        actuator_names=NAMES,
        rate_limits=np.column_stack((-RATES, RATES)),
        margin=MARGIN,
        dt=DT,
        seed=7,
        versions={"sinuous": "0.1.0", "numpy": "2.4.6"},
        zone_triangles=zone,
        zone_parts=np.full(len(zone), int(ZonePart.WALL)),
        radii=np.full(POINTS, BODY_RADIUS),
        disk_indices=np.arange(4, POINTS, 4, dtype=np.int64),
    )


def command(c: Array, goal: Array) -> Array:
    """The way to a goal, as far as the rate limits allow."""
    step = 0.18 * (goal - c)
    rate = np.abs(lengths(c + step) - lengths(c)) / DT
    return step / max(1.0, float(np.max(rate / RATES)))


def simulate(
    seed: int, steps: int, *, walls: bool = True, moving: bool = False, pace: float = 1.0
) -> Recording:
    """Drive the arm from way-point to way-point, or after a target that moves all the time."""
    rng = np.random.default_rng(seed)
    c, offset = WAY_POINTS[0].copy(), np.zeros(3)
    samples: list[Sample] = []
    for k in range(steps):
        goal = WAY_POINTS[1 + min(3 * k // steps, 2)]
        if moving:
            u = k / steps
            goal = (1.0 - u) * WAY_POINTS[1] + u * WAY_POINTS[3]
        if k % 6 == 0:
            offset = np.clip(rng.normal(0.0, 2e-4, 3), -5e-4, 5e-4)
        step = pace * command(c, goal)
        rates = (lengths(c + step) - lengths(c)) / DT
        c = c + step
        points = body(c)
        measured = points + np.linspace(0.0, 1.0, POINTS)[:, None] * offset
        near = clearance(points) < MARGIN + 5e-4
        samples.append(
            Sample(
                time=k * DT,
                target=body(goal)[-1],
                configuration=c,
                lengths=lengths(c),
                rates=rates,
                nominal_points=points,
                nominal_tip=points[-1],
                nominal_clearance=clearance(points) if walls else np.inf,
                measured_points=measured,
                measured_tip=measured[-1],
                actual_points=measured,
                actual_tip=measured[-1],
                local_rates=np.zeros(len(NAMES)),
                clipped=0.0,
                offset=np.zeros(3),
                measured_lengths=lengths(c) + rng.normal(0.0, 1e-5, len(NAMES)),
                actual_clearance=clearance(measured) if walls else np.inf,
                status=status_name(Status.HOLDING if k == steps // 2 else Status.TRACKING),
                solve_time=float(1.5e-4 * rng.lognormal(0.0, 0.35) * (3.0 if near else 1.0)),
                iterations=int(rng.integers(2, 8)),
                planes=int(rng.integers(0, 12)),
                step_fraction=1.0,
                active=("clearance of disk 7",) if near else (),
            )
        )
    return Recording.from_samples(header(tube() if walls else np.empty((0, 3, 3))), samples)


@pytest.fixture(scope="session")
def run() -> Recording:
    """Ten seconds in the tube."""
    return simulate(seed=1, steps=300)


@pytest.fixture(scope="session")
def simulated() -> Callable[..., Recording]:
    """Makes other runs."""
    return simulate
