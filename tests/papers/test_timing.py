"""III-F: what is measured, that both programs are the same without walls too, the verdicts."""

import copy
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.bench.loop import drive
from sinuous.bench.ours import Ours
from sinuous.bench.result import plain
from sinuous.bench.scene import stress_scene
from sinuous.geometry.safe_zone import SafeZone
from sinuous.papers.hachen2025.timing import experiment as timing
from sinuous.papers.hachen2025.timing import verdicts
from sinuous.papers.hachen2025.timing.experiment import TIMING, measure
from sinuous.papers.workers import Workers

STEPS = 30
SAME = 5e-4  # two solvers of one program agree by half a millimetre: IPOPT's tolerance and ours
ROUNDING = 1e-9


@pytest.fixture(scope="module")
def quick() -> Any:
    """Data of a short run."""
    return TIMING.run(Workers(), True)


def test_quick_run_holds_both_settings_and_draws(quick: Any, tmp_path: Path) -> None:
    assert json.loads(json.dumps(quick))["vertices"] == 350
    assert plain(quick) == json.loads(json.dumps(quick))  # JSON's types, and all finite
    for constrained in (True, False):
        row = verdicts.of(quick, verdicts.OURS, constrained)[2]
        assert row["median_s"] <= row["p99_s"] <= row["max_s"]
        assert row["failures"] == 0
        assert row["steps"] == 2 * timing.QUICK_STEPS
    [figure] = TIMING.draw(quick, tmp_path)
    assert figure.stat().st_size > 10_000


def test_scene_has_as_many_vertices_as_printed() -> None:
    [surface] = stress_scene(timing.DISKS, 1).zone.surfaces
    assert len(surface.vertices) == timing.VERTICES


def test_peers_are_missing_with_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(_: str) -> None:
        return None

    monkeypatch.setattr(timing, "find_spec", absent)
    ours, peer = measure(stress_scene(9, 5), 2, compiles=False)
    assert ours["controller"] == verdicts.OURS
    assert ours["mean_s"] > 0.0
    assert peer["mean_s"] is None
    assert "sinuous[bench]" in peer["missing"]
    assert plain(peer) == peer  # null, not nan


def test_without_walls_ipopt_solves_the_same_program() -> None:
    pytest.importorskip("casadi")
    from sinuous.bench.peers.ipopt import ipopt
    from sinuous.bench.peers.nlp import NlpController
    from sinuous.bench.peers.setup import nlp_for
    from sinuous.bench.peers.silence import quiet

    scene = replace(stress_scene(9, STEPS), zone=SafeZone.unbounded())
    problem = nlp_for(scene, 2, machine_code=False)
    # per stage: twelve rates and three bends, no clearance
    assert problem.lower_g.size == 2 * (12 + 3)
    with quiet():
        theirs = drive(NlpController(scene=scene, problem=problem, method=ipopt()), scene)
    ours = drive(Ours.of(scene, 2, disks_only=False), scene)
    apart = np.linalg.norm(scene.robot.tip(theirs.c) - scene.robot.tip(ours.c), axis=1)
    assert np.max(apart) < SAME
    assert not any(outcome.failure for outcome in theirs.outcomes)


@pytest.mark.parametrize("hessian", ["exact", "gauss_newton"])
def test_derivatives_without_walls_are_those_of_the_program(hessian: str) -> None:
    """Gradient, Jacobian and exact Hessian against CasADi's automatic ones."""
    ca: Any = pytest.importorskip("casadi")
    from sinuous.bench.peers.setup import nlp_for

    scene = replace(stress_scene(9, 1), zone=SafeZone.unbounded())
    own = nlp_for(scene, 2, machine_code=False).functions
    rng = np.random.default_rng(3)
    x = ca.MX.sym("x", own["f"].numel_in("x"))
    p, dual = rng.normal(size=own["f"].numel_in("p")), rng.normal(size=own["g"].numel_out("g"))
    at = np.tile([0.3, 0.1, 8.0, -0.2, 0.4, 9.0, 0.1, 0.2, 7.0], 2)
    f, g = own["f"](x, p), own["g"](x, p)
    jacobian = ca.Function("j", [x], [ca.jacobian(g, x)])(at).full()
    assert np.allclose(own["jac_g"](at, p)[1].full(), jacobian, atol=ROUNDING)
    lagrangian = f + ca.dot(dual, g)
    automatic = ca.Function("h", [x], [ca.hessian(lagrangian, x)[0]])(at).full()
    written = np.triu(own[hessian](at, p, 1.0, dual).full())
    same = np.allclose(written, np.triu(automatic), atol=ROUNDING)
    assert same == (hessian == "exact")  # Gauss-Newton leaves curvature out, and it shows


def made_up() -> dict[str, Any]:
    """Data of two horizons."""

    def row(controller: str, N: int, mean: float | None, ours: float = 1e-4) -> dict[str, Any]:
        return {
            "controller": controller,
            "constrained": True,
            "horizon": N,
            "mean_s": mean,
            "ours_mean_s": ours,
        }

    return {
        "rows": [
            row(verdicts.OURS, 1, 0.5e-4),
            row(verdicts.OURS, 2, 1e-4),
            row(verdicts.INSTALLED, 2, 6e-3, ours=2e-4),
            row("acados RTI", 2, None),
        ]
    }


def test_verdicts_follow_the_data() -> None:
    data = made_up()
    assert verdicts.speed_up(data) == pytest.approx(300.0)
    assert verdicts.bridge(data) == pytest.approx(5.0)
    assert verdicts.ratios(data, verdicts.INSTALLED, True) == pytest.approx({2: 30.0})
    assert verdicts.ratios(data, "acados RTI", True) == {}
    assert verdicts.longest_below(data, True) == 2
    slow = copy.deepcopy(data)
    slow["rows"][1]["mean_s"] = 0.2
    assert verdicts.speed_up(slow) < 1.0
    assert verdicts.longest_below(slow, True) == 1
    alone = {"rows": data["rows"][:2]}
    assert verdicts.bridge(alone) is None
