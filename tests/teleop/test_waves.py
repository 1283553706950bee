"""The ports against the equations they come from, in time and in frequency."""

import warnings
from math import inf

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop.analysis.hybrid import ComplexArray, hybrid_matrix
from sinuous.teleop.analysis.ports import drive_ports
from sinuous.teleop.waves import ActiveChannelWarning, ModifiedWaves, Scheme, StandardWaves

from .rigs import C1, C2, DELAY, DT, TICKS, B

ROUNDING = 1e-12  # of sums of forces and velocities of order 1 to 100
SCHEMES = {"standard": StandardWaves(), "C1": C1, "C2": C2}
# What is left of a low-pass of 20 rad/s after 1.6 s of its impulse response.
TRUNCATED = 1e-12


def noise(axes: int = 1, ticks: int = 1500, seed: int = 0) -> tuple[Array, Array]:
    """Velocities and forces (K, A)."""
    rng = np.random.default_rng(seed)
    return rng.normal(size=(ticks, axes)), rng.normal(size=(ticks, axes))


def late(signal: Array, ticks: int) -> Array:
    """A signal some ticks later, zero before."""
    return np.concatenate([np.zeros((ticks, signal.shape[1])), signal[:-ticks]])


def filtered(signal: Array, scheme: ModifiedWaves) -> Array:
    """The low-pass of a signal (K, A), by its impulse response."""
    response = scheme.share * (1.0 - scheme.share) ** np.arange(len(signal))
    return np.stack([np.convolve(s, response)[: len(s)] for s in signal.T], axis=1)


