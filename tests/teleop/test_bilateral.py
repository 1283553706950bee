"""The whole loop: what the paper says of it, and what two ends need."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.teleop.bilateral import Bilateral, BilateralState
from sinuous.teleop.boundary import ZoneForce
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.force import ErrorForceAlong, Together
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.link import ConstantDelay, Packet
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.move_and_wait import MoveAndWait
from sinuous.teleop.operators import ImpedanceOperator, Prescribed
from sinuous.teleop.printed import PrintedForce
from sinuous.teleop.waves import ModifiedWaves, StandardWaves

from .rigs import (
    BOUNDARY,
    C1,
    C2,
    CUTOFF,
    DELAY,
    DT,
    FREE,
    PLANE,
    STILL,
    TICKS,
    WALLED,
    B,
    rig,
    run,
    to_and_hold,
    wave_about,
)

ROUNDING = 1e-12
K_B = 10.0  # [N s/m], at most
HOME = PLANE.place(np.zeros(2))
# Of force and of place, some seconds after the last motion of a loop that settles in 0.3 s.
SETTLED_FORCE, SETTLED_PLACE = 1e-4, 1e-5  # [N], [m]


def late(signal: Array, ticks: int = TICKS) -> Array:
    """A signal some ticks later, zero before."""
    return np.concatenate([np.zeros((ticks, signal.shape[1])), signal[:-ticks]])


@pytest.mark.parametrize("scheme", [C1, C2])
def test_the_force_felt_is_21_in_closed_loop(scheme: ModifiedWaves) -> None:
    r = run(rig(ImpedanceOperator(wave_about()), scheme=scheme), 5.0)
    felt = late(r.F_s) + scheme.gain * B * r.V
    np.testing.assert_allclose(r.F_m, felt, rtol=0, atol=ROUNDING)


def test_c1_and_c2_on_the_same_motion_differ_by_the_gain_alone() -> None:
    """With a source of motion the follower goes the same way, but for the low-pass."""
    scheme = ModifiedWaves.c1()
    bare = ModifiedWaves(gain=0.5, cutoff=np.inf)
    one, half = (run(rig(Prescribed(wave_about()), scheme=s), 5.0) for s in (scheme, bare))
    np.testing.assert_allclose(one.X_s, half.X_s, rtol=0, atol=ROUNDING)
    error_one, error_half = one.F_m - late(one.F_s), half.F_m - late(half.F_s)
    np.testing.assert_allclose(error_half, 0.5 * error_one, rtol=0, atol=ROUNDING)
    filtered = run(rig(Prescribed(wave_about()), scheme=C2), 5.0)
    ratio = np.sqrt(np.mean((filtered.F_m - late(filtered.F_s)) ** 2) / np.mean(error_one**2))
    assert ratio == pytest.approx(0.5, abs=ROUNDING)


@pytest.mark.parametrize("scheme", [C1, C2])
def test_at_rest_the_force_felt_is_the_follower_s_of_one_delay_ago(scheme: ModifiedWaves) -> None:
    operator = MoveAndWait(stops=np.array([[0.05, 0.03], [0.09, 0.06]]), patience=0.6)
    r = run(rig(operator, scheme=scheme), 6.0)
    still = np.all(np.abs(r.V) < STILL, axis=1) & (r.time > DELAY)
    assert np.sum(still) > 1000
    np.testing.assert_allclose(r.F_m[still], late(r.F_s)[still], rtol=0, atol=K_B * STILL)
    moving = ~still & (r.time > DELAY)
    assert np.max(np.abs(r.F_m - late(r.F_s))[moving]) > 0.5  # else there was nothing to show


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("axis", [0, 1])
def test_the_force_steps_at_the_boundary_and_is_felt_one_delay_later(
    axis: int, side: float
) -> None:
    """Once the leader has stopped, so that nothing else is felt."""
    goal = to_and_hold(side * 0.09 * np.eye(2)[axis], duration=1.2)
    r = run(rig(Prescribed(goal), scheme=C2), 3.0)
    x, F_s = side * r.X_s[:, axis], side * r.F_s[:, axis]
    first = int(np.flatnonzero(x >= BOUNDARY)[0])
    speed = (x[first] - x[first - 1]) / DT
    step = F_s[first] - F_s[first - 1]
    # c_b v and a spring of 50 N/m by less than a tick of motion; F_e moves little in a tick.
    assert step == pytest.approx(speed, rel=0.15)
    assert step > 20.0 * np.max(np.abs(np.diff(F_s[first - 100 : first])))
    F_m, V = side * r.F_m[:, axis], side * r.V[:, axis]
    felt = F_m - C2.gain * B * V
    jumps = np.diff(felt)
    assert int(np.argmax(jumps)) + 1 == first + TICKS
    assert jumps[first + TICKS - 1] == pytest.approx(step)
    other = r.F_s[:, 1 - axis]
    np.testing.assert_allclose(other, 0.0, atol=ROUNDING)


def test_a_step_of_force_comes_back_one_delay_later_and_goes_forward_two() -> None:
    """A follower that is pushed while the leader is held: F_m at T, X_sd moved by it at 2T."""
    teleop = rig(Prescribed(lambda _: np.zeros(2)), force=FREE)
    state, seen = teleop.init(HOME), []
    for k in range(1000):
        pushed = HOME if k < 300 else HOME + np.array([0.02, 0.0, 0.0])
        state, signals = teleop.step(state, pushed)
        seen.append(signals)
    F_m = np.array([s.leader.F_m[0] for s in seen])
    V_sd = np.array([s.follower.V_sd[0] for s in seen])
    assert np.all(F_m[: 300 + TICKS] == 0.0)
    assert F_m[300 + TICKS] == pytest.approx(-1.5 * np.tanh(1.0))
    assert V_sd[300] == pytest.approx(1.5 * np.tanh(1.0) / B)  # it gives way at once
    returned = np.diff(V_sd)[300:]  # and gives way less when the wave is back
    assert int(np.argmin(returned)) + 1 == 2 * TICKS


def test_a12_the_offset_at_rest_is_what_the_force_and_the_delays_say() -> None:
    r = run(rig(ImpedanceOperator(to_and_hold(np.array([0.095, -0.09])))), 8.0)
    offset = r.X_sd[-1] - r.X[-1]
    assert np.max(np.abs(r.F_s[-1])) > 0.1
    # The low-pass is a tick ahead of (16).
    expected = -(2 * DELAY + 1 / CUTOFF - DT) * r.F_s[-1] / B
    np.testing.assert_allclose(offset, expected, rtol=0, atol=SETTLED_PLACE)


def test_a12_the_offset_vanishes_with_the_force() -> None:
    def goal(t: float) -> Array:
        return to_and_hold(np.array([0.095, -0.09]))(t) if t < 3.0 else np.zeros(2)

    r = run(rig(ImpedanceOperator(goal)), 11.0)
    np.testing.assert_allclose(r.F_s[-1], 0.0, atol=SETTLED_FORCE)
    np.testing.assert_allclose(r.X_sd[-1], r.X[-1], atol=SETTLED_PLACE)


BOX = {"low": (-BOUNDARY, -BOUNDARY), "high": (BOUNDARY, BOUNDARY)}


@pytest.mark.parametrize("scheme", [C1, C2])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a7_as_printed_contact_diverges_and_with_our_sign_it_holds(
    scheme: ModifiedWaves, side: float
) -> None:
    operator = ImpedanceOperator(to_and_hold(side * np.array([0.09, 0.09])))
    printed = run(rig(operator, scheme=scheme, force=PrintedForce(**BOX)), 12.0)
    ours = run(rig(operator, scheme=scheme, force=WALLED), 12.0)
    assert np.max(np.abs(printed.X_sd)) > 1e9  # [m], and growing
    assert np.max(np.abs(ours.X_sd)) < BOUNDARY + 0.01
    pressed = side * ours.F_s[-1]
    assert np.all(pressed > 0.1)
    np.testing.assert_allclose(side * ours.F_m[-1], pressed, atol=SETTLED_FORCE)


def test_no_delay_is_one_tick_each_way() -> None:
    r = run(rig(ImpedanceOperator(wave_about()), delay=0.0), 3.0)
    np.testing.assert_allclose(r.F_m, late(r.F_s, 1) + 0.5 * B * r.V, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("delay", [0.0, 0.2])
def test_standard_waves_stay_stable_though_they_lose_nothing(delay: float) -> None:
    """A device whose F_m is of the velocity before makes energy in every tick: they diverge."""
    goal = ImpedanceOperator(lambda t: wave_about()(t) if t < 6.0 else np.zeros(2))
    r = run(rig(goal, scheme=StandardWaves(), delay=delay), 20.0)
    assert np.max(np.abs(r.X_sd - r.X)) < 0.06
    assert np.std(r.X_sd) > 0.5 * np.std(r.X)
    np.testing.assert_allclose(r.F_m[-1], 0.0, atol=0.01)
    roughness = np.max(np.abs(np.diff(r.V[-1000:], axis=0)))
    assert roughness < 1e-5  # [m/s] from tick to tick: nothing rings


def test_two_machines_are_the_same_as_one() -> None:
    """Both ends on their own, with packets carried by hand."""
    teleop = rig(ImpedanceOperator(wave_about()), delay=3 * DT)
    state = teleop.init(HOME)
    leader, follower = teleop.leader.init(np.zeros(2)), teleop.follower.init(HOME)
    ahead, back = [()] * 3, [()] * 3
    for k in range(400):
        tip = HOME + 0.01 * np.array([np.sin(0.01 * k), 0.0, np.cos(0.01 * k)])
        state, both = teleop.step(state, tip)
        leader, at_leader, forward = teleop.leader.step(leader, back.pop(0))
        follower, at_follower, backward = teleop.follower.step(follower, tip, ahead.pop(0))
        ahead.append((forward,))  # type: ignore[arg-type]
        back.append((backward,))  # type: ignore[arg-type]
        for a, b in zip((*both.leader, *both.follower), (*at_leader, *at_follower), strict=True):
            np.testing.assert_array_equal(a, b)


def test_a_run_can_be_repeated() -> None:
    teleop = rig(ImpedanceOperator(wave_about()))
    first, second = run(teleop, 1.0), run(teleop, 1.0)
    np.testing.assert_array_equal(first.F_m, second.F_m)


def test_three_axes_feel_a_safe_zone_that_the_follower_never_leaves() -> None:
    """A follower that stops at the margin, as under the MPC, and a hand that pulls beyond it."""
    zone = SafeZone.from_mesh(shapes.box((0.2, 0.2, 0.2)))
    mapping, keep = Mapping.space(2.0, origin=(0.0, 0.0, 0.0)), 0.02
    wall = ZoneForce(zone=zone, mapping=mapping, distance=keep)
    force = Together((ErrorForceAlong(), wall))
    operator = ImpedanceOperator(to_and_hold(np.array([0.06, 0.0, 0.01])))
    teleop: Bilateral[Any] = rig(operator, force=force, mapping=mapping)
    tip, state, seen = np.zeros(3), teleop.init(np.zeros(3)), []
    for _ in range(10_000):
        state, signals = teleop.step(state, tip)
        seen.append(signals)
        wanted = tip + DT / 0.05 * (signals.follower.target_w - tip)
        tip = np.clip(wanted, -0.1 + keep, 0.1 - keep)
    last = seen[-1]
    assert tip[0] == pytest.approx(0.08)
    depth = last.follower.X_sd[0] - 0.08
    assert 0.0 < depth < 0.02
    # The wall's spring and, with the follower held back, the tracking error.
    assert last.follower.F_s[0] > 50.0 * depth
    assert last.leader.F_m[0] == pytest.approx(last.follower.F_s[0], abs=SETTLED_FORCE)
    assert last.leader.F_h[0] == pytest.approx(last.leader.F_m[0], abs=SETTLED_FORCE)
    assert tip[2] == pytest.approx(0.02, abs=2e-3)


@pytest.mark.parametrize("where", ["tip", "goal"])
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_not_finite_makes_an_end_hold_still_and_say_so(where: str, bad: float) -> None:
    good = wave_about()
    broken = range(500, 520)

    def goal(t: float) -> Array:
        return np.full(2, bad) if where == "goal" and round(t / DT) in broken else good(t)

    teleop = rig(ImpedanceOperator(goal), force=WALLED)
    state, faults = teleop.init(HOME), []
    for k in range(2000):
        tip = HOME + 0.01 * np.array([np.sin(0.001 * k), 0.0, 0.0])
        if k in broken and where == "tip":
            tip = np.array([bad, 0.6, 0.0])
        before = state
        state, signals = teleop.step(state, tip)
        leader, follower = signals.leader, signals.follower
        if k not in broken:
            assert leader.fault == follower.fault == ""
        elif where == "tip":
            faults.append(follower.fault)
            np.testing.assert_array_equal(follower.V_sd, 0.0)
            np.testing.assert_array_equal(follower.F_s, 0.0)
            np.testing.assert_array_equal(state.follower.X_sd, before.follower.X_sd)
            np.testing.assert_array_equal(follower.target_w, PLANE.place(follower.X_sd))
            assert leader.fault == ""
        else:
            faults.append(leader.fault)
            for zero in (leader.F_m, leader.F_h, leader.V, state.leader.v):
                np.testing.assert_array_equal(zero, 0.0)
            assert follower.fault == ""
        for value in (*state.leader[1:3], *state.follower[:2], leader.F_m, follower.F_s):
            assert np.all(np.isfinite(value))
    says = {"tip": "the measured tip is not finite", "goal": "the operator's force is not finite"}
    assert set(faults) == {f"holding still: {says[where]}"}
    assert len(faults) == 20


BAD_PACKETS: dict[str, Callable[[Packet], Packet]] = {
    "wave nan": lambda p: p._replace(wave=np.array([0.0, np.nan])),
    "wave inf": lambda p: p._replace(wave=np.array([-np.inf, 0.0])),
    "position": lambda p: p._replace(position=np.array([0.0, np.nan])),
    "energy inf": lambda p: p._replace(energy=np.inf),
    "energy nan": lambda p: p._replace(energy=np.nan),
    "energy negative": lambda p: p._replace(energy=-1e-9),
    "axes of the wave": lambda p: p._replace(wave=np.zeros(3)),
    "axes of the position": lambda p: p._replace(position=np.zeros(1)),
}


@pytest.mark.parametrize("way", ["to_leader", "to_follower"])
@pytest.mark.parametrize("case", BAD_PACKETS)
def test_a_packet_that_cannot_be_computed_with_is_lost_and_said_to_be(case: str, way: str) -> None:
    """Everything goes on as if it had not come, but for the words."""
    teleop = rig(ImpedanceOperator(wave_about()), correction=DriftCorrection())
    bad, without, faults = teleop.init(HOME), teleop.init(HOME), []
    for k in range(700):
        tip = HOME + 0.01 * np.array([np.sin(0.001 * k), 0.0, 0.0])
        if 500 <= k < 520:
            spoiled = tuple(BAD_PACKETS[case](packet) for packet in getattr(bad, way))
            bad, without = bad._replace(**{way: spoiled}), without._replace(**{way: ()})
        bad, signals = teleop.step(bad, tip)
        without, expected = teleop.step(without, tip)
        here, other = signals.leader.fault, signals.follower.fault
        faults.append(here if way == "to_leader" else other)
        assert (other if way == "to_leader" else here) == ""
        for a, b in zip(signals.leader[:-1], expected.leader[:-1], strict=True):
            np.testing.assert_array_equal(a, b)
        for a, b in zip(signals.follower[:-1], expected.follower[:-1], strict=True):
            np.testing.assert_array_equal(a, b)
    assert faults[500:520] == 20 * ["ignored a packet that does not fit or is not finite"]
    assert set(faults[:500] + faults[520:]) == {""}


def test_a_loop_that_runs_away_ends_in_the_safe_state_and_not_in_nan() -> None:
    """A hand too strong for its tick and the device's mass: its own explicit damper is unstable."""
    hand = ImpedanceOperator(wave_about(), damping=1e4)
    assert DT * hand.damping > 2.0 * (LeaderDevice().mass + DT * C2.damping * 2.25)
    teleop = rig(hand)
    state, faults = teleop.init(HOME), set[str]()
    for _ in range(3000):
        state, signals = teleop.step(state, HOME)
        faults |= {signals.leader.fault, signals.follower.fault}
        assert np.all(np.isfinite(state.leader.x))
        assert np.all(np.isfinite(state.follower.X_sd))
    assert len(faults) > 1


