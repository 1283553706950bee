"""What the paper says, judged on a robot that a physics engine moves."""

from collections.abc import Iterable

import numpy as np

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.hachen2025.claims.words import Row, least, mm, values
from sinuous.papers.hachen2025.physics.loop import BIAS, NOISE, OFFSET_FREE
from sinuous.papers.hachen2025.physics.tension import ESTIMATED, LOST, MISTAKEN, NONE, TOLD
from sinuous.papers.physics import unknown

LOCAL, OURS = "MPC + local", "MPC + local, offset-free"
HERE = "on physics, not the prototype"
RESTS = 0.5e-3  # error of a real tip that has come to its target [m]
ARRIVED = 1e-4  # and of a nominal one [m]
PRINTED_OVERSHOOT = 2.5e-3  # [m]
CURED = 0.85  # of the error without the cure


def converges(found: Found) -> Verdict:
    """Where the real tip rests, by controller."""
    if open_ := unknown(found, "physics"):
        return open_
    rows = found["physics"]["rows"]
    names = list(dict.fromkeys(row["controller"] for row in rows))
    errors = {n: _errors(rows, controller=n, sensor=NOISE) for n in names}
    biased = _errors(rows, controller=OFFSET_FREE, sensor=BIAS)
    told = "; ".join(f"{name} {_spread(error)}" for name, error in errors.items())
    return Verdict(
        measured=f"tip error at rest over {len(errors[OFFSET_FREE])} targets: {told}; with the "
        f"tracker's bias of 1.4 mm {OFFSET_FREE} {_spread(biased)}",
        holds=bool(max(np.max(error) for error in errors.values()) < RESTS),
        reason=f"{HERE}, with weight and 0.2 N across the tip; the local controller passes "
        "the sensor's noise on; DLS has 10 s, the others 6 s",
    )


def stays_inside(found: Found) -> Verdict:
    """Contacts with walls."""
    if open_ := unknown(found, "physics"):
        return open_
    rows = found["physics"]["rows"]
    ours = [row for row in rows if row["controller"].startswith("MPC")]
    touched = sum(row["wall_contacts"] > 0 for row in ours)
    return Verdict(
        measured=f"{touched} of {len(ours)} runs touch a wall; least clearance of the nominal "
        f"body {mm(least(ours, 'least_nominal_clearance_m'))}, of the real one "
        f"{mm(least(ours, 'least_actual_clearance_m'))}, margin {mm(rows[0]['margin_m'], 1)}",
        holds=touched == 0,
        reason=HERE,
    )


def reaches_its_goals(found: Found) -> Verdict:
    """Fig. 12: nominal and real errors at the four goals."""
    if open_ := unknown(found, "hardware_physics"):
        return open_
    goals = {row["controller"]: row for row in _test(found, "goals")}
    nominal = max(goals[LOCAL]["nominal_error_at_goals_m"])
    real = {name: float(np.mean(row["real_error_at_goals_m"])) for name, row in goals.items()}
    return Verdict(
        measured=f"nominal error at the goals at most {mm(nominal, 3)}; real on average "
        + ", ".join(f"{name} {mm(error)}" for name, error in real.items()),
        holds=nominal < ARRIVED,
        reason=f"{HERE}; what is left with feedback is the tracker's bias of 1.36 mm",
    )


def holds_the_boundary(found: Found) -> Verdict:
    """Fig. 13: room of the tip while its target is beyond the wall."""
    if open_ := unknown(found, "hardware_physics"):
        return open_
    rows = _test(found, "boundary")
    margin = rows[0]["margin_m"]
    overshoot = margin - least(rows, "least_tip_room_m", controller=LOCAL)
    touched = sum(row["wall_contacts"] for row in rows)
    return Verdict(
        measured=f"{sum(row['nominal_violations'] for row in rows)} nominal violations; the real "
        f"tip comes up to {mm(overshoot)} closer than the margin of {mm(margin, 1)}; steps in "
        f"contact with a wall: {touched}",
        holds=all(row["nominal_violations"] == 0 for row in rows)
        and overshoot <= PRINTED_OVERSHOOT
        and touched == 0,
        reason=HERE,
    )


def tension_matters(found: Found) -> Verdict:
    """Errors with the pretension lost, by cure."""
    if open_ := unknown(found, "tension"):
        return open_
    rows = [row for row in found["tension"]["rows"] if row["pretension_m"] == LOST]
    alone = [row for row in rows if row["controller"] == "MPC alone"]
    cures = (NONE, TOLD, ESTIMATED, MISTAKEN)
    error = {c: float(np.mean(_errors(alone, cure=c))) for c in cures}
    slack = {c: float(np.mean(values(alone, "slack_at_rest_fraction", cure=c))) for c in cures}
    told = "; ".join(f"{c} {mm(error[c], 1)}, {slack[c]:.0%} slack at rest" for c in cures)
    return Verdict(
        measured=f"mean error of a plan without feedback, 5 N of pretension, by cure: {told}",
        holds=error[TOLD] < CURED * error[NONE] and slack[NONE] > slack[TOLD],
        reason=f"{HERE}; what stays with taut cables is stretch, load and the arcs that the "
        "model counts; an estimate does not know of a pretension that got lost",
    )


def _errors(rows: Iterable[Row], **wanted: object) -> np.ndarray:
    return values(rows, "tip_error_at_rest_m", **wanted)


def _spread(error: np.ndarray) -> str:
    return f"{mm(float(np.mean(error)))} (at most {mm(float(np.max(error)))})"


def _test(found: Found, test: str) -> list[Row]:
    return [row for row in found["hardware_physics"]["rows"] if row["test"] == test]


VERDICTS = (
    Claim(
        name="physics_converges",
        section="III-C",
        printed="both controllers converge to the set point under disturbances; on physics: "
        "within 0.5 mm",
        needs=("physics",),
        judge=converges,
    ),
    Claim(
        name="physics_stays_inside",
        section="I-B, IV",
        printed="obstacles are handled as constraints, the margin of 5.5 mm makes up for what "
        "the model does not know; on physics: no contact",
        needs=("physics",),
        judge=stays_inside,
    ),
    Claim(
        name="physics_reaches_its_goals",
        section="IV-A, Fig. 12",
        printed="the nominal system reaches its goals; the real one follows it in part; on physics",
        needs=("hardware_physics",),
        judge=reaches_its_goals,
    ),
    Claim(
        name="physics_boundary_is_held",
        section="IV-B, Fig. 13",
        printed="the real tip overshoots the boundary by at most 2.5 mm, within the margin of "
        "5.5 mm; on physics",
        needs=("hardware_physics",),
        judge=holds_the_boundary,
    ),
    Claim(
        name="physics_tension_matters",
        section="IV-A, V",
        printed="the model suffers from loss of tension in the cables; on physics",
        needs=("tension",),
        judge=tension_matters,
    ),
)
