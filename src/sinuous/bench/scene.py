"""The stress scene: a bent tube that the target circles in, and leaves twice.

From the measurements that came before this program: a closed bent tube of 25 mm radius, its
axis bent by 80 mm, 350 vertices and 696 triangles; the target goes into the bend and back on
14 mm circles and jumps into two windows 20 mm outside the mesh. Nothing in it is tuned for
any controller.
"""

from dataclasses import dataclass, replace

import numpy as np

from sinuous.arrays import Array
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_pcc
from sinuous.view.units import MM_PER_M

RADIUS = 0.025  # of the tube [m]
BEND = 0.080  # radius of its axis [m]
ANGLE = np.pi  # that the axis covers [rad]
STATIONS, SECTIONS = 29, 12  # 29 rings of 12 vertices and two centres: 350

BASE = 0.008  # the robot stands this far inside the first cap [m]
BODY_RADIUS = 0.004
MARGIN = 0.001  # together the 5 mm that the peers keep at the disks [m]
START_LENGTH = 0.043  # of each segment, bent like the tube [m]

DT = 1 / 30
STEPS = 600
CIRCLE, CIRCLE_TIME = 0.014, 4.0  # radius [m] and time for one turn [s]
NEAREST, FARTHEST, THERE_AND_BACK = 0.115, 0.215, 20.0  # along the axis [m], [s]
OUTSIDE = 0.020  # of the mesh, in the windows [m]
# First and last step, where along the axis [m], and the direction: away from the bend's centre
# and across its plane.
WINDOWS = (
    (200, 260, 0.190, (1.0, 0.3)),
    (430, 490, 0.150, (-0.4, 1.0)),
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """What every controller gets.

    Arguments:
        robot: with its base inside the tube
        zone: the tube
        margin: between body and wall [m]
        start: configuration (n,)
        targets: one per step [m] (K, 3)
        dt: time of a step [s]
    """

    robot: PccRobot
    zone: SafeZone
    margin: float
    start: Array
    targets: Array
    dt: float = DT


def tube() -> SafeZone:
    """The zone."""
    axis = shapes.arc_path(BEND, ANGLE, stations=STATIONS)
    return SafeZone.from_mesh(shapes.tube(axis, RADIUS, sections=SECTIONS), name="bent tube")


def robot(disks: int) -> PccRobot:
    """The preset of paper B with that many disks in all, thin enough for the tube."""
    preset = load_pcc("hachen2025")
    T_w_b = np.eye(4)
    T_w_b[2, 3] = BASE
    count = disks // len(preset.segments)
    thin = [replace(s, body_radius=BODY_RADIUS, disks=count) for s in preset.segments]
    return replace(preset, segments=tuple(thin), T_w_b=T_w_b)


def start(robot: PccRobot) -> Array:
    """Short, and bent like the tube (n,)."""
    return np.array([START_LENGTH / BEND, 0.0, START_LENGTH] * len(robot.segments))


def axis(along: Array) -> tuple[Array, Array, Array]:
    """The axis at a distance along it [m] (...): place, direction outward, across (..., 3)."""
    angle = along / BEND
    zero = np.zeros_like(angle)
    place = BEND * np.stack([1.0 - np.cos(angle), zero, np.sin(angle)], axis=-1)
    outward = np.stack([-np.cos(angle), zero, np.sin(angle)], axis=-1)
    return place, outward, np.stack([zero, zero + 1.0, zero], axis=-1)


def targets(steps: int = STEPS, dt: float = DT) -> Array:
    """Where the tip should be in the first K steps [m] (K, 3); the way in time is always the same.

    Arguments:
        steps: K
        dt: time of a step [s]
    """
    number = np.round(np.arange(steps) * (dt / DT), 6)  # windows open on time at every rate
    time = number * DT
    middle, reach = (FARTHEST + NEAREST) / 2, (FARTHEST - NEAREST) / 2
    place, outward, across = axis(middle - reach * np.cos(2.0 * np.pi * time / THERE_AND_BACK))
    turn = (2.0 * np.pi * time / CIRCLE_TIME)[:, None]
    path = place + CIRCLE * (np.cos(turn) * outward + np.sin(turn) * across)
    for first, last, along, (out, aside) in WINDOWS:
        place, outward, across = axis(np.array(along))
        way = (out * outward + aside * across) / np.hypot(out, aside)
        path[(first <= number) & (number < last)] = place + (RADIUS + OUTSIDE) * way
    return path


def stress_scene(disks: int, steps: int = STEPS, dt: float = DT) -> Scene:
    """The scene for a robot with that many disks."""
    body = robot(disks)
    way = targets(steps, dt)
    return Scene(robot=body, zone=tube(), margin=MARGIN, start=start(body), targets=way, dt=dt)


def describe(steps: int) -> dict[str, object]:
    """What a reader needs to build the scene again; lengths in millimetres."""
    return {
        "tube": "closed, constant bend; 350 vertices, 696 triangles",
        "tube_radius_mm": RADIUS * MM_PER_M,
        "bend_radius_mm": BEND * MM_PER_M,
        "bend_angle_deg": float(np.degrees(ANGLE)),
        "base_inside_first_cap_mm": BASE * MM_PER_M,
        "robot": "hachen2025 with a thinner body: pitch radius 7 mm, cables 22 to 108 mm, "
        "segments 40 to 90 mm, bend radius at least 35 mm, cables 20 mm/s, segments 10 mm/s",
        "required_distance_mm": (BODY_RADIUS + MARGIN) * MM_PER_M,
        "dt_s": DT,
        "steps": steps,
        "weights": "1000 |tip - target|^2 + 10 |u|^2 + 10 |x|^2 on x[1..N]",
        "circle_radius_mm": CIRCLE * MM_PER_M,
        "along_the_axis_mm": [NEAREST * MM_PER_M, FARTHEST * MM_PER_M],
        "windows": [
            {"first": a, "last": b - 1, "along_mm": s * MM_PER_M, "outside_mm": OUTSIDE * MM_PER_M}
            for a, b, s, _ in WINDOWS
        ],
    }
