"""`sinuous bench qp`."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.bench.qp_problems import collect
from sinuous.bench.qp_solvers import SOLVERS, Extended
from sinuous.bench.scene import stress_scene
from sinuous.cli.main import main

COST, VARIABLES = 1e-5, 1e-2  # relative to 1 + |cost|; of y, which is of order one
EXACT = 1e-12  # relative rounding of sums of a few dozen terms


def test_every_solver_is_measured_and_drawn(bench: Callable[[str], dict[str, Any]]) -> None:
    found = bench("qp")
    assert found["figures"] == ["qp.png"]
    rows = {row["solver"]: row for row in found["rows"]}
    assert list(rows) == [solver.name for solver in SOLVERS]
    for row in rows.values():
        assert row["failures"] == 0
        assert 0.0 <= row["cost_gap"] < COST
        assert row.keys() >= {"median_ms", "p99_ms", "max_ms", "own_median_ms", "row_error"}
    ratio = found["ratios"][0]
    assert ratio["peer"] == "DAQP"
    assert ratio["median"] == pytest.approx(
        rows["DAQP"]["median_ms"] / rows["sinuous"]["median_ms"]
    )


@pytest.mark.parametrize("horizon", [1, 5])
def test_all_solvers_answer_the_same(horizon: int) -> None:
    for problem in collect(stress_scene(9, 60), horizon, 6):
        answers = [solver.prepare(problem)() for solver in SOLVERS]
        assert all(answer.solved for answer in answers)
        for answer in answers[1:]:
            gap = problem.cost(answer.y) - problem.cost(answers[0].y)
            assert abs(gap) < COST * (1.0 + abs(problem.cost(answers[0].y)))
            assert np.max(np.abs(answer.y - answers[0].y)) < VARIABLES


def test_violations_as_variables_are_the_same_problem() -> None:
    problem = list(collect(stress_scene(9, 60), 5, 6))[-1]
    rng, dense = np.random.default_rng(0), problem.dense
    extended = Extended.of(problem)
    y = rng.normal(size=len(dense.f))
    x = np.zeros(len(extended.c))
    x[extended.back] = y
    short = np.maximum(dense.lower - dense.A @ y, 0.0)[problem.soft]
    others = np.setdiff1d(np.arange(len(x)), extended.back)
    x[others] = short[np.argsort(problem.stage[problem.soft], kind="stable")]
    cost = 0.5 * x @ extended.P @ x + extended.c @ x
    assert cost == pytest.approx(problem.cost(y), rel=EXACT)
    value = np.sort(extended.G @ x - extended.lower)
    hard = dense.A @ y - dense.lower
    hard[problem.soft] = np.maximum(hard[problem.soft], 0.0)
    np.testing.assert_allclose(value, np.sort(hard), rtol=0, atol=1e3 * EXACT)


def test_without_a_peer_one_message_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "piqp", None)
    assert main(["bench", "qp", "--out", str(tmp_path)]) == 2
    message = capsys.readouterr().err
    assert "piqp" in message
    assert "pip install sinuous[bench]" in message
