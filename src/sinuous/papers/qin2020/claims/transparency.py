"""3.3: transparency of the channel."""

import numpy as np

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.qin2020.claims.words import mm, percent

ROUNDING = 1e-9  # relative
FORCE = 1e-9  # taken for none [N]
SPEED = 1e-6  # taken for none [m/s]


def exact_at_rest(found: Found) -> Verdict:
    """F_m against F_s of one delay before, the leader at rest."""
    rows = found["transparency"]["waiting"]
    most = max(row["waiting_n"] for row in rows)
    return Verdict(
        measured=f"an operator who moves and waits: F_m(t) and F_s(t - T) differ by {most:.0e} N "
        "while the leader stands still",
        holds=most < FORCE,
        reason="so says (21); a hand that creeps feels K b times its speed",
    )


def trade_off(found: Found) -> Verdict:
    """Distortion and force error over b."""
    rows = found["transparency"]["rows"]
    gains = sorted({row["gain"] for row in rows})
    good = True
    for gain in gains:
        chosen = sorted(
            (row for row in rows if row["gain"] == gain), key=lambda row: row["impedance_n_s_m"]
        )
        velocity = np.diff([row["velocity_m_s"] for row in chosen])
        force = np.diff([row["force_n"] for row in chosen])
        good = good and bool(np.all(velocity < 0.0) and np.all(force > 0.0))
    one = sorted((row for row in rows if row["gain"] == gains[0]),
                 key=lambda row: row["impedance_n_s_m"])  # fmt: skip
    told = ", ".join(
        f"b = {row['impedance_n_s_m']:g}: {mm(row['velocity_m_s'], 0)}/s and {row['force_n']:.2f} N"
        for row in one
    )
    return Verdict(
        measured=f"distortion of the desired velocity and force error (rms) at K = {gains[0]:g}: "
        f"{told}",
        holds=good,
        reason="a point with the lag of the printed K_P, the same motion of the leader",
    )


def secondary_parameter(found: Found) -> Verdict:
    """K: no change of the velocity, force error in proportion."""
    rows = found["transparency"]["rows"]
    spread, slope = 0.0, 0.0
    for b in {row["impedance_n_s_m"] for row in rows}:
        chosen = [row for row in rows if row["impedance_n_s_m"] == b]
        velocity = np.array([row["velocity_m_s"] for row in chosen])
        ratio = np.array([row["force_n"] / row["gain"] for row in chosen])
        spread = max(spread, float(np.ptp(velocity) / np.mean(velocity)))
        slope = max(slope, float(np.ptp(ratio) / np.mean(ratio)))
    return Verdict(
        measured=f"over K the velocity's distortion changes by {spread:.0e} of itself, and force "
        f"error by K by {slope:.0e}",
        holds=spread < ROUNDING and slope < ROUNDING,
        reason="K >= 1/2 for passivity, so the force error can be halved and no more",
    )


def improved_transparency(found: Found) -> Verdict:
    """Lawrence's measure: what a held end feels like, by what a free one does."""
    felt = found["transparency"]["felt"]
    width = {name: one["width_when_slow"] for name, one in felt.items()}
    return Verdict(
        measured="impedance felt with the other end held by that with nothing there, at 1 rad/s: "
        + ", ".join(f"{name} {value:.1f}" for name, value in width.items()),
        holds=width["C2"] > width["C1"],
        reason="against C1. Standard waves tell more apart as long as the hand is slow, and "
        "resonate at pi/2T and its multiples",
    )


def desired_velocity(found: Found) -> Verdict:
    """The desired velocity, and place, at rest in contact."""
    rows, runs = found["drift"]["at_rest"], found["drift"]["runs"]
    error = max(row["velocity_error_m_s"] for row in rows)
    theory = max(abs(row["offset_m"] / row["theory_m"] - 1.0) for row in rows)
    offset = min(row["offset_m"] for row in rows)
    end = {row["case"]: mm(abs(row["last_offset_m"])) for row in runs}
    return Verdict(
        measured=f"at rest in contact the desired velocity is off by {error:.0e} m/s; the desired "
        f"place by up to {mm(abs(offset), 0)}, within {percent(theory)} of (2T + 1/lambda) F_s / b",
        holds=error < SPEED,
        reason="the velocity, not the place, which no wave carries: the offset goes with F_s "
        f"({end['as printed']} left), but not after clamping ({end['clamped']}) or lost packets "
        f"({end['lost']}); with our passive correction {end['clamped, corrected']} and "
        f"{end['lost, corrected']}",
    )


TRANSPARENCY = (
    Claim(
        name="desired_velocity",
        section="3.3",
        printed="the desired velocity reaches its value when the tracking error is steady",
        needs=("drift",),
        judge=desired_velocity,
    ),
    Claim(
        name="exact_at_rest",
        section="3.3",
        printed="with move and wait F_m(t) equals F_s(t - T) exactly while the leader is at rest",
        needs=("transparency",),
        judge=exact_at_rest,
    ),
    Claim(
        name="trade_off",
        section="3.3",
        printed="a larger b suppresses the distortion of the desired velocity and increases the "
        "error of the force",
        needs=("transparency",),
        judge=trade_off,
    ),
    Claim(
        name="secondary_parameter",
        section="3.3",
        printed="a small K reduces the force error that b makes and leaves the velocity alone",
        needs=("transparency",),
        judge=secondary_parameter,
    ),
    Claim(
        name="improved_transparency",
        section="abstract, 3.3",
        printed="the modified waves improve the transparency",
        needs=("transparency",),
        judge=improved_transparency,
    ),
)