@pytest.mark.parametrize("scheme", [C1, C2, ModifiedWaves(gain=0.7, impedance=3.0, cutoff=inf)])
@pytest.mark.parametrize("delay", [0.0, DELAY])
def test_what_arrives_is_what_20_and_21_say(scheme: ModifiedWaves, delay: float) -> None:
    v, F_s = noise(axes=2)
    ticks, run = max(round(delay / DT), 1), drive_ports(scheme, delay, v, F_s)
    K, b = scheme.gain, scheme.impedance
    returned = filtered(late(F_s, 2 * ticks), scheme)
    v_sd = filtered(late(v, ticks), scheme) + (returned - F_s) / b  # (20)
    np.testing.assert_allclose(run.v_sd, v_sd, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(run.F_m, late(F_s, ticks) + K * b * v, rtol=0, atol=ROUNDING)  # (21)


def response(scheme: Scheme, delay: float, omega: Array, seconds: float) -> ComplexArray:
    """H (W, 2, 2) of the ports, from their impulse responses."""
    ticks = round(seconds / DT)
    pulse, none = np.zeros((ticks, 1)), np.zeros((ticks, 1))
    pulse[0] = 1.0
    turn = np.exp(-1j * np.outer(omega * DT, np.arange(ticks)))
    H = np.empty((len(omega), 2, 2), dtype=np.complex128)
    for column, (v, F_s) in enumerate(((pulse, none), (none, pulse))):
        run = drive_ports(scheme, delay, v, F_s)
        H[:, 0, column] = turn @ run.F_m[:, 0]
        H[:, 1, column] = -turn @ run.v_sd[:, 0]
    return H


@pytest.mark.parametrize(("gain", "impedance", "cutoff"), [(0.5, 10.0, 20.0), (0.8, 4.0, inf)])
def test_the_ports_have_the_hybrid_matrix_31(gain: float, impedance: float, cutoff: float) -> None:
    omega = np.linspace(0.1, 30.0, 50)
    scheme = ModifiedWaves(gain=gain, impedance=impedance, cutoff=cutoff)
    ports = response(scheme, DELAY, omega, 2.0)
    theory = hybrid_matrix(omega, gain=gain, impedance=impedance, cutoff=cutoff, delay=DELAY)
    if cutoff == inf:  # nothing is sampled but the delay, which is whole ticks
        np.testing.assert_allclose(ports, theory, rtol=0, atol=TRUNCATED)
    # The low-pass is at most a tick ahead, for it sends what it becomes.
    far = np.abs(ports - theory)
    assert np.all(far <= DT * omega[:, None, None] + TRUNCATED)
    sampled = scheme.share / (1.0 - (1.0 - scheme.share) * np.exp(-1j * omega * DT))
    late_by = np.exp(-1j * omega * DELAY)
    np.testing.assert_allclose(ports[:, 1, 0], -late_by * sampled, rtol=0, atol=TRUNCATED)
    np.testing.assert_allclose(
        ports[:, 1, 1], (1.0 - late_by**2 * sampled) / impedance, rtol=0, atol=TRUNCATED
    )


@pytest.mark.parametrize("name", SCHEMES)
def test_axes_do_not_know_of_each_other(name: str) -> None:
    v, F_s = noise(axes=3, ticks=700)
    together = drive_ports(SCHEMES[name], DELAY, v, F_s)
    for axis in range(3):
        alone = drive_ports(SCHEMES[name], DELAY, v[:, [axis]], F_s[:, [axis]])
        for many, one in zip(together, alone, strict=True):
            np.testing.assert_array_equal(many[:, [axis]], one)


def test_c2_has_exactly_half_the_force_error_of_c1_on_the_same_motion() -> None:
    v, F_s = noise(axes=2)
    error = {
        scheme.gain: drive_ports(scheme, DELAY, v, F_s).F_m - late(F_s, TICKS)
        for scheme in (C1, C2)
    }
    np.testing.assert_allclose(error[0.5], 0.5 * error[1.0], rtol=0, atol=ROUNDING)
    assert np.sqrt(np.mean(error[0.5] ** 2) / np.mean(error[1.0] ** 2)) == pytest.approx(0.5)


def test_c1_is_what_10_of_the_notes_says() -> None:
    v, F_s = noise()
    run = drive_ports(C1, DELAY, v, F_s)
    np.testing.assert_allclose(run.F_m, late(F_s, TICKS) + B * v, rtol=0, atol=ROUNDING)
    without = ModifiedWaves(gain=1.0, cutoff=1.0 / DT)  # goes all the way in a tick
    for a, b in zip(run, drive_ports(without, DELAY, v, F_s), strict=True):
        np.testing.assert_array_equal(a, b)


def test_standard_waves_are_transparent_to_what_is_matched() -> None:
    """A follower that answers F_s = b v_sd reflects nothing: F_m = b v_m, v_sd = v_m(t - T)."""
    scheme, rng = StandardWaves(), np.random.default_rng(2)
    memory, under_way, sent_back = scheme.leader_init(1), [np.zeros(1)] * TICKS, np.zeros(1)
    v, v_sd, F_m = rng.normal(size=(800, 1)), np.zeros((800, 1)), np.zeros((800, 1))
    for k in range(800):
        memory, F_m[k], ahead = scheme.leader_step(memory, v[k], sent_back)
        received = under_way.pop(0)
        under_way.append(ahead)
        matched = received * np.sqrt(B / 2.0)  # F = sqrt(b/2) u where v = u / sqrt(2 b)
        memory, v_sd[k], sent_back = scheme.follower_step(memory, matched, received)
        np.testing.assert_allclose(sent_back, 0.0, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(F_m, B * v, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(v_sd, late(v, TICKS), rtol=0, atol=ROUNDING)


def test_standard_waves_obey_their_definition() -> None:
    """u = (b v + F) / sqrt(2b) and v = (b v - F) / sqrt(2b), at either port."""
    v, F_s = noise(axes=2, ticks=600)
    run, root = drive_ports(StandardWaves(), DELAY, v, F_s), np.sqrt(2.0 * B)
    forward, backward = (B * v + run.F_m) / root, (B * run.v_sd - F_s) / root
    np.testing.assert_allclose(run.at_follower, late(forward, TICKS), rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(run.at_leader, late(backward, TICKS), rtol=0, atol=ROUNDING)
    np.testing.assert_allclose((B * run.v_sd + F_s) / root, run.at_follower, atol=ROUNDING)
    np.testing.assert_allclose((B * v - run.F_m) / root, run.at_leader, atol=ROUNDING)


@pytest.mark.parametrize("name", SCHEMES)
def test_a_step_changes_nothing_it_was_given(name: str) -> None:
    scheme, v, received = SCHEMES[name], np.array([0.3, -0.1]), np.array([1.0, 2.0])
    state = scheme.leader_init(2)
    first = scheme.leader_step(state, v, received)
    again = scheme.leader_step(state, v, received)
    for a, b in zip(first, again, strict=True):
        np.testing.assert_array_equal(a, b)
    np.testing.assert_array_equal(v, [0.3, -0.1])


@given(
    gain=st.floats(0.0, 0.4999), impedance=st.floats(0.1, 100.0), cutoff=st.floats(0.1, 1000.0)
)  # fmt: skip
def test_an_active_gain_is_taken_only_knowingly(
    gain: float, impedance: float, cutoff: float
) -> None:
    with pytest.raises(ValueError, match=r"gain"):
        ModifiedWaves(gain=gain, impedance=impedance, cutoff=cutoff)
    if gain > 0.0:
        with pytest.warns(ActiveChannelWarning, match=f"{gain} is below 1/2: the channel makes"):
            ModifiedWaves(gain=gain, impedance=impedance, cutoff=cutoff, allow_active=True)


def test_half_is_passive_and_no_reason_to_warn() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert ModifiedWaves(gain=0.5, allow_active=True).share == pytest.approx(0.02)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("impedance", 0.0),
        ("impedance", np.nan),
        ("gain", -1.0),
        ("gain", np.nan),
        ("dt", 0.0),
        ("cutoff", 0.0),
        ("cutoff", np.nan),
        ("cutoff", 1000.1),
    ],
)
def test_numbers_that_make_no_sense(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=field):
        ModifiedWaves(**{field: value})


@pytest.mark.parametrize("field", ["impedance", "dt"])
def test_numbers_that_make_no_sense_for_standard_waves(field: str) -> None:
    with pytest.raises(ValueError, match=field):
        StandardWaves(**{field: -1.0})
