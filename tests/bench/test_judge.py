"""The judge sees what happens to the body, whatever a controller says."""

import numpy as np
import pytest

from sinuous.bench.judge import judge, margins
from sinuous.bench.loop import Drive, Outcome
from sinuous.bench.scene import Scene, stress_scene


@pytest.fixture(scope="module")
def scene() -> Scene:
    return stress_scene(9, 4)


def driven(c: np.ndarray, *, failure: str = "") -> Drive:
    steps = len(c) - 1
    return Drive(
        c=c,
        cpu=np.arange(1.0, steps + 1.0) * 1e-3,
        wall=np.full(steps, 2e-3),
        outcomes=(Outcome(iterations=3, failure=failure),) * steps,
    )


def test_standing_still_breaks_nothing(scene: Scene) -> None:
    row = judge(scene, driven(np.tile(scene.start, (5, 1))), whole_body=True)
    assert row["violations"] == row["body_violations"] == row["failures"] == 0
    assert row["largest_rate_by_its_limit"] == 0.0
    assert row["median_ms"] == pytest.approx(2.5)
    assert row["max_ms"] == pytest.approx(4.0)


def test_a_body_in_the_wall_is_seen(scene: Scene) -> None:
    bent = scene.start + np.array([1.0, 0.0, 0.02] * 3)
    row = judge(scene, driven(np.stack([scene.start, scene.start, bent, bent, bent])),
                whole_body=False)  # fmt: skip
    disks = scene.robot.points(bent)[scene.robot.disk_indices]
    assert row["min_margin_mm"] == pytest.approx((scene.zone.clearance(disks).min() - 0.005) * 1e3)
    assert row["min_margin_mm"] < 0.0
    assert row["violations"] == row["violations_beyond_0.2_mm"] == 3
    assert row["largest_rate_by_its_limit"] > 1.0


def test_the_body_is_judged_between_disks_and_between_steps(scene: Scene) -> None:
    there, back = scene.start.copy(), scene.start.copy()
    there[1], back[1] = 1.2, -1.2  # from wall to wall through the middle
    found = margins(scene, np.stack([there, back]))
    ends = margins(scene, np.stack([back, back]))
    assert found.body[0] <= ends.body[0]
    assert np.all(found.body <= found.disks + 1e-12)


def test_failures_are_counted(scene: Scene) -> None:
    drive = driven(np.tile(scene.start, (5, 1)), failure="no solution")
    assert judge(scene, drive, whole_body=False)["failures"] == 4
    both = drive.followed_by(drive)
    assert judge(scene, both, whole_body=False)["steps"] == 8
