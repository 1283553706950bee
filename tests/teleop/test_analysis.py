"""Scattering, passivity and transparency: theory against theory, and against the ports."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop.analysis.hybrid import (
    dissipation,
    hybrid_matrix,
    low_pass,
    standard_hybrid_matrix,
)
from sinuous.teleop.analysis.passivity import least_gain, power_terms
from sinuous.teleop.analysis.ports import channel_energy, drive_ports, worst_sinusoid
from sinuous.teleop.analysis.scattering import largest_norms, scattering_norm
from sinuous.teleop.analysis.transparency import transmitted_impedance, z_width
from sinuous.teleop.waves import ActiveChannelWarning, ModifiedWaves, Scheme, StandardWaves

from .rigs import DT

ROUNDING = 1e-12
FIG_8 = {"gain": 0.6, "impedance": 10.0, "cutoff": 20.0, "delay": 1.0}
BAND = np.linspace(0.0, 60.0, 60_001)[1:]  # (0, 60] rad/s
GAIN, B = st.floats(0.05, 2.0), st.floats(0.1, 100.0)
CUTOFF, DELAY = st.one_of(st.just(np.inf), st.floats(0.5, 500.0)), st.floats(0.0, 2.0)


def knowingly(**numbers: float) -> ModifiedWaves:
    """Waves that may be active."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ActiveChannelWarning)
        return ModifiedWaves(**numbers, allow_active=True)


def test_fig_8_the_norm_is_one_at_most() -> None:
    norm = scattering_norm(hybrid_matrix(BAND, **FIG_8))
    assert np.max(norm) <= 1.0
    assert np.max(norm) == pytest.approx(1.0, abs=1e-6)
    assert np.max(norm) == pytest.approx(0.99999996, abs=1e-8)
    assert np.min(norm) == pytest.approx(0.9030, abs=5e-5)


@pytest.mark.parametrize(
    ("gain", "expected"), [(0.49, 1.0008), (0.3, 1.246), (0.5, 1.0), (0.999, 1.0)]
)  # fmt: skip
def test_the_norm_is_above_one_below_a_half(gain: float, expected: float) -> None:
    H = hybrid_matrix(BAND, gain=gain, impedance=10.0, cutoff=20.0, delay=0.2)
    most = float(np.max(scattering_norm(H)))
    if gain >= 0.5:
        assert most <= expected
    else:
        assert most == pytest.approx(expected, abs=5e-4 if gain == 0.3 else 5e-5)


def test_a_half_is_tight_on_a_grid() -> None:
    grid = {
        "impedances": [1.0, 3.0, 10.0, 30.0],
        "cutoffs": [5.0, 20.0, np.inf],
        "delays": [0.05, 0.2, 1.0],
    }
    omega = np.linspace(0.01, 60.0, 3000)
    norms = largest_norms(omega, gains=[0.49, 0.5, 0.7, 1.0], **grid)
    assert norms.shape == (4, 4, 3, 3)
    needed = np.array(
        [
            [np.max(least_gain(omega, cutoff=cutoff, delay=T)) for T in grid["delays"]]
            for cutoff in grid["cutoffs"]
        ]
    )
    assert np.any(needed > 0.49)
    assert np.any(needed < 0.49)  # a slow low-pass and a short delay need less than 1/2
    np.testing.assert_array_equal(norms[0] > 1.0, np.broadcast_to(needed > 0.49, (4, 3, 3)))
    assert norms[0, 0, 1, 2] == pytest.approx(1.015, abs=1e-4)  # the worst with this low-pass
    assert np.max(norms[0]) == pytest.approx(1.019, abs=1e-3)  # and without
    assert np.all(norms[1:] <= 1.0 + ROUNDING)


@given(omega=st.floats(0.01, 100.0), gain=GAIN, b=B, cutoff=CUTOFF, delay=DELAY)
def test_condition_norm_and_eigenvalue_agree(
    omega: float, gain: float, b: float, cutoff: float, delay: float
) -> None:
    needed = float(least_gain(omega, cutoff=cutoff, delay=delay))
    H = hybrid_matrix(omega, gain=gain, impedance=b, cutoff=cutoff, delay=delay)
    if abs(gain - needed) < 1e-3 or abs(np.sin(omega * delay)) < 1e-3:
        return  # on the border rounding decides
    passive = gain >= needed
    assert (scattering_norm(H) <= 1.0) == passive
    assert (dissipation(H)[0][0] >= 0.0) == passive


@given(omega=st.floats(0.01, 100.0), cutoff=CUTOFF, delay=DELAY)
def test_the_closed_condition_is_that_of_the_notes(
    omega: float, cutoff: float, delay: float
) -> None:
    phi = complex(low_pass(omega, cutoff))
    r = (np.exp(-2j * omega * delay) * phi).real
    K = float(least_gain(omega, cutoff=cutoff, delay=delay))
    assert 4.0 * K * (1.0 - r) == pytest.approx(1.0 + abs(phi) ** 2 - 2.0 * r, abs=1e-9)
    assert K <= 0.5 + ROUNDING


