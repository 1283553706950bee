"""2.2.2: inverse and then forward kinematics all over the disc that can be reached."""

from typing import Any

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control.geometric_ik import GeometricIK, IKStatus
from sinuous.papers.qin2020.runs import BOUNDARY, inverse

SEED = 5
CHIS = np.radians([*np.arange(15.0, 30.5, 0.5), 20.3])  # of the planes that are compared
PLANE_TARGETS = 10_000  # in each of these planes
CELLS = 121  # of the maps, along a side
DRAWN = ((0.06, 0.12), (0.11, 0.0), (-0.05, -0.05), (-0.1, -0.13))
"""x and z of the targets in the drawing, beside the reference point [m]."""

DIGITS = 5  # of lengths and angles in drawings


def in_disc(count: int, radius: float, rng: np.random.Generator) -> Array:
    """Points (count, 2) [m], evenly spread."""
    r, a = radius * np.sqrt(rng.random(count)), rng.uniform(0.0, 2.0 * np.pi, count)
    return np.stack([r * np.cos(a), r * np.sin(a)], axis=1)


def joint_centres(ik: GeometricIK, c: ArrayLike) -> Array:
    """A_1 to A_N and then the tip (..., N + 1, 3) [m] of configurations (..., n)."""
    robot = ik.robot
    poses = robot.module_poses(c)
    ends, along = poses[..., :3, 3], poses[..., :3, 1]
    first = robot.T_w_b[:3, 3] + robot.plate_offset * robot.T_w_b[:3, 1]
    centres = np.concatenate(
        [
            np.broadcast_to(first, (*ends.shape[:-2], 1, 3)),
            ends[..., :-1, :] + robot.plate_offset * along[..., :-1, :],
            ends[..., -1:, :],
        ],
        axis=-2,
    )
    return np.asarray(centres, dtype=np.float64)


def whole_disc(count: int, chi: float) -> dict[str, Any]:
    """What the geometric solution is worth at targets all over the disc of chi [rad]."""
    ik, rng = inverse(), np.random.default_rng(SEED)
    targets = ik.on_plane(in_disc(count, ik.radius(chi), rng), chi)
    found = ik.solve(targets)
    poses = ik.robot.tip_pose(found.c)
    reference, joint = ik.reference(chi), np.arange(1, ik.robot.joints + 1)
    before = np.repeat(joint[None] < found.first_joint[:, None], 2, axis=1)
    return {
        "chi_rad": chi,
        "radius_m": ik.radius(chi),
        "plane_m": ik.plane(chi),
        "targets": count,
        "tip_error_m": float(np.max(np.linalg.norm(poses[:, :3, 3] - targets, axis=1))),
        "tube_tilt_rad": float(np.max(np.hypot(poses[:, 0, 1], poses[:, 2, 1]))),
        "within_limit_share": float(np.mean(found.status == IKStatus.REACHED)),
        "largest_bend_rad": float(np.max(found.bend)),
        "bend_limit_rad": ik.robot.bend_limit,
        "moved_before_k_rad": float(np.max(np.abs(found.c - reference)[before])),
        "share_by_k": [float(np.mean(found.first_joint == k)) for k in joint[:-2]],
    }


def by_chi(count: int) -> list[dict[str, float]]:
    """Planes of other chi: how much of the disc, and of the printed square, is within limits."""
    ik, rng = inverse(), np.random.default_rng(SEED)
    disc, square = in_disc(count, 1.0, rng), rng.uniform(-BOUNDARY, BOUNDARY, (count, 2))
    rows = list[dict[str, float]]()
    for chi in np.sort(CHIS):
        inside = ik.solve(ik.on_plane(ik.radius(chi) * disc, chi))
        printed = ik.solve(ik.on_plane(square, chi))
        rows.append(
            {
                "chi_rad": float(chi),
                "radius_m": ik.radius(chi),
                "within_limit_share": float(np.mean(inside.status == IKStatus.REACHED)),
                "largest_bend_rad": float(np.max(inside.bend)),
                "square_share": float(np.mean(printed.status == IKStatus.REACHED)),
                "square_in_disc_share": float(np.mean(printed.status != IKStatus.UNREACHABLE)),
            }
        )
    return rows


def maps(chi: float) -> dict[str, Any]:
    """The largest bend over the plane of chi [rad], nothing where it cannot be reached."""
    ik = inverse()
    side = ik.radius(chi) * np.linspace(-1.0, 1.0, CELLS)
    x, z = np.meshgrid(side, side)
    found = ik.solve(ik.on_plane(np.stack([x, z], axis=-1), chi))
    reached = found.status != IKStatus.UNREACHABLE
    return {
        "chi_rad": chi,
        "side_m": side.round(DIGITS).tolist(),
        "bend_rad": np.where(reached, found.bend, np.nan).round(DIGITS).tolist(),
    }


def poses(chi: float) -> list[dict[str, Any]]:
    """The arm at some targets, the reference pose first: what Fig. 5 shows."""
    ik = inverse()
    found = ik.solve(ik.on_plane([(0.0, ik.radius(chi)), *DRAWN], chi))
    return [
        {
            "target_m": target.round(DIGITS).tolist(),
            "joints_m": centres.round(DIGITS).tolist(),
            "first_joint": int(k),
        }
        for target, centres, k in zip(
            found.targets, joint_centres(ik, found.c), found.first_joint, strict=True
        )
    ]