def lose(fraction: float, seed: int) -> Any:
    """Drop that share of the packets to the follower."""
    rng = np.random.default_rng(seed)

    def disturb(_: int, state: BilateralState[Any]) -> BilateralState[Any]:
        return state._replace(to_follower=()) if rng.random() < fraction else state

    return disturb


def test_a_lost_packet_is_a_wave_of_zero_and_keeps_the_channel_passive() -> None:
    r = run(rig(ImpedanceOperator(wave_about())), 6.0, disturb=lose(0.3, seed=1))
    assert r.ledger.least.channel >= -ROUNDING
    assert np.max(np.abs(r.X_sd - r.X)) > 0.02  # what is lost stays away


def test_parts_have_to_fit() -> None:
    good = rig(ImpedanceOperator(wave_about()))
    other = rig(ImpedanceOperator(wave_about()), scheme=C1)
    parts = {"forward": good.forward, "backward": good.backward}
    with pytest.raises(ValueError, match="same scheme"):
        Bilateral(leader=good.leader, follower=other.follower, **parts)
    with pytest.raises(ValueError, match=r"backward must have ticks of 0.001 s, not 0.002"):
        Bilateral(
            leader=good.leader,
            follower=good.follower,
            forward=good.forward,
            backward=ConstantDelay(delay=0.2, dt=2e-3),
        )
    space = rig(ImpedanceOperator(wave_about()), force=FREE, mapping=Mapping.space(1.0, (0, 0, 0)))
    with pytest.raises(ValueError, match="number of axes"):
        Bilateral(leader=good.leader, follower=space.follower, **parts)


@pytest.mark.parametrize("tip", [(0.0, 0.6), (0.0, np.nan, 0.0)])
def test_a_start_has_three_finite_numbers(tip: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="three finite numbers"):
        rig(ImpedanceOperator(wave_about())).init(tip)
