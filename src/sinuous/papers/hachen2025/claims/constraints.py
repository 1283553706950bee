"""III-D, III-E and V: shape constraints, stability, unreachable targets, limits."""

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.hachen2025.claims.words import least, mm, values, worst

MPC, DLS, BEST = "MPC", "DLS, printed gains", "DLS, best gains"
REACHED = 1e-3  # a way-point is reached if the tip is no farther away [m]
JUMP = 0.01  # of a target between two steps [m]
ALIKE = 1.05  # bends that differ by less are alike
ROUNDING = 1e-6  # of a margin at rest [m], of a speed relative to its limit


def obstacles_as_constraints(found: Found) -> Verdict:
    """Steps of the nominal body beyond its margin, in every scene."""
    rows = found["waypoints"]["rows"]
    ours = [row for row in rows if row["controller"].startswith("MPC")]
    broken = sum(row["nominal_violations"] for row in ours)
    steps = sum(row["steps"] for row in ours)
    alone = least(ours, "least_actual_clearance_m", controller="MPC alone")
    local = least(ours, "least_actual_clearance_m", controller="MPC + local")
    return Verdict(
        measured=f"{broken} of {steps} steps break the margin; least nominal clearance "
        f"{mm(least(ours, 'least_nominal_clearance_m'))} of {mm(ours[0]['margin_m'])}",
        holds=broken == 0,
        reason=f"the nominal body; with the printed disturbance the real one comes to {mm(alone)}, "
        f"with the local controller to {mm(local)}: a draw that jumps the other way finds the "
        "last one already undone",
    )


def both_reach_the_waypoints(found: Found) -> Verdict:
    """Tip errors at the way-points of the winding tube, and who stayed inside."""
    rows = [row for row in found["waypoints"]["rows"] if not row["disturbed"]]
    tube = [row for row in rows if row["scene"] == "winding_tube"]
    error = {row["controller"]: max(row["nominal_error_at_waypoints_m"]) for row in tube}
    room = {row["controller"]: row["least_actual_clearance_m"] for row in tube}
    return Verdict(
        measured="; ".join(
            f"{name}: largest error {mm(error[name])}, least clearance {mm(room[name])}"
            for name in error
        ),
        holds=all(value < REACHED for value in error.values())
        and all(value >= 0.0 for value in room.values()),
        reason="DLS reaches the targets and leaves the zone on its way",
    )


def inverted_u(found: Found) -> Verdict:
    """The last way-point of the inverted U."""
    (row,) = (
        row
        for row in found["waypoints"]["rows"]
        if not row["disturbed"] and (row["scene"], row["controller"]) == ("inverted_u", MPC)
    )
    error = row["nominal_error_at_waypoints_m"][-1]
    return Verdict(
        measured=f"the tip ends {mm(error, 3)} from the last way-point, least clearance "
        f"{mm(row['least_nominal_clearance_m'])}",
        holds=error < REACHED and row["nominal_violations"] == 0,
    )


def efficient_shape(found: Found) -> Verdict:
    """Bend of the last shape, all segments together, beside those who stayed inside."""
    rows = [row for row in found["waypoints"]["rows"] if not row["disturbed"]]
    bends = [
        f"{row['controller']} {row['bend_at_the_end_rad']:.2f} rad"
        for row in rows
        if row["scene"] == "winding_tube"
    ]
    pairs = [
        (ours["bend_at_the_end_rad"], other["bend_at_the_end_rad"])
        for ours in rows
        for other in rows
        if ours["controller"] == MPC != other["controller"]
        and ours["scene"] == other["scene"]
        and other["least_actual_clearance_m"] >= 0.0
    ]
    return Verdict(
        measured=f"bend at the last way-point of the winding tube: {', '.join(bends)}",
        holds=all(ours <= ALIKE * other for ours, other in pairs) if pairs else None,
        reason="" if pairs else "nobody else got there without leaving the zone",
    )


def _restless(found: Found, controller: str) -> tuple[int, int, int]:
    """Targets at which a tip does not rest, at which it goes to and fro, and all."""
    data = found["stability"]
    rows = [row for row in data["rows"] if row["controller"] == controller]
    moving = [row for row in rows if row["extent_m"] > data["oscillating_above_m"]]
    back = [row for row in moving if row["path_m"] > data["turns_back"] * row["extent_m"]]
    return len(moving), len(back), len(rows)


def dls_is_unstable_somewhere(found: Found) -> Verdict:
    """Whether the search found a target at which DLS goes to and fro."""
    names = list(found["stability"]["gains"])
    counts = {name: _restless(found, name) for name in names}
    return Verdict(
        measured="; ".join(
            f"{name}: {moving} of {total} move by more than 0.5 mm in the last 2 s, {back} to "
            "and fro"
            for name, (moving, back, total) in counts.items()
        ),
        holds=any(back > 0 for _, back, _ in counts.values()),
    )


def mpc_is_stable(found: Found) -> Verdict:
    """Targets at which the MPC does not come to rest."""
    moving, back, total = _restless(found, MPC)
    return Verdict(
        measured=f"{moving} of {total} targets move by more than 0.5 mm in the last 2 s, "
        f"{back} to and fro",
        holds=moving == 0,
    )


