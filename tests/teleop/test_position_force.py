"""Velocity and force without waves: what its ports do with the energy that is left."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop import energy_kernels
from sinuous.teleop.analysis.ports import channel_energy, drive_over, drive_ports
from sinuous.teleop.bilateral import Bilateral
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.leader import LeaderDevice, Load
from sinuous.teleop.link import ConstantDelay
from sinuous.teleop.losses import RandomLoss
from sinuous.teleop.operators import ImpedanceOperator, Prescribed
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.position_force import PositionForce, damped, yielding
from sinuous.teleop.receivers import Hold

from .adversary import ports
from .rigs import C1, DT, PLANE, WALLED, Run, run, to_and_hold, wave_about

ROUNDING = 1e-12  # of energies of up to a joule, and of forces of some newtons
SCHEME = PositionForce()
VECTOR = st.lists(st.floats(-10.0, 10.0), min_size=2, max_size=2).map(np.array)
SPARE = st.one_of(st.just(0.0), st.floats(1e-9, 0.1))


@given(force=VECTOR, v=VECTOR, spare=SPARE)
def test_the_follower_s_velocity_is_the_nearest_that_takes_no_more(
    force: Array, v: Array, spare: float
) -> None:
    got = damped(force, v, spare, DT)
    taken = DT * float(force @ got)
    assert taken <= spare + ROUNDING
    if DT * float(force @ v) <= spare:
        np.testing.assert_array_equal(got, v)
    else:
        # All that is left is taken, and what is missing is along the force: so it is the nearest.
        assert taken == pytest.approx(spare, abs=ROUNDING)
        missing = v - got
        assert missing @ force > 0.0
        across = missing[0] * force[1] - missing[1] * force[0]
        assert across == pytest.approx(0.0, abs=1e-9 * np.linalg.norm(missing))


@given(force=VECTOR, v=VECTOR, spare=SPARE)
def test_the_leader_s_force_keeps_to_what_is_left_with_any_velocity(
    force: Array, v: Array, spare: float
) -> None:
    got = yielding(force, v, spare, DT)
    given_out, whole = -DT * float(got @ v), -DT * float(force @ v)
    assert given_out <= spare + ROUNDING
    if whole <= 0.0:  # a hand that presses on feels all of it
        np.testing.assert_array_equal(got, force)
    else:
        share = max(1.0 - whole / (4.0 * spare), 0.0) if spare > 0.0 else 0.0
        np.testing.assert_allclose(got, share * force, rtol=1e-12)


def test_the_law_touches_what_is_left_and_is_a_damper() -> None:
    """h |F| falls in proportion to the speed, and gives most, all that is left, at half of it."""
    force, spare = np.array([2.0, 0.0]), 1e-3
    speeds = np.linspace(0.0, 2.0 * spare / (DT * 2.0), 21)[1:]
    left = np.array([yielding(force, np.array([-v, 0.0]), spare, DT)[0] for v in speeds])
    np.testing.assert_allclose(np.diff(left, 2), 0.0, atol=ROUNDING)
    given_out = DT * left * speeds
    assert np.max(given_out) == pytest.approx(spare)
    assert speeds[np.argmax(given_out)] == pytest.approx(2.0 * spare / (DT * 2.0))


DEVICE = LeaderDevice(mass=0.1)
POSITIVE = st.lists(st.floats(0.1, 3.0), min_size=2, max_size=2).map(np.array)


@given(
    v=VECTOR, hand=VECTOR, force=VECTOR, spare=SPARE, scale=POSITIVE, damping=st.floats(0.0, 30.0)
)
def test_the_device_moves_by_the_law_within_its_own_tick(
    v: Array, hand: Array, force: Array, spare: float, scale: Array, damping: float
) -> None:
    """Implicitly: the share that it finds is that of the velocity that comes of it."""
    load = Load(force, damping * scale, spare, scale)
    h, place, speed = DEVICE.give_way(np.zeros(2), 0.1 * v, 3.0 * hand, load, DT)
    assert 0.0 <= h <= 1.0
    np.testing.assert_allclose(place, DT * speed, atol=1e-15)
    balance = 3.0 * hand - h * force - damping * scale * speed
    np.testing.assert_allclose(DEVICE.mass * (speed - 0.1 * v) / DT, balance, atol=1e-9)
    given_out = -h * DT * float(force @ (scale * speed))
    assert given_out <= spare + ROUNDING
    if spare > 1e-6:
        law = energy_kernels.left(force, scale * speed, spare, DT)
        assert h == pytest.approx(law, abs=1e-6)


@given(
    x=VECTOR, v=VECTOR, hand=VECTOR, force=VECTOR, spare=SPARE, limit=st.floats(0.001, 0.02)
)  # fmt: skip
def test_nor_does_a_stop_of_the_workspace_let_more_out(
    x: Array, v: Array, hand: Array, force: Array, spare: float, limit: float
) -> None:
    scale, x = np.array([1.0, 2.0]), 0.002 * x
    device = LeaderDevice(mass=0.1, limit=limit)
    h, _, speed = device.give_way(x, v, 30.0 * hand, Load(force, 0.0 * scale, spare, scale), DT)
    assert -h * DT * float(force @ (scale * speed)) <= spare + ROUNDING


def test_with_nothing_left_a_hand_can_press_and_is_not_pushed_back() -> None:
    """The force is then what stops it: as much as the hand pushes with, and never a pull."""
    load = Load(np.array([2.0, 0.0]), np.zeros(2), 0.0, np.ones(2))
    still = np.zeros(2)
    for push, share in ((3.0, 1.0), (1.2, 0.6), (0.0, 0.0), (-1.0, 0.0)):
        h, _, v = DEVICE.give_way(still, still, np.array([push, 0.0]), load, DT)
        assert h == pytest.approx(share)
        assert np.sign(v[0]) == np.sign(max(push - 2.0, 0.0) + min(push, 0.0))


def test_a_source_of_motion_moves_as_it_wants_to() -> None:
    load = Load(np.array([2.0, 1.0]), np.ones(2), 1e-5, np.array([2.25, 2.25]))
    for wanted in (np.array([-0.2, 0.1]), np.array([0.3, 0.1]), np.array([-0.001, 0.0])):
        v = np.array([0.05, -0.02])
        F_h = DEVICE.force_for(wanted, v, load, DT)
        _, _, speed = DEVICE.give_way(np.zeros(2), v, F_h, load, DT)
        np.testing.assert_allclose(speed, wanted, atol=1e-12)


def test_without_control_ports_do_what_they_are_called_after() -> None:
    rng, ticks = np.random.default_rng(2), 50
    v, F_s = rng.normal(size=(400, 2)), rng.normal(size=(400, 2))
    got = drive_ports(SCHEME, ticks * DT, v, F_s)
    late = np.zeros((ticks, 2))
    np.testing.assert_array_equal(got.v_sd, np.concatenate([late, v[:-ticks]]))
    felt = np.concatenate([late, F_s[:-ticks]]) + 10.0 * v
    np.testing.assert_allclose(got.F_m, felt, atol=ROUNDING)


def test_two_channels_with_a_delay_make_energy_and_with_control_none() -> None:
    """The worst sinusoid of H + H^H = [[2 B, -2j sin], [2j sin, 0]] with sin of omega T."""
    delay, omega = 0.2, 0.5 * np.pi / 0.2
    time = DT * np.arange(8000)
    for force in (1.0, 10.0):
        v = 0.02 * np.sin(omega * time)[:, None]
        F_s = -force * np.cos(omega * time)[:, None]
        link = ConstantDelay(delay=delay)
        kept = ports(SCHEME, Hold(), PassivityControl())
        free = channel_energy(drive_ports(SCHEME, delay, v, F_s), v, F_s, DT)
        held = channel_energy(drive_over(*kept, link, link, v, F_s), v, F_s, DT)
        assert free[-1] < -0.01
        assert np.min(held) >= -SCHEME.loan - ROUNDING


def test_a_force_that_pushes_the_hand_back_is_felt_when_its_energy_has_come() -> None:
    """Of a follower that is pushed back, through a hand that gives way."""
    scheme, link = PositionForce(local_damping=0.0, loan=0.0), ConstantDelay(delay=0.01)
    v, F_s = np.full((2000, 1), -0.1), np.full((2000, 1), 1.0)
    kept = ports(scheme, Hold(), PassivityControl())
    got = drive_over(*kept, link, link, v, F_s)
    assert np.all(got.F_m[:20] < 0.5)
    assert got.F_m[-1, 0] > 0.95
    assert np.min(channel_energy(got, v, F_s, DT)) >= -ROUNDING


@pytest.mark.parametrize("loan", [0.0, 1e-3, 5e-3])
def test_a_loan_is_given_once(loan: float) -> None:
    """To a hand that gives way to a force again and again, from which nothing ever comes."""
    scheme, link = PositionForce(local_damping=0.0, loan=loan), ConstantDelay(delay=0.01)
    v, F_s = np.full((2000, 1), -0.1), np.full((2000, 1), 1.0)
    to_nobody = ImpairedLink(effects=(RandomLoss(1.0),))
    kept = ports(scheme, Hold(), PassivityControl())
    energy = channel_energy(drive_over(*kept, to_nobody, link, v, F_s), v, F_s, DT)
    assert np.min(energy) >= -loan - ROUNDING
    assert energy[-1] == pytest.approx(-loan, rel=0.02, abs=ROUNDING)


def teleoperated(hand: ImpedanceOperator, delay: float, control: PassivityControl | None) -> Run:
    teleop = Bilateral.connect(
        operator=hand, mapping=PLANE, force=WALLED, scheme=SCHEME, delay=delay, control=control
    )
    return run(teleop, 6.0)


HANDS = {
    "relaxed": ImpedanceOperator(wave_about(0.09), stiffness=20.0, damping=2.0),
    "stiff": ImpedanceOperator(wave_about(0.09), stiffness=600.0, damping=20.0),
}
COST = 0.05  # of control, where none is needed


@pytest.mark.parametrize("delay", [0.0, 0.2])
@pytest.mark.parametrize("hand", HANDS)
def test_control_costs_little_where_the_channel_is_passive_by_itself(
    hand: str, delay: float
) -> None:
    free, kept = (teleoperated(HANDS[hand], delay, c) for c in (None, PassivityControl()))
    assert free.ledger.least.channel >= 0.0
    assert np.max(np.abs(free.F_s)) > 0.3  # in contact
    for one, other in ((free.F_m - free.F_s, kept.F_m - kept.F_s),
                       (free.X_sd - free.X, kept.X_sd - kept.X)):  # fmt: skip
        here, there = (float(np.sqrt(np.mean(error**2))) for error in (one, other))
        assert there == pytest.approx(here, rel=COST)


@pytest.mark.parametrize("delay", [0.05, 0.2])
@pytest.mark.parametrize("hand", HANDS)
def test_hand_device_channel_and_follower_share_all_energy(hand: str, delay: float) -> None:
    """What yields in the port yields in the device: nothing is lost between them."""
    r = teleoperated(HANDS[hand], delay, PassivityControl())
    mass = LeaderDevice().mass / 2.25
    V = np.concatenate([np.zeros((1, 2)), r.V])
    kinetic = 0.5 * mass * np.sum(V[-1] ** 2)
    integration = 0.5 * mass * np.sum(np.diff(V, axis=0) ** 2)
    e = r.ledger.energies
    total = e.operator + kinetic + integration + e.channel + e.follower
    assert total == pytest.approx(0.0, abs=ROUNDING)
    assert r.ledger.least.channel >= -ROUNDING


def test_it_tracks_better_than_waves_and_presses_as_hard_on_a_wall() -> None:
    goal = Prescribed(to_and_hold(np.array([0.09, 0.0])))
    runs = [
        run(
            Bilateral.connect(
                operator=goal,
                mapping=PLANE,
                force=WALLED,
                scheme=scheme,
                delay=0.1,
                control=PassivityControl(),
            ),
            5.0,
        )
        for scheme in (SCHEME, C1)
    ]
    offset = [float(np.linalg.norm(r.X_sd[-1] - r.X[-1])) for r in runs]
    assert offset[0] < 0.5 * offset[1]
    for r in runs:
        np.testing.assert_allclose(r.F_m[-1], r.F_s[-1], atol=2e-3)
        assert r.F_s[-1, 0] > 0.3


@pytest.mark.parametrize(("field", "value"), [("local_damping", -1.0), ("loan", -1.0), ("dt", 0.0)])
def test_numbers_that_make_no_sense(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=field):
        PositionForce(**{field: value})
