"""What the paper says of its experiment, judged on an arm that a physics engine moves."""

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.physics import unknown
from sinuous.papers.qin2020.claims.words import Row, mm
from sinuous.papers.qin2020.physics.experiment import MODEL, PHYSICS, PLANTS
from sinuous.papers.qin2020.sets.experiment import CONTACT, FREE

SMALL = 0.1  # of the range of motion: a small error
SIDES = 4


def follows(found: Found) -> Verdict:
    """Set 1: the real tip against its desired place."""
    if open_ := unknown(found, "sets_physics"):
        return open_
    rows = _rows(found, FREE)
    told = "; ".join(
        f"{plant} rms {mm(max(r['real_tracking_rms_m'] for r in rows if r['plant'] == plant))}, "
        f"largest {mm(max(r['real_tracking_largest_m'] for r in rows if r['plant'] == plant))}"
        for plant in PLANTS
    )
    span = min(min(row["range_m"]) for row in rows)
    weighs = [row for row in rows if row["plant"] != MODEL]
    unseen = max(row["tip_unseen_largest_m"] for row in weighs)
    return Verdict(
        measured=f"real tip to desired place: {told}; encoders miss up to {mm(unseen)} of it; "
        f"a cable is slack in {max(row['slack_fraction'] for row in weighs):.1%} of the time",
        holds=max(row["real_tracking_largest_m"] for row in weighs) < SMALL * span,
        reason="on physics: modules weigh 120 g, cables stretch",
    )


def boundary(found: Found) -> Verdict:
    """Set 2: contacts with the virtual boundary."""
    if open_ := unknown(found, "sets_physics"):
        return open_
    rows = [row for row in _rows(found, CONTACT) if row["plant"] != MODEL]
    sides = [len({(one["axis"], one["side"]) for one in row["contacts"]}) for row in rows]
    beyond = {
        plant: max(
            r["real_beyond_boundary_m"] for r in _rows(found, CONTACT) if r["plant"] == plant
        )
        for plant in PLANTS
    }
    clean = [row for row in rows if row["plant"] == PHYSICS]
    return Verdict(
        measured=f"{min(sides)} of {SIDES} sides felt; the real tip goes beyond by up to "
        + ", ".join(f"{mm(value)} ({plant})" for plant, value in beyond.items())
        + f"; least tension {min(row['least_tension_n'] for row in clean):.1f} N without play",
        holds=min(sides) == SIDES and all(row["faults"] == 0 for row in rows),
        reason="on physics: the force is that of the place that encoders see",
    )


def _rows(found: Found, name: str) -> list[Row]:
    return [row for row in found["sets_physics"]["rows"] if row["set"] == name]


VERDICTS = (
    Claim(
        name="physics_follows_closely",
        section="4.3, Figs. 10, 11",
        printed="the follower tracks the desired trajectory with a small error; on physics",
        needs=("sets_physics",),
        judge=follows,
    ),
    Claim(
        name="physics_boundary_is_felt",
        section="4.3, Figs. 12, 13",
        printed="reaching the boundary is felt on all four sides; on physics",
        needs=("sets_physics",),
        judge=boundary,
    ),
)
