"""`sinuous bench tails`, and the quick judge behind it."""

from collections.abc import Callable
from typing import Any

import numpy as np

from sinuous.bench.random_scenes import random_scenes
from sinuous.bench.swift import SwiftJudge
from sinuous.session.surface import SurfaceClearance

ROUNDING = 1e-12  # [m]


def test_all_settings_are_driven_and_the_slowest_steps_explained(
    bench: Callable[[str], dict[str, Any]],
) -> None:
    found = bench("tails")
    assert found["figures"] == ["tails.png"]
    settings = [(row["horizon"], row["budget_ms"]) for row in found["rows"]]
    assert settings == [(2, None), (2, 0.3), (5, None)]
    for row in found["rows"]:
        assert row["violations"] == row["failures"] == 0
        assert row["median_ms"] <= row["p99_ms"] <= row["max_ms"]
    for step in found["worst"]:
        parts = step["prepare_ms"] + step["solve_ms"] + step["decide_ms"]
        assert abs(parts - step["again_ms"]) < 1e-9
        assert step["qps"] >= 1
    assert found["clock_noise"].keys() >= {"same_step_cpu_ms", "nothing_cpu_ms"}


def test_scenes_repeat_and_may_be_started_in() -> None:
    once, again = (list(random_scenes(3, 2, 20)) for _ in range(2))
    for a, b in zip(once, again, strict=True):
        np.testing.assert_array_equal(a.targets, b.targets)
        np.testing.assert_array_equal(a.zone.triangles, b.zone.triangles)
        points = a.robot.points(a.start)
        room = a.zone.clearance(points) - a.robot.required_distance(a.margin)
        assert np.min(room[a.robot.movable]) > 0.0


def test_the_quick_judge_agrees_with_the_exact_one_where_it_matters() -> None:
    scene = next(random_scenes(5, 1, 1))
    swift, exact = SwiftJudge(scene=scene), SurfaceClearance.of(scene.robot, scene.zone)
    rng, broken = np.random.default_rng(0), 0
    for _ in range(60):
        after = scene.start + rng.normal(0.0, 0.25, 9) * np.array([1.0, 1.0, 0.02] * 3)
        true = exact.least(scene.start, after) - scene.margin
        quick = swift.room(scene.start, after)
        assert quick <= true + ROUNDING
        if true < 0.0:
            broken += 1
            assert abs(quick - true) < ROUNDING
    assert broken > 5  # the judge has to be able to see a violation