def test_without_a_filter_half_is_needed_everywhere() -> None:
    np.testing.assert_allclose(least_gain(BAND, cutoff=np.inf, delay=0.2), 0.5, atol=1e-9)
    np.testing.assert_allclose(least_gain([0.0, 1.0], cutoff=np.inf, delay=0.0), 0.5)


@pytest.mark.parametrize("gain", [0.3, 0.5, 0.8, 1.0])
@pytest.mark.parametrize("delay", [0.0, 0.2, 0.7])
def test_the_identity_holds_to_rounding_and_the_energy_stays_above_zero(
    gain: float, delay: float
) -> None:
    scheme, rng = knowingly(gain=gain), np.random.default_rng(7)
    v, F_s = rng.normal(size=(2500, 2)), 5.0 * rng.normal(size=(2500, 2))
    run = drive_ports(scheme, delay, v, F_s)
    terms = power_terms(
        scheme, v=v, at_leader=run.at_leader, force=F_s, at_follower=run.at_follower
    )
    np.testing.assert_allclose(terms.total, run.F_m * v - F_s * run.v_sd, atol=1e-11)
    # What the links and the filter hold is never negative, whatever K.
    for stored in (terms.forward, terms.backward):
        assert np.min(np.cumsum(np.sum(stored, axis=1))) >= -1e-9
    if gain >= 0.5:
        assert np.min(channel_energy(run, v, F_s, DT)) >= 0.0


@settings(max_examples=40)
@given(
    seed=st.integers(0, 2**32 - 1),
    gain=st.floats(0.5, 2.0),
    b=B,
    share=st.floats(0.001, 1.0),
    ticks=st.integers(1, 40),
    colour=st.floats(0.0, 0.999),
)
def test_no_signal_takes_energy_out_of_a_passive_channel(
    seed: int, gain: float, b: float, share: float, ticks: int, colour: float
) -> None:
    rng = np.random.default_rng(seed)
    scheme = ModifiedWaves(gain=gain, impedance=b, cutoff=share / DT)
    signals = rng.normal(size=(300, 2))
    for k in range(1, len(signals)):
        signals[k] = colour * signals[k - 1] + signals[k]
    v, F_s = signals[:, [0]], b * signals[:, [1]]
    energy = channel_energy(drive_ports(scheme, ticks * DT, v, F_s), v, F_s, DT)
    assert np.min(energy) >= -1e-12 * np.max(np.abs(energy))


def test_standard_waves_hold_exactly_the_waves_under_way() -> None:
    scheme, rng, ticks = StandardWaves(), np.random.default_rng(3), 200
    v, F_s = rng.normal(size=(1500, 1)), rng.normal(size=(1500, 1))
    run, root = drive_ports(scheme, ticks * DT, v, F_s), np.sqrt(2.0 * scheme.impedance)
    forward = (scheme.impedance * v + run.F_m) / root
    backward = (scheme.impedance * run.v_sd - F_s) / root
    squares = np.cumsum(0.5 * DT * (forward**2 + backward**2))
    held = squares - np.concatenate([np.zeros(ticks), squares[:-ticks]])
    np.testing.assert_allclose(channel_energy(run, v, F_s, DT), held, atol=1e-9)


WORST = {"impedance": 10.0, "cutoff": 20.0, "delay": 0.2}


def extracted(scheme: Scheme, delay: float, gain: float) -> Array:
    """Energy over 40 s with the sinusoid that is worst for a gain at a delay of 0.2 s."""
    sinusoid = worst_sinusoid(BAND, gain=gain, **WORST)
    v, F_s = sinusoid.signals(40.0, DT)
    return channel_energy(drive_ports(scheme, delay, v, F_s), v, F_s, DT)


