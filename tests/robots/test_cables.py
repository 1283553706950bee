"""Which actuators are cables, and which pulls bend nothing."""

import numpy as np
import pytest

from sinuous.robots.cables import bend_columns, cable_rows, co_contractions
from sinuous.robots.robot_file import load_robot

ROUNDING = 1e-6  # shares are rounded to that


@pytest.mark.parametrize("name", ["hachen2025", "opencr_v4", "opencr_v6", "qin2020"])
def test_pulling_a_group_has_no_moment_and_every_cable_is_in_one(name: str) -> None:
    robot = load_robot(name)
    rows, groups = cable_rows(robot), co_contractions(robot)
    slope = robot.lengths_jacobian(robot.home)[rows]
    arm = np.max(np.abs(slope))
    moments = groups @ slope[:, bend_columns(robot)]
    np.testing.assert_allclose(moments / arm, 0.0, atol=10 * ROUNDING)
    assert np.all(groups >= 0.0)
    np.testing.assert_allclose(np.max(groups, axis=1), 1.0)
    assert np.all(np.sum(groups, axis=0) > 0.0)
    assert [robot.actuator_names[k].split()[2] for k in rows] == ["cable"] * len(rows)


def test_groups_are_the_cables_of_each_segment() -> None:
    groups = co_contractions(load_robot("hachen2025"))
    own = np.kron(np.eye(3), np.ones(3))
    assert {tuple(row) for row in groups} == {tuple(row) for row in own}
