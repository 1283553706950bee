"""Targets outside the zone: margins at rest, and jumps of projected targets."""

import json
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from sinuous.papers.hachen2025.undisturbed import MPC, place
from sinuous.papers.hachen2025.unreachable.experiment import (
    BEST,
    PRINTED,
    TUBE,
    UNREACHABLE,
    rest,
    sweep,
)
from sinuous.papers.hachen2025.unreachable.sweeps import DT, SPEED, SWEEPS
from sinuous.papers.workers import Workers

KEPT = 1e-6  # [m] by which the MPC may miss the margin
BESIDE = [0.0956, -0.005, 0.0765]  # [m] in the outer side of the second bend


def test_the_mpc_keeps_the_margin_and_the_reference_controller_leaves_the_tube() -> None:
    rows = {law: rest(((law, False), BESIDE, 6.0)) for law in (MPC, PRINTED, BEST)}
    assert rows[MPC]["outside_m"] > 0.01
    margin = place(TUBE).margin
    assert rows[MPC]["least_clearance_m"] >= margin - KEPT
    assert rows[MPC]["extent_m"] < 1e-5
    for law in (PRINTED, BEST):
        assert rows[law]["clearance_at_rest_m"] < margin - KEPT
        assert rows[law]["tip_error_m"] < rows[MPC]["tip_error_m"]


def test_a_row_is_judged_from_its_own_shapes() -> None:
    row = rest(((PRINTED, False), BESIDE, 3.0))
    here = place(TUBE)
    points = np.array(row["points_m"])[here.robot.movable]
    coarse = np.min(here.zone.clearance(points) - here.robot.radii[here.robot.movable])
    # The judge looks at 0.25 mm, the points are 3 mm apart: it sees as much or a little more.
    assert coarse - 2e-3 < row["clearance_at_rest_m"] <= coarse + 1e-6
    assert row["least_clearance_m"] <= row["clearance_at_rest_m"]
    assert np.linalg.norm(points[-1] - BESIDE) == pytest.approx(row["tip_error_m"], abs=2e-6)


def test_the_target_itself_never_jumps() -> None:
    for make in SWEEPS.values():
        one = make()
        line = np.concatenate([one.before[-1:], one.line])
        steps = [float(np.linalg.norm(b - a)) for a, b in pairwise(line)]
        assert max(steps) == pytest.approx(SPEED * DT, rel=1e-2)
        # All of it is outside the zone, or too near the wall for the tip.
        needed = float(one.here.robot.required_distance(one.here.margin)[-1])
        assert np.all(one.here.zone.clearance(line) < needed)


def test_a_jump_is_what_the_target_does_not_account_for() -> None:
    row = sweep(("through a ridge", (MPC, True)))
    line, aims, tip = (np.array(row[key]) for key in ("target_m", "aim_m", "tip_m"))
    assert len(line) == len(aims) == len(tip)

    def most(path: np.ndarray, steps: int) -> float:
        pairs = zip(path[:-steps], path[steps:], line[:-steps], line[steps:], strict=True)
        return max(np.linalg.norm(b - a) - np.linalg.norm(d - c) for a, b, c, d in pairs)

    assert row["aim_jump_m"] == pytest.approx(most(aims, 1), abs=1e-5)
    assert row["tip_jump_m"] == pytest.approx(most(tip, 1), abs=1e-5)
    assert row["tip_jump_in_window_m"] == pytest.approx(most(tip, 15), abs=1e-5)
    # Its middle is where both faces are equally near, about 24 mm apart there.
    assert row["aim_jump_m"] > 0.02
    assert row["least_clearance_m"] >= row["margin_m"] - KEPT


def test_without_a_projection_the_aim_is_the_target() -> None:
    row = sweep(("through a ridge", (MPC, False)))
    assert row["aim_m"] == row["target_m"]
    assert row["aim_jump_m"] == pytest.approx(0.0, abs=1e-12)


def test_a_quick_run_leaves_plain_data_and_figures(tmp_path: Path) -> None:
    data = json.loads(json.dumps(UNREACHABLE.run(Workers(), True)))
    mpc = [row for row in data["rest"] if row["controller"] == MPC]
    assert len(mpc) == 1
    assert all(row["least_clearance_m"] >= data["margin_m"] - KEPT for row in mpc)
    made = UNREACHABLE.draw(data, tmp_path)
    assert [path.suffix for path in made] == [".png"] * 3
    assert all(path.stat().st_size > 10_000 for path in made)
