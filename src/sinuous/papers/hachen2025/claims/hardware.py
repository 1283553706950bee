"""IV: what the prototype showed, beside a simulated robot that is not its model."""

import numpy as np

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.hachen2025.claims.words import mm

LOCAL, OURS = "MPC + local", "MPC + local, offset-free"
HERE = "a robot in simulation, not the prototype"
ARRIVED = 1e-4  # a nominal tip that is no farther away is at its goal [m]
LEFT = 2e-3  # a real tip that is farther away than this is not [m]
PRINTED_OVERSHOOT = 2.5e-3  # [m]
RESPONDS = 0.5  # of the error with slack cables, left where they are tight


def _goals(found: Found, test: str, controller: str, key: str) -> np.ndarray:
    """Values (robots, goals) of a test."""
    return np.array(
        [
            row[key]
            for row in found["hardware"]["rows"]
            if (row["test"], row["controller"]) == (test, controller)
        ]
    )


def nominal_reaches_its_goals(found: Found) -> Verdict:
    """Nominal and real errors at the four goals."""
    nominal = _goals(found, "goals", LOCAL, "nominal_error_at_goals_m")
    real = _goals(found, "goals", LOCAL, "real_error_at_goals_m")
    ours = _goals(found, "goals", OURS, "real_error_at_goals_m")
    return Verdict(
        measured=f"nominal error at the goals at most {mm(float(nominal.max()), 3)}, real "
        f"{mm(float(real.mean()))} on average; offset-free {mm(float(ours.mean()))}",
        holds=bool(nominal.max() < ARRIVED),
        reason=f"{HERE}; what is left of the real error is the tracker's bias",
    )


def slack_leaves_an_error(found: Found) -> Verdict:
    """Errors and inputs with cables that go slack, and with cables that do not."""
    slack = _goals(found, "slack", LOCAL, "local_error_at_goals_m")
    tight = _goals(found, "goals", LOCAL, "local_error_at_goals_m")
    nominal = _goals(found, "slack", LOCAL, "nominal_error_at_goals_m")
    inputs = _goals(found, "slack", LOCAL, "local_input_at_goals_m_s")
    stuck = slack[0] > LEFT
    return Verdict(
        measured=f"local error at the goals {', '.join(mm(v, 1) for v in slack[0])} with slack "
        f"cables, {', '.join(mm(v, 1) for v in tight[0])} without; the local controller goes on "
        f"with {', '.join(mm(v, 1) for v in inputs[0])}/s",
        holds=bool(
            np.any(stuck & (nominal[0] < ARRIVED)) and tight[0].max() < RESPONDS * slack[0].max()
        ),
        reason=HERE,
    )


def boundary_is_held(found: Found) -> Verdict:
    """Room of the nominal and the real tip while the target is beyond the wall."""
    rows = [row for row in found["hardware"]["rows"] if row["test"] == "boundary"]
    margin = rows[0]["margin_m"]
    paper = [row for row in rows if row["controller"] == LOCAL]
    overshoot = margin - min(row["least_tip_room_m"] for row in paper)
    body = min(row["least_actual_clearance_m"] for row in rows)
    return Verdict(
        measured=f"{sum(row['nominal_violations'] for row in rows)} nominal violations; the real "
        f"tip comes up to {mm(overshoot)} closer than the margin of {mm(margin, 1)}; least "
        f"clearance of any real body {mm(body)}",
        holds=all(row["nominal_violations"] == 0 for row in rows)
        and overshoot <= PRINTED_OVERSHOOT
        and body > 0.0,
        reason=HERE,
    )


def speeds_are_kept(found: Found) -> Verdict:
    """Norms of the plan's input cannot exceed what the printed speeds allow."""
    rows = [row for row in found["hardware"]["rows"] if row["curves"] is not None]
    limit = float(np.sqrt(9 * 4.5e-3**2 + 3 * 0.9e-3**2))
    fastest = max(max(row["curves"]["nominal_input_m_s"]) for row in rows)
    return Verdict(
        measured=f"largest norm of the plan's input {mm(fastest, 1)}/s, possible are "
        f"{mm(limit, 1)}/s",
        holds=fastest <= limit,
        reason=HERE,
    )


def prototype(_: Found) -> Verdict:
    """What only the prototype can tell."""
    return Verdict(
        measured="",
        holds=None,
        reason="needs the prototype: section IV runs here on a simulated robot that is not its "
        "model",
    )


HARDWARE = (
    Claim(
        name="prototype",
        section="abstract, IV",
        printed="the method is validated on a hardware prototype",
        needs=(),
        judge=prototype,
    ),
    Claim(
        name="nominal_reaches_its_goals",
        section="IV-A, Fig. 12",
        printed="the nominal system reaches its goals; the real one follows it in part",
        needs=("hardware",),
        judge=nominal_reaches_its_goals,
    ),
    Claim(
        name="slack_leaves_an_error",
        section="IV-A",
        printed="where cables lose tension the error stays, although the local controller acts",
        needs=("hardware",),
        judge=slack_leaves_an_error,
    ),
    Claim(
        name="boundary_is_held",
        section="IV-B, Fig. 13",
        printed="the nominal system holds the boundary; the real tip overshoots by at most "
        "2.5 mm, within the margin of 5.5 mm",
        needs=("hardware",),
        judge=boundary_is_held,
    ),
    Claim(
        name="speeds_are_kept",
        section="IV-A",
        printed="actuators are kept to 4.5 mm/s for tendons and 0.9 mm/s for the backbone",
        needs=("hardware",),
        judge=speeds_are_kept,
    ),
)
