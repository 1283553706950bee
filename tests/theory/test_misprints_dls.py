"""Where paper B's reference controller is misprinted: both readings, side by side (notes B12)."""

from dataclasses import replace

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.control.dls import DampedLeastSquares, PenaltySign
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot_file import load_robot

ROBOT = load_robot("hachen2025")
MARGIN = 0.003  # [m]
# A room whose wall at x = 25 mm is too close to the body's middle, not to its base.
ROOM = SafeZone.from_mesh(shapes.box([0.225, 0.2, 0.5], centre=[-0.0875, 0.0, 0.1]))
# An S: the body bulges towards the wall, the tip is where that of a straight one is.
BULGING = ROBOT.home + np.array([0.6, 0, 0, -1.2, 0, 0, 0.6, 0, 0])
# Small enough that one step does not carry the body past where the penalty ends.
GENTLE = DampedLeastSquares(ROBOT, ROOM, margin=MARGIN, gain=0.05)


def penalties(sign: PenaltySign, steps: int = 30) -> Array:
    """h (steps + 1,) [m^2] of a body that is only asked to stay with its tip."""
    dls = replace(GENTLE, sign=sign)
    state, h = dls.init(BULGING), [dls.collision_cost(ROBOT.points(BULGING))[0]]
    for _ in range(steps):
        state, command = dls.step(state, ROBOT.tip(BULGING))
        h.append(dls.collision_cost(command.report.points)[0])
    return np.array(h)


def test_b12_as_printed_the_penalty_is_climbed_ours_goes_down() -> None:
    printed, ours = penalties(PenaltySign.PRINTED), penalties(PenaltySign.DESCENT)
    assert ours[0] == printed[0] > 0.0
    assert np.all(np.diff(printed) > 0.0)
    assert np.all(np.diff(ours) < 0.0)
    assert printed[-1] > 1.2 * printed[0]
    assert ours[-1] < 0.8 * ours[0]


def test_b12_both_signs_agree_where_there_is_no_wall() -> None:
    free = replace(GENTLE, zone=SafeZone.unbounded())
    error = np.array([0.01, -0.02, 0.0])
    u = [
        replace(free, sign=sign).displacement(BULGING, error, ROBOT.points(BULGING))
        for sign in PenaltySign
    ]
    np.testing.assert_array_equal(*u)


def test_b12_the_tip_has_no_penalty() -> None:
    """(31) ends at 3n - 1: with it, a target beside the wall would be fought over for good."""
    assert len(GENTLE.guarded) == 3 * ROBOT.segments[0].disks - 1
    points = np.zeros((len(ROBOT.radii), 3))  # all in the middle but the tip, which is outside
    points[-1, 0] = 0.03
    assert ROOM.clearance(points[-1]) < 0.0
    h, slope = GENTLE.collision_cost(points)
    assert h == 0.0
    assert not np.any(slope)
    points[GENTLE.guarded[-1]] = points[-1]  # the disk before the tip does have one
    assert GENTLE.collision_cost(points)[0] > 0.0


def test_b12_the_printed_factor_dt_makes_the_penalty_thirty_times_softer() -> None:
    points, still = ROBOT.points(BULGING), np.zeros(3)
    soft = GENTLE.displacement(BULGING, still, points)
    stiff = replace(GENTLE, penalty=1.0).displacement(BULGING, still, points)
    assert np.linalg.norm(soft) > 0.0
    np.testing.assert_allclose(stiff, 30.0 * soft, rtol=1e-9)


def test_b12_a_speed_would_take_minutes_a_displacement_takes_seconds() -> None:
    """k_j = 0.05 removes an error in a few seconds, as printed in Fig. 5, only per step."""
    target = ROBOT.tip(ROBOT.home) + np.array([0.0, 0.0, 0.003])
    free = DampedLeastSquares(ROBOT, SafeZone.unbounded())
    error = target - ROBOT.tip(ROBOT.home)
    u = free.displacement(ROBOT.home, error, ROBOT.points(ROBOT.home))
    # Straight ahead L+ maps the four lengths of a segment to one, with J J' = 3 / 4.
    share = float(np.linalg.norm(ROBOT.points_jacobian(ROBOT.home)[-1] @ ROBOT.configuration(u)))
    assert share / 0.003 == pytest.approx(0.05 * 0.75 / 1.75, rel=1e-6)
    seconds = 3.0 / (share / 0.003)  # until 5 % is left: in steps if u is a displacement, else in s
    assert seconds / 30.0 < 6.0
    assert seconds > 60.0
