"""2.2: formulas as printed beside our reading of them (notes A1, A3, A4, A5)."""

from typing import Any

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control.geometric_ik import CHI, GeometricIK
from sinuous.papers.qin2020.kinematics.disc import in_disc, joint_centres
from sinuous.papers.qin2020.runs import inverse
from sinuous.robots.jointed import JointedRobot

SEED = 7
POSE = 0.3  # angles of random poses, to either side [rad]
WRONG = 0.001  # of one cable [m]


def hole_angles(count: int) -> dict[str, Any]:
    """(4)-(7) with a hole for every plate, as printed, and with a hole for every cable."""
    robot, rng = inverse().robot, np.random.default_rng(SEED)
    c = rng.uniform(-POSE, POSE, (count, len(robot.home)))
    apart = np.max(np.abs(literal_lengths(robot, c) - robot.lengths(c)), axis=1)
    straight = literal_lengths(robot, robot.home) - robot.lengths(robot.home)
    return {
        "poses": count,
        "median_m": float(np.median(apart)),
        "largest_m": float(np.max(apart)),
        "straight_by_module_m": straight.reshape(robot.joints, -1).max(axis=1).tolist(),
        "round_trip_rad": float(np.max(np.abs(robot.configuration(robot.lengths(c)) - c))),
        "wrong_by_m": WRONG,
        "residual_m": _one_wrong(robot, c),
    }


def _one_wrong(robot: JointedRobot, c: Array) -> list[float]:
    """What three cables leave over (least, largest) [m] if one of them reads wrong."""
    lengths = robot.lengths(c)
    lengths[:, 0] += WRONG
    residual = robot.consistency(lengths)[:, 0]
    return [float(np.min(residual)), float(np.max(residual))]


def literal_lengths(robot: JointedRobot, c: ArrayLike) -> Array:
    """Cable lengths (..., 3 N) [m] by (4)-(7) to the letter: alpha_ij against alpha_i-1,j."""
    angles = np.asarray(c, dtype=np.float64)
    angles = angles.reshape(*angles.shape[:-1], robot.joints, 2)
    theta, phi = angles[..., 0, None], angles[..., 1, None]
    plate, cable = np.arange(robot.joints + 1)[:, None], np.arange(3)
    alpha = plate * 2.0 * np.pi / robot.holes + cable * 2.0 * np.pi / 3.0
    x, z = robot.radius * np.cos(alpha), robot.radius * np.sin(alpha)
    # T p of (1) and (5): up to the joint, about X, about Z, and up to the next plate.
    up, deep = robot.plate_offset, z[1:]
    y1, z1 = up * np.cos(phi) - deep * np.sin(phi), up * np.sin(phi) + deep * np.cos(phi)
    x2 = x[1:] * np.cos(theta) - y1 * np.sin(theta)
    y2 = x[1:] * np.sin(theta) + y1 * np.cos(theta) + up
    gaps = np.sqrt((x2 - x[:-1]) ** 2 + y2**2 + (z1 - z[:-1]) ** 2)
    total = np.cumsum(gaps + robot.tube_length, axis=-2)
    return np.asarray(total.reshape(*total.shape[:-2], -1), dtype=np.float64)


def link_directions(count: int) -> dict[str, Any]:
    """(14) with directions in the world, as printed, and in the frame of the link before."""
    ik, rng = inverse(), np.random.default_rng(SEED)
    targets = ik.on_plane(in_disc(count, ik.radius(CHI), rng), CHI)
    c = ik.solve(targets).c
    links = np.diff(joint_centres(ik, c), axis=1)
    printed = angles_in_the_world(links / np.linalg.norm(links, axis=2, keepdims=True))
    miss = np.linalg.norm(ik.robot.tip(printed) - targets, axis=1)
    ours = np.linalg.norm(ik.robot.tip(c) - targets, axis=1)
    return {
        "targets": count,
        "printed_median_m": float(np.median(miss)),
        "printed_largest_m": float(np.max(miss)),
        "ours_largest_m": float(np.max(ours)),
    }