def margin_at_unreachable_targets(found: Found) -> Verdict:
    """Clearance of the MPC at rest beside targets outside the zone."""
    data = found["unreachable"]
    room = least(data["rest"], "clearance_at_rest_m", controller=MPC, projected=False)
    missing = max(data["margin_m"] - room, 0.0)
    return Verdict(
        measured=f"least clearance at rest {mm(room, 3)} of {mm(data['margin_m'])}, over "
        f"{len(values(data['rest'], 'outside_m', controller=MPC))} targets",
        holds=missing <= ROUNDING,
    )


def dls_violates(found: Found) -> Verdict:
    """Clearance of DLS at rest beside the same targets."""
    rows = found["unreachable"]["rest"]
    room = {name: values(rows, "clearance_at_rest_m", controller=name, projected=False)
            for name in (DLS, BEST)}  # fmt: skip
    return Verdict(
        measured="; ".join(
            f"{name}: {int(sum(v < 0.0))} of {len(v)} end in the wall, least clearance "
            f"{mm(float(min(v)))}"
            for name, v in room.items()
        ),
        holds=bool(all(room[DLS] < 0.0)),
        reason="the tip has no penalty in (31)",
    )


def projection_is_volatile(found: Found) -> Verdict:
    """Jumps of projected targets."""
    rows = found["unreachable"]["sweeps"]
    aim = worst(rows, "aim_jump_m", projected=True)
    return Verdict(
        measured=f"the projected target jumps by up to {mm(aim, 1)} in one step, the target by "
        f"{mm(found['unreachable']['speed_m_s'] * found['unreachable']['dt_s'], 1)}",
        holds=aim > JUMP,
    )


def true_target_is_calmer(found: Found) -> Verdict:
    """How far the tip moves beyond the target's own motion, with and without projection."""
    rows = found["unreachable"]["sweeps"]
    names = list(dict.fromkeys(row["sweep"] for row in rows))
    jump = {
        (name, projected): worst(
            rows, "tip_jump_in_window_m", sweep=name, controller=MPC, projected=projected
        )
        for name in names
        for projected in (False, True)
    }
    return Verdict(
        measured="the MPC's tip moves more than the target within 0.5 s by, with the true target "
        "and the projected one: "
        + "; ".join(
            f"{name} {mm(jump[name, False], 1)} and {mm(jump[name, True], 1)}" for name in names
        ),
        holds=max(jump[name, False] for name in names) < max(jump[name, True] for name in names),
        reason="the nearest place that the body can hold jumps too, if later",
    )


def limits_are_kept(found: Found) -> Verdict:
    """Speeds of actuators and of the nominal tip, as shares of their limits."""
    rows = [r for r in found["waypoints"]["rows"] if r["controller"].startswith("MPC")]
    actuator = worst(rows, "fastest_actuator")
    tip = max(row["fastest_tip_m_s"] / row["tip_speed_limit_m_s"] for row in rows)
    return Verdict(
        measured=f"fastest actuator {actuator:.4f} of its limit, fastest nominal tip {tip:.4f}",
        holds=max(actuator, tip) <= 1.0 + ROUNDING,
    )


CONSTRAINTS = (
    Claim(
        name="obstacles_as_constraints",
        section="I-B, III-D",
        printed="arbitrary obstacles are handled explicitly, as constraints",
        needs=("waypoints",),
        judge=obstacles_as_constraints,
    ),
    Claim(
        name="both_reach_the_waypoints",
        section="III-D, V",
        printed="both controllers reach four way-points in a winding tube while staying inside",
        needs=("waypoints",),
        judge=both_reach_the_waypoints,
    ),
    Claim(
        name="inverted_u",
        section="III-D",
        printed="the robot navigates through an inverted U to its target",
        needs=("waypoints",),
        judge=inverted_u,
    ),
    Claim(
        name="efficient_shape",
        section="III-D, VI",
        printed="the MPC finds a shape with little bending by itself",
        needs=("waypoints",),
        judge=efficient_shape,
    ),
    Claim(
        name="dls_is_unstable_somewhere",
        section="III-D, Fig. 9",
        printed="DLS has stability issues, especially at the edge of the workspace",
        needs=("stability",),
        judge=dls_is_unstable_somewhere,
    ),
    Claim(
        name="mpc_is_stable",
        section="III-D, V",
        printed="the MPC is stable in all cases considered",
        needs=("stability",),
        judge=mpc_is_stable,
    ),
    Claim(
        name="margin_at_unreachable_targets",
        section="III-E",
        printed="the MPC keeps the margin while its target is outside the zone",
        needs=("unreachable",),
        judge=margin_at_unreachable_targets,
    ),
    Claim(
        name="dls_violates",
        section="III-E",
        printed="DLS violates the safe zone to reach that target",
        needs=("unreachable",),
        judge=dls_violates,
    ),
    Claim(
        name="projection_is_volatile",
        section="III-E, V",
        printed="projecting targets onto the zone is volatile where it is not convex",
        needs=("unreachable",),
        judge=projection_is_volatile,
    ),
    Claim(
        name="true_target_is_calmer",
        section="V",
        printed="constraints instead of projection lead to fewer unexpected motions",
        needs=("unreachable",),
        judge=true_target_is_calmer,
    ),
    Claim(
        name="limits_are_kept",
        section="V",
        printed="hard limits on actuator speed and tip speed are imposed directly",
        needs=("waypoints",),
        judge=limits_are_kept,
    ),
)
