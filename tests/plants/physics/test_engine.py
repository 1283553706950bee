"""The engine: it moves things as physics says, and whatever it warns of ends the run."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.errors import InputError
from sinuous.plants.physics.engine import Engine, PhysicsFault, require_mujoco
from sinuous.plants.plant import NO_CONTACT, Contacts

TICK = 0.002
G = 9.81
MASS = 0.25  # [kg]


def ball(*, floor: bool = False) -> Engine:
    """A ball of 10 mm on a vertical slide, with motor and tendon, on a floor or above nothing."""
    mujoco = require_mujoco()
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="ball", pos=(0.0, 0.0, 0.01))
    body.add_joint(name="slide", type=mujoco.mjtJoint.mjJNT_SLIDE, axis=(0.0, 0.0, 1.0))
    body.add_geom(type=mujoco.mjtGeom.mjGEOM_SPHERE, size=(0.01, 0.0, 0.0), mass=MASS)
    body.add_site(name="on the ball")
    spec.worldbody.add_site(name="above", pos=(0.0, 0.0, 0.03))
    tendon = spec.add_tendon(name="tendon")
    tendon.wrap_site("above")
    tendon.wrap_site("on the ball")
    if floor:
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=(1.0, 1.0, 1.0))
    motor = spec.add_actuator(
        name="motor", target="slide", trntype=mujoco.mjtTrn.mjTRN_JOINT, forcelimited=False
    )
    motor.set_to_motor()
    Engine.prepare(spec, tick=TICK, gravity=(0.0, 0.0, -G))
    return Engine(spec.compile())


def nothing(_: int) -> None:
    pass


def test_without_support_it_falls() -> None:
    """A semi-implicit step falls g h^2 n (n + 1) / 2 in n ticks, for any n."""
    engine = ball()
    for ticks in (10, 40):
        engine.run(np.zeros((ticks, 1)), TICK, nothing)
    assert engine.data.qpos[0] == pytest.approx(-G * TICK**2 * 50 * 51 / 2, rel=1e-9)
    assert engine.data.time == pytest.approx(50 * TICK)


def test_a_tick_may_be_of_any_length() -> None:
    engine = ball()
    engine.run(np.zeros((10, 1)), 0.5e-3, nothing)
    assert engine.data.time == pytest.approx(5e-3)


def test_what_lies_presses_with_its_weight() -> None:
    engine = ball(floor=True)
    done = engine.run(np.zeros((1000, 1)), TICK, nothing)
    last = engine.run(np.zeros((1, 1)), TICK, nothing).contacts
    assert last.total == pytest.approx(MASS * G, rel=1e-3)
    assert last.largest == last.total
    assert 0.0 < last.depth < 1e-3
    assert done.contacts == done.contacts.worst(last)


def test_above_nothing_there_is_no_contact() -> None:
    assert ball().run(np.zeros((5, 1)), TICK, nothing).contacts == NO_CONTACT


def test_tendons_are_measured_at_the_start_of_every_tick() -> None:
    engine = ball()
    done = engine.run(np.zeros((3, 1)), TICK, nothing)
    fallen = G * TICK**2 * np.array([0, 1, 3])
    np.testing.assert_allclose(done.lengths[:, 0], 0.02 + fallen, rtol=0, atol=1e-15)
    np.testing.assert_allclose(done.speeds[:, 0], G * TICK * np.arange(3), rtol=0, atol=1e-15)


def test_place_is_called_before_every_tick() -> None:
    engine, seen = ball(), list[tuple[int, float]]()
    engine.run(np.zeros((3, 1)), TICK, lambda k: seen.append((k, float(engine.data.time))))
    assert seen == [(0, 0.0), (1, TICK), (2, 2 * TICK)]


def test_a_force_pushes_until_it_is_taken_away() -> None:
    engine = ball()
    engine.push("ball", np.array([0.0, 0.0, MASS * G]))
    engine.run(np.zeros((50, 1)), TICK, nothing)
    assert abs(engine.data.qpos[0]) < 1e-12
    engine.push("ball", np.zeros(3))
    engine.run(np.zeros((50, 1)), TICK, nothing)
    assert engine.data.qpos[0] == pytest.approx(-G * TICK**2 * 50 * 51 / 2, rel=1e-9)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_an_input_that_is_no_number_is_a_fault(bad: float) -> None:
    with pytest.raises(PhysicsFault, match="MuJoCo warns Nan, Inf or huge value in CTRL"):
        ball().run(np.array([[0.0], [bad]]), TICK, nothing)


@pytest.mark.parametrize("where", ["qpos", "qvel"])
@pytest.mark.parametrize("bad", [np.nan, 1e12])
def test_a_state_that_is_no_number_is_a_fault_and_not_a_new_start(where: str, bad: float) -> None:
    """By default MuJoCo goes back to where it started, and goes on."""
    engine = ball()
    engine.run(np.zeros((50, 1)), TICK, nothing)
    getattr(engine.data, where)[0] = bad
    with pytest.raises(PhysicsFault, match="the physics failed: MuJoCo warns"):
        engine.run(np.zeros((1, 1)), TICK, nothing)
    assert engine.data.time > 50 * TICK
    with pytest.raises(PhysicsFault):
        engine.run(np.zeros((1, 1)), TICK, nothing)


def test_a_last_tick_that_leaves_no_number_is_a_fault_at_once() -> None:
    """MuJoCo itself would tell at the start of the next tick only."""
    engine = ball()

    def spoil(_: int) -> None:
        engine.data.qvel[0] = 9e9  # below what MuJoCo calls bad ...
        engine.model.opt.timestep = 1e300  # ... and where that leads

    with pytest.raises(PhysicsFault):
        engine.run(np.zeros((1, 1)), TICK, spoil)


def test_warnings_go_to_neither_terminal_nor_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    before = require_mujoco().get_mju_user_warning()
    with pytest.raises(PhysicsFault):
        ball().run(np.array([[np.nan]]), TICK, nothing)
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == []
    assert require_mujoco().get_mju_user_warning() is before


def test_the_worst_of_two_contacts_is_the_worst_in_every_respect() -> None:
    assert Contacts(1.0, 5.0, 6.0).worst(Contacts(2.0, 3.0, 9.0)) == Contacts(2.0, 5.0, 9.0)


def test_without_mujoco_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    absent: Any = None
    monkeypatch.setitem(sys.modules, "mujoco", absent)
    with pytest.raises(InputError, match=r"pip install sinuous\[physics\]"):
        require_mujoco()
