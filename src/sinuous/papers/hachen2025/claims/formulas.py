"""II: formulas that are checked as they are printed."""

import numpy as np

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.hachen2025.claims.words import mm

MOVED = 1e-9  # a tip that comes no closer than this to its target did not move [m]
ARRIVED = 1e-5  # the steady tip error that counts as none [m]


def restart(found: Found) -> Verdict:
    """(17) as printed: does the tip come closer?"""
    data = found["printed"]["restart"]
    printed, ours = data["printed_tip_error_m"], data["ours_tip_error_m"]
    gained = printed[0] - printed[-1]
    return Verdict(
        measured=f"the tip comes {mm(gained)} closer in {len(printed)} steps; "
        f"from x*[1|k-1] it ends {mm(ours[-1], 4)} from the target",
        holds=gained > MOVED,
        reason="x*[0|k-1] is where the last step began: nothing ever moves",
    )


def steady_error(found: Found) -> Verdict:
    """(10) as printed: does the tip come to rest at its target?"""
    ends = {name: errors[-1] for name, errors in found["printed"]["cost"].items()}
    printed = next(error for name, error in ends.items() if name.startswith("printed, S = 10"))
    return Verdict(
        measured="; ".join(f"{name}: {mm(error, 4)}" for name, error in ends.items()),
        holds=printed < ARRIVED,
        reason="x'Sx pulls every length towards zero, so the tip rests beside its target",
    )


def penalty_sign(found: Found) -> Verdict:
    """(30) as printed: does the penalty fall?"""
    h = found["printed"]["penalty"]
    share = {name: values[-1] / values[0] for name, values in h.items()}
    return Verdict(
        measured=f"(31) becomes {share['printed']:.1f} times what it was; "
        f"with the other sign {share['ours']:.2f} times",
        holds=share["printed"] < 1.0,
        reason="+ dh/du climbs the penalty",
    )


def smoother_with_longer_horizons(found: Found) -> Verdict:
    """III-C: do oscillations of the input fall with the horizon?"""
    rows = found["printed"]["smoothness"]
    horizons = sorted({row["horizon"] for row in rows})
    rough = {
        N: float(np.median([row["roughness"] for row in rows if row["horizon"] == N]))
        for N in horizons
    }
    return Verdict(
        measured="second differences of the input by its norm: "
        + ", ".join(f"N = {N}: {value:.3f}" for N, value in rough.items()),
        holds=rough[horizons[-1]] < rough[horizons[0]],
        reason="with the printed cost in free space",
    )


FORMULAS = (
    Claim(
        name="restart",
        section="II-C3, (17)",
        printed="the next prediction starts from x*[0|k-1]",
        needs=("printed",),
        judge=restart,
    ),
    Claim(
        name="steady_error",
        section="II-C1, (10)",
        printed="the first term makes the tip converge to its target, "
        "beside a third term x'Sx with S = 10",
        needs=("printed",),
        judge=steady_error,
    ),
    Claim(
        name="penalty_sign",
        section="III-A, (30)",
        printed="the term + W dh/du steers the body into the safe zone",
        needs=("printed",),
        judge=penalty_sign,
    ),
    Claim(
        name="smoother_with_longer_horizons",
        section="III-C",
        printed="slight oscillations of the input fall as the horizon grows",
        needs=("printed",),
        judge=smoother_with_longer_horizons,
    ),
)
