"""3.1 and 3.3: waves and passivity."""

import numpy as np

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.qin2020.claims.words import the

ROUNDING = 1e-9  # relative, and of norms above one
ENERGY = 1e-6  # taken for none [J]
PASSIVE = 0.5
SAME = 1e-3  # norms that differ by less are the same


def transmission(found: Found) -> Verdict:
    """(20) and (21) against what the ports do."""
    rows = [row for row in found["channel"]["rows"] if "equation_20" in row]
    desired = max(row["equation_20"] for row in rows)
    felt = max(row["equation_21"] for row in rows)
    return Verdict(
        measured=f"{len(rows)} runs of the ports agree with (20) within {desired:.0e} and with "
        f"(21) within {felt:.0e} of the largest value",
        holds=max(desired, felt) < ROUNDING,
        reason="K is in (21) only: it does not touch the velocity",
    )


def norm_below_one(found: Found) -> Verdict:
    """The largest norm for K in [0.5, 1)."""
    rows = found["scattering"]["sweep"]
    inside = [row for row in rows if PASSIVE <= row["gain"] < 1.0]
    below = the(rows, gain=0.49)
    above = [row for row in rows if row["gain"] >= 1.0]
    return Verdict(
        measured=f"largest norm less one over {inside[0]['combinations']} settings each of b, "
        f"lambda, T: {max(row['largest_norm'] for row in inside) - 1.0:+.0e}; with K = 0.49 the "
        f"norm reaches {below['largest_norm']:.3f}",
        holds=all(row["largest_norm"] <= 1.0 + ROUNDING for row in inside),
        reason="K >= 1/2 is enough and needed, by proof; an upper bound is not needed: K = "
        + ", ".join(f"{row['gain']:g}: {row['largest_norm'] - 1.0:+.0e}" for row in above),
    )


def figure_8(found: Found) -> Verdict:
    """The printed curve: never above one, and periodic."""
    data = found["scattering"]["fig8"]
    omega, norm = np.array(data["omega_rad_s"]), np.array(data["norm"]["K = 0.6"])
    period = data["period_rad_s"]
    inner = norm[1:-1]
    peaks = omega[1:-1][(inner >= norm[:-2]) & (inner > norm[2:])]
    apart = np.diff(peaks)
    return Verdict(
        measured=f"norm from {np.min(norm):.4f} to {np.max(norm):.8f}; maxima {np.min(apart):.2f} "
        f"to {np.max(apart):.2f} rad/s apart, pi/T = {period:.2f} rad/s",
        holds=bool(np.max(norm) <= 1.0 + ROUNDING and np.all(np.abs(apart / period - 1.0) < 0.05)),
    )


def filter_reduces_the_norm(found: Found) -> Verdict:
    """The norm's mean and maximum in one period after the other."""
    data = found["scattering"]["fig8"]
    mean, most = np.array(data["mean_by_period"]), np.array(data["largest_by_period"])
    bare = np.array(data["norm"]["K = 0.6, no low-pass"])
    return Verdict(
        measured=f"over {len(mean)} periods the mean falls from {mean[0]:.3f} to {mean[-1]:.3f} "
        f"and the maximum from {most[0]:.3f} to {most[-1]:.3f}; without low-pass the maximum "
        f"stays {np.max(bare):.3f}",
        holds=bool(np.all(np.diff(mean) < 0.0) and np.all(np.diff(most) < 0.0)),
        reason="it cannot make a K below 1/2 passive",
    )


def delay_is_only_periodic(found: Found) -> Verdict:
    """The largest norm of one K over T."""
    rows = found["scattering"]["delays"]
    norms = [row["largest_norm"] for row in rows]
    told = ", ".join(f"T = {row['delay_s']:g} s: {row['largest_norm']:.3f}" for row in rows[::3])
    quick, slow = rows[0], rows[-1]
    return Verdict(
        measured=f"largest norm at K = 0.3: {told}",
        holds=max(norms) - min(norms) < SAME,
        reason="true without the low-pass; with it T says how much of the norm's period the filter "
        f"lets through, and the smallest passive K grows from {quick['least_passive_gain']:.2f} at "
        f"T = {quick['delay_s']:g} to {slow['least_passive_gain']:.4f} at {slow['delay_s']:g} s; "
        "1/2 is enough for every T",
    )


