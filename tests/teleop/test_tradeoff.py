"""Section 3.3: what b and K cost."""

import numpy as np
import pytest

from sinuous.teleop.analysis.tradeoff import Task, sweep
from sinuous.teleop.move_and_wait import MoveAndWait
from sinuous.teleop.operators import Prescribed

from .rigs import PLANE, STILL, WALLED, wave_about

K_B = 10.0  # [N s/m], at most
BS, KS = (2.0, 10.0, 50.0), (0.5, 1.0)


def test_b_buys_velocity_with_force_and_k_gives_it_back() -> None:
    task = Task(operator=Prescribed(wave_about(0.085)), force=WALLED, mapping=PLANE, duration=6.0)
    out = sweep(task, impedances=BS, gains=KS)
    assert out.velocity.shape == (3, 2)
    assert np.all(np.diff(out.velocity, axis=0) < 0.0)  # the larger b, the truer the velocity
    assert np.all(np.diff(out.force, axis=0) > 0.0)  # and the falser the force
    # On a given motion K changes the force alone: its error is K b |v|.
    np.testing.assert_allclose(out.velocity[:, 0], out.velocity[:, 1], rtol=1e-9)
    np.testing.assert_allclose(out.force[:, 0], 0.5 * out.force[:, 1], rtol=1e-9)
    np.testing.assert_allclose(out.force / (np.outer(BS, KS)), out.force[1, 1] / 10.0, rtol=1e-9)
    assert np.all(np.isnan(out.waiting))


def test_who_moves_and_waits_feels_the_force_as_it_is() -> None:
    operator = MoveAndWait(stops=np.array([[0.06, 0.02], [0.085, 0.03]]), patience=0.6)
    task = Task(operator=operator, force=WALLED, mapping=PLANE, duration=5.0)
    out = sweep(task, impedances=[10.0], gains=KS)
    assert np.all(out.waiting <= K_B * STILL)
    assert np.all(out.force > 0.1)
    assert out.force[0, 1] == pytest.approx(2.0 * out.force[0, 0])