def test_the_worst_sinusoid_takes_24_joules_out_at_k_03() -> None:
    sinusoid = worst_sinusoid(BAND, gain=0.3, **WORST)
    assert sinusoid.omega == pytest.approx(6.74, abs=0.01)
    energy = extracted(knowingly(gain=0.3), 0.2, 0.3)
    assert energy[-1] == pytest.approx(-24.2, abs=0.3)
    # Theory is of the steady state, and of a filter that is not sampled.
    slope = (energy[-1] - energy[len(energy) // 2]) / 20.0
    assert slope == pytest.approx(sinusoid.power, rel=0.02)


def test_and_a_little_at_k_049() -> None:
    sinusoid = worst_sinusoid(BAND, gain=0.49, **WORST)
    assert sinusoid.omega == pytest.approx(3.73, abs=0.01)
    energy = extracted(knowingly(gain=0.49), 0.2, 0.49)
    assert -0.1 < np.min(energy) < -0.04


@pytest.mark.parametrize("delay", [0.0, 0.2, 0.7])
@pytest.mark.parametrize("gain", [0.3, 0.49])
@pytest.mark.parametrize("scheme", [ModifiedWaves(gain=0.5), StandardWaves()])
def test_what_is_passive_gives_nothing_to_them(scheme: Scheme, gain: float, delay: float) -> None:
    energy = extracted(scheme, delay, gain)
    assert np.min(energy) >= -1e-9


@pytest.mark.parametrize("delay", [0.2, 0.7])
def test_k_03_is_active_at_other_delays_too(delay: float) -> None:
    sinusoid = worst_sinusoid(BAND, gain=0.3, impedance=10.0, cutoff=20.0, delay=delay)
    v, F_s = sinusoid.signals(20.0, DT)
    run = drive_ports(knowingly(gain=0.3), delay, v, F_s)
    assert np.min(channel_energy(run, v, F_s, DT)) < -1.0


def test_random_signals_do_not_find_it() -> None:
    """Which is why it takes the eigenvector."""
    rng = np.random.default_rng(11)
    v, F_s = rng.normal(size=(20_000, 1)), 10.0 * rng.normal(size=(20_000, 1))
    run = drive_ports(knowingly(gain=0.49), 0.2, v, F_s)
    assert np.min(channel_energy(run, v, F_s, DT)) >= 0.0


def test_standard_waves_neither_lose_nor_make_energy_at_any_frequency() -> None:
    omega = np.linspace(0.1, 30.0, 500)
    H = standard_hybrid_matrix(omega, impedance=10.0, delay=0.2)
    values, _ = dissipation(H)
    np.testing.assert_allclose(values, 0.0, atol=1e-9 * np.max(np.abs(H)))
    np.testing.assert_allclose(scattering_norm(H), 1.0, atol=1e-9)


def test_standard_waves_have_that_hybrid_matrix() -> None:
    """Against the waves' own definition: u(T late) and v(T late) at the other port."""
    b, T, omega = 4.0, 0.2, np.array([0.7, 3.0, 12.0])
    H = standard_hybrid_matrix(omega, impedance=b, delay=T)
    v_m, F_s = 0.3 - 0.2j, 1.1 + 0.4j
    F_m = H[:, 0, 0] * v_m + H[:, 0, 1] * F_s
    v_sd = -(H[:, 1, 0] * v_m + H[:, 1, 1] * F_s)
    late = np.exp(-1j * omega * T)
    np.testing.assert_allclose(b * v_sd + F_s, late * (b * v_m + F_m), atol=1e-9)
    np.testing.assert_allclose(b * v_m - F_m, late * (b * v_sd - F_s), atol=1e-9)


def test_transparency_has_the_limits_of_the_channel() -> None:
    omega = np.array([0.5, 2.0, 9.0])
    H = hybrid_matrix(omega, gain=0.5, impedance=10.0, cutoff=20.0, delay=0.2)
    width = z_width(H)
    np.testing.assert_allclose(width.free, 5.0)  # K b, whatever the frequency
    np.testing.assert_allclose(transmitted_impedance(H, 0.0), width.free)
    np.testing.assert_allclose(transmitted_impedance(H, 1e12), width.clamped, rtol=1e-9)
    # A wave impedance at the end of a line without loss is felt as it is.
    line = standard_hybrid_matrix(omega, impedance=10.0, delay=0.2)
    np.testing.assert_allclose(transmitted_impedance(line, 10.0), 10.0, atol=1e-9)


def test_what_is_felt_of_an_environment_is_what_the_ports_transmit() -> None:
    """A damper at the follower, a sinusoid at the leader, after the transient."""
    scheme, damper, omega = ModifiedWaves(), 4.0, 2.5
    ticks, T = 8000, 0.2
    leader, follower = scheme.leader_init(1), scheme.follower_init(1)
    ahead, back, F_s = [np.zeros(1)] * 200, [np.zeros(1)] * 200, np.zeros(1)
    F_m, time = np.zeros(ticks), DT * np.arange(ticks)
    for k in range(ticks):
        leader, force, sent = scheme.leader_step(
            leader, np.array([np.sin(omega * time[k])]), back.pop(0)
        )
        received = ahead.pop(0)
        # F_s = Z v_sd and b v_sd = g_r - F_s, solved for the force.
        F_s = damper / (scheme.impedance + damper) * scheme.gain * received
        follower, _, returned = scheme.follower_step(follower, F_s, received)
        ahead.append(sent)
        back.append(returned)
        F_m[k] = force[0]
    last = slice(-round(2 * np.pi / omega / DT), None)
    measured = 2.0 * np.mean(F_m[last] * 1j * np.exp(-1j * omega * time[last]))
    H = hybrid_matrix(omega, gain=0.5, impedance=10.0, cutoff=20.0, delay=T)
    assert measured == pytest.approx(complex(transmitted_impedance(H, damper)), rel=5e-3)