def impedance_affects_passivity(found: Found) -> Verdict:
    """Is the channel passive for some b and not for others, with the same K?"""
    rows = found["scattering"]["impedances"]
    at_half = {row["largest_norm_at_half"] <= 1.0 + ROUNDING for row in rows}
    below = {row["largest_norm_below"] <= 1.0 + ROUNDING for row in rows}
    b = [row["impedance_n_s_m"] for row in rows]
    norms = [row["largest_norm_below"] for row in rows]
    return Verdict(
        measured=f"b from {min(b):g} to {max(b):g} N s/m: K = 0.5 is passive with each of them; "
        f"K = 0.45 with none, norms {min(norms):.4f} to {max(norms):.3f}",
        holds=len(at_half) > 1 or len(below) > 1,
        reason="K alone decides; b only says how far above one the norm is",
    )


def guaranteed_stability(found: Found) -> Verdict:
    """Energy of the channel, and the runs of the whole chain."""
    rows = found["channel"]["rows"]
    active = [row for row in rows if row["scheme"] in ("K = 0.3", "K = 0.49")]
    passive = [row for row in rows if row not in active]
    sets = found["sets"]["rows"]
    least = min(row["least_energy_j"]["channel_j"] for row in sets)
    faults = sum(row["faults"] for row in sets)
    lost = ", ".join(
        f"{name} {min(row['least_j'] for row in active if row['scheme'] == name):.2g} J"
        for name in ("K = 0.3", "K = 0.49")
    )
    return Verdict(
        measured=f"least energy of the channel with K >= 1/2 or standard waves "
        f"{min(row['least_j'] for row in passive):.0e} J in {len(passive)} runs, in the sets "
        f"{least:.0e} J, {faults} faults; with the worst sinusoid {lost}",
        holds=all(row["least_j"] >= -ENERGY for row in passive) and least >= -ENERGY
        and faults == 0,
        reason="of the channel, for a constant delay; in discrete time it is an identity",
    )  # fmt: skip


def follower_is_passive(found: Found) -> Verdict:
    """The follower's ledger: arm, PIDs and virtual force."""
    rows = found["sets"]["rows"]
    least = min(row["least_energy_j"]["follower_j"] for row in rows)
    damped = max(found["signs"]["damping"], key=lambda row: row["damping_n_s_m"])
    return Verdict(
        measured=f"least energy of the follower {least:.0e} J in {len(rows)} runs of the sets",
        holds=least >= -ENERGY,
        reason="in these runs, not in general: F_b acts on a follower that lags, so it gives out "
        "what F_e must take in, for small motion k_b <= k_f/4s (here 50 against 75 N/m); with "
        f"c_b = {damped['damping_n_s_m']:g} N s/m it gives out "
        f"{-damped['least_follower_j']:.2g} J",
    )


CHANNEL = (
    Claim(
        name="transmission",
        section="3.1, (20), (21)",
        printed="(16)-(19) together make (20) for the desired velocity and (21) for the force",
        needs=("channel",),
        judge=transmission,
    ),
    Claim(
        name="norm_below_one",
        section="3.3",
        printed="the norm of the scattering matrix never exceeds one for K in [0.5, 1)",
        needs=("scattering",),
        judge=norm_below_one,
    ),
    Claim(
        name="figure_8",
        section="3.3, Fig. 8",
        printed="with K = 0.6, b = 10, T = 1, lambda = 20 the norm is periodic and not above one",
        needs=("scattering",),
        judge=figure_8,
    ),
    Claim(
        name="filter_reduces_the_norm",
        section="3.3, Fig. 8",
        printed="the low-pass reduces the norm with increasing frequency",
        needs=("scattering",),
        judge=filter_reduces_the_norm,
    ),
    Claim(
        name="delay_is_only_periodic",
        section="3.3",
        printed="T has no influence on the norm but on its period in frequency",
        needs=("scattering",),
        judge=delay_is_only_periodic,
    ),
    Claim(
        name="impedance_affects_passivity",
        section="3.3",
        printed="b, like K, largely affects the passivity",
        needs=("scattering",),
        judge=impedance_affects_passivity,
    ),
    Claim(
        name="guaranteed_stability",
        section="abstract, 3.3, 5",
        printed="with appropriate K and b passivity and so stability is guaranteed under delay",
        needs=("channel", "sets"),
        judge=guaranteed_stability,
    ),
    Claim(
        name="follower_is_passive",
        section="3.3",
        printed="the follower with its PIDs is passive, so a passive channel is enough",
        needs=("sets", "signs"),
        judge=follower_is_passive,
    ),
)