def angles_in_the_world(directions: Array) -> Array:
    """Angles (..., 2 N) of (14) to the letter, for directions (..., N, 3) of the links.

    Rot(X, phi) v has the z of w, and Rot(Z, theta) then turns it into w.
    """
    v = np.concatenate([np.zeros_like(directions[..., :1, :]), directions[..., :-1, :]], axis=-2)
    v[..., 0, 1] = 1.0
    w, size = directions, np.hypot(v[..., 1], v[..., 2])
    phi = np.arcsin(np.clip(w[..., 2] / size, -1.0, 1.0)) - np.arctan2(v[..., 2], v[..., 1])
    tilted = v[..., 1] * np.cos(phi) - v[..., 2] * np.sin(phi)
    theta = np.arctan2(w[..., 1], w[..., 0]) - np.arctan2(tilted, v[..., 0])
    return np.stack([theta, phi], axis=-1).reshape(*directions.shape[:-2], -1)


def plane(count: int) -> dict[str, Any]:
    """(13): the printed points, the plane of the reference pose, and the farther intersection."""
    ik, rng = inverse(), np.random.default_rng(SEED)
    A = joint_centres(ik, ik.reference(CHI))[:-1]
    printed = A[[0, len(A) - 3, len(A) - 1]]
    spread = np.linalg.svd(printed - printed.mean(axis=0), compute_uv=False)
    targets = ik.on_plane(in_disc(count, ik.radius(CHI), rng), CHI)
    found = ik.solve(targets)
    centres = joint_centres(ik, found.c)
    missed = [_misses(ik, one, int(k)) for one, k in zip(centres, found.first_joint, strict=True)]
    return {
        "width_of_printed_points_m": float(spread[1]),
        "length_of_printed_points_m": float(spread[0]),
        "targets": count,
        "without_point_in_the_plane_share": float(np.mean(missed)),
        "farther_intersection": _switch(ik, A),
    }


def _misses(ik: GeometricIK, centres: Array, k: int) -> bool:
    """Whether the circle (12) does not meet the plane x = 0 of the reference pose."""
    middle, radius, axis = circle(ik, centres, k)
    flat = np.hypot(axis[1], axis[2])
    return bool(abs(middle[0]) > radius * flat)


def circle(ik: GeometricIK, centres: Array, k: int) -> tuple[Array, float, Array]:
    """Middle (3,) [m], radius [m] and axis (3,) of the circle (12) on which A_k+1 lies."""
    L, links = ik.robot.link_length, ik.robot.joints - k - 1
    way = centres[-2] - centres[k - 1]
    size = float(np.linalg.norm(way))
    along = (size**2 + L**2 - (links * L) ** 2) / (2.0 * size)
    radius = float(np.sqrt(max(L**2 - along**2, 0.0)))
    return centres[k - 1] + along * way / size, radius, way / size


def _switch(ik: GeometricIK, reference: Array) -> list[dict[str, float]]:
    """Across a switch of k: how far A_k+1 is from its place, at either intersection [m]."""
    rows = list[dict[str, float]]()
    radius, joints = ik.radius(CHI), ik.robot.joints
    for k in range(1, joints - 2):
        inner = radius * (joints - k - 1) / (joints - 1)
        x_z = np.array([inner, radius - inner]) * (1.0 + 1e-9)  # just outside the smaller disc
        found = ik.solve_one(ik.on_plane(x_z, CHI))
        centres = joint_centres(ik, found.c)
        middle, _, _ = circle(ik, centres, found.first_joint)
        other = 2.0 * middle - centres[k]
        rows.append(
            {
                "first_joint": found.first_joint,
                "nearer_m": float(np.linalg.norm(centres[k] - reference[k])),
                "farther_m": float(np.linalg.norm(other - reference[k])),
            }
        )
    return rows
