"""3.2: the virtual force."""

import numpy as np

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.qin2020.claims.words import mm, the
from sinuous.papers.qin2020.signs.figures import OURS, PRINTED

STAYS = 1.0  # a follower that goes farther is lost [m]
ROUNDING = 1e-9  # relative


def sensitive_force(found: Found) -> Verdict:
    """(24): bounded, continuous, steepest where the error is small."""
    data = found["signs"]["error"]
    error, force = np.array(data["error_m"]), np.array(data["force_n"])
    slope = np.diff(force) / np.diff(error)
    middle = len(slope) // 2
    bound = 0.5 * data["gain_n"]
    step = the(found["signs"]["damper"], force=OURS, side="upper")["force_n"]
    return Verdict(
        measured=f"at most {np.max(np.abs(force)):.2f} N of k_f/2 = {bound:.1f} N; "
        f"{slope[middle]:.0f} N/m at no error, {slope[-1]:.0f} N/m at {mm(error[-1], 0)}",
        holds=bool(
            np.max(np.abs(force)) <= bound * (1.0 + ROUNDING)
            and np.argmax(slope) in (middle - 1, middle)
        ),
        reason=f"F_e, with its error in units of {mm(data['length_m'], 0)}: in metres as printed "
        f"{mm(error[-1], 0)} would be {abs(data['unscaled_n'][-1]):.3f} N. F_b is a step where its "
        f"damper sets in, {step:.1f} N at 0.1 m/s",
    )


def printed_signs(found: Found) -> Verdict:
    """(24), (25) as printed: does the follower stay?"""
    rows = found["signs"]["point"]
    told = {
        name: " and ".join(
            f"{row['farthest_m']:.2g} m ({row['side']})" for row in rows if row["force"] == name
        )
        for name in (PRINTED, OURS)
    }
    arm = max(
        row["desired_farthest_m"] for row in found["signs"]["chain"] if row["force"] == PRINTED
    )
    held = max(row["desired_farthest_m"] for row in found["signs"]["chain"] if row["force"] == OURS)
    return Verdict(
        measured=f"pushed against a side of the boundary a point goes to {told[PRINTED]}; with the "
        f"other sign to {told[OURS]}. In the whole chain the desired place goes to {mm(arm, 0)}, "
        f"with the other sign to {mm(held, 0)}",
        holds=all(row["farthest_m"] < STAYS for row in rows if row["force"] == PRINTED),
        reason="(24) and (25) are forces on the hand, but (18) to (21) and (27) take F_s for the "
        "reaction that opposes it; only the arm's length then bounds the motion",
    )


def damper_on_both_sides(found: Found) -> Verdict:
    """(25): c_b (v . N), a number, at the upper and the lower side."""
    rows = [row for row in found["signs"]["damper"] if row["force"] == "scalar"]
    told = ", ".join(
        f"{row['side']} {'resists' if row['resists'] else 'pushes on'}" for row in rows
    )
    damping = max(found["signs"]["damping"], key=lambda row: row["damping_n_s_m"])
    mild = min(found["signs"]["damping"], key=lambda row: row["damping_n_s_m"])
    return Verdict(
        measured=f"with the sign that resists at the upper side: {told}",
        holds=all(row["resists"] for row in rows),
        reason="the product is a number with the same sign on both sides; a vector along N is "
        f"meant. Read per cm c_b is {damping['damping_n_s_m']:g} N s/m: a first contact of "
        f"{damping['largest_force_n']:.1f} N instead of {mild['largest_force_n']:.1f} N, and a "
        f"swing of {damping['swing_at_rest_n']:.1f} N at rest",
    )


FORCES = (
    Claim(
        name="sensitive_force",
        section="3.2, (24)",
        printed="the virtual force is continuous and bounded in the tracking error, and more "
        "sensitive while it is small",
        needs=("signs",),
        judge=sensitive_force,
    ),
    Claim(
        name="printed_signs",
        section="3.2, (24), (25)",
        printed="F_e and F_b, put into (18)-(21) and (27), keep the follower at the boundary",
        needs=("signs",),
        judge=printed_signs,
    ),
    Claim(
        name="damper_on_both_sides",
        section="3.2, (25)",
        printed="c_b, velocity and normal vector make a damper wherever the boundary is passed",
        needs=("signs",),
        judge=damper_on_both_sides,
    ),
)
