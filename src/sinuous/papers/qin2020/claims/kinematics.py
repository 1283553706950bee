"""2.2: kinematics."""

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.qin2020.claims.words import micro, mm, percent, tiny

EXACT = 1e-9  # what counts as no error of a place [m], a direction or an angle [rad]
WIDE = 1e-6  # points that define a plane are at least so far from a line [m]
WHOLE = 0.999  # share that is all of it
TICK = 1e-3  # of 1 kHz [s]
DEGREES = 57.29577951308232


def hole_angle(found: Found) -> Verdict:
    """(4)-(7) to the letter: is the cable of a straight robot straight?"""
    data = found["kinematics"]["holes"]
    straight = data["straight_by_module_m"]
    return Verdict(
        measured=f"straight, the cables of module 1 to {len(straight)} come out {mm(straight[0])} "
        f"to {mm(straight[-1])} too long; in {data['poses']} random poses they differ by "
        f"{mm(data['median_m'])} in the median, {mm(data['largest_m'])} at most",
        holds=max(straight) < EXACT,
        reason="a cable keeps its hole: its angle belongs to the cable, not to the plate; tendons "
        "of MuJoCo through the same holes agree with that",
    )


def unique_angles(found: Found) -> Verdict:
    """(8): lengths to angles and back."""
    data = found["kinematics"]["holes"]
    least, largest = data["residual_m"]
    return Verdict(
        measured=f"from lengths back to angles within {data['round_trip_rad']:.0e} rad",
        holds=data["round_trip_rad"] < EXACT,
        reason=f"three lengths measure two angles: if one reads {mm(data['wrong_by_m'])} wrong no "
        f"angles have these lengths, and least squares leaves {mm(least, 2)} to {mm(largest, 2)}",
    )


def no_analytic_solution(found: Found) -> Verdict:
    """2.2.2: the closed form at targets all over the disc."""
    data = found["kinematics"]["disc"]
    error = data["tip_error_m"]
    return Verdict(
        measured=f"a closed form puts the tip on {data['targets']} of {data['targets']} targets, "
        f"largest error {tiny(error)}",
        holds=error > EXACT,
        reason="with the paper's own assumptions 1 and 2 the solution of (10)-(15) is analytic; "
        "without them there are infinitely many",
    )


def geometric_solution(found: Found) -> Verdict:
    """2.2.2: tip and last tube by the robot's own forward kinematics."""
    data = found["kinematics"]["disc"]
    bend, limit = data["largest_bend_rad"] * DEGREES, data["bend_limit_rad"] * DEGREES
    return Verdict(
        measured=f"{data['targets']} targets, chi = {data['chi_rad'] * DEGREES:.1f} deg: tip error "
        f"at most {tiny(data['tip_error_m'])}, last tube parallel to Y within "
        f"{data['tube_tilt_rad']:.0e} rad; {percent(data['within_limit_share'])} within the joint "
        f"limit of {limit:.1f} deg, largest bend {bend:.1f} deg",
        holds=data["tip_error_m"] < EXACT and data["tube_tilt_rad"] < EXACT,
        reason="in our reading of (11)-(15); neither chi nor a joint limit is printed",
    )


def fewest_joints(found: Found) -> Verdict:
    """(11): joints before joint k stay as they are in the reference pose."""
    data = found["kinematics"]["disc"]
    shares = ", ".join(
        f"k = {k}: {percent(share, 0)}" for k, share in enumerate(data["share_by_k"], 1)
    )
    return Verdict(
        measured=f"joints before k move by {data['moved_before_k_rad']:.0e} rad; {shares}",
        holds=data["moved_before_k_rad"] < EXACT,
        reason="several k satisfy (11) for many targets; we take the largest",
    )


def plane_of_13(found: Found) -> Verdict:
    """(13): do A_1r, A_N-2r and A_Nr define a plane?"""
    data = found["kinematics"]["plane"]
    width, length = data["width_of_printed_points_m"], data["length_of_printed_points_m"]
    jump = max(row["farther_m"] for row in data["farther_intersection"])
    near = max(row["nearer_m"] for row in data["farther_intersection"])
    return Verdict(
        measured=f"they are {mm(length, 0)} long and {tiny(width)} wide; with the plane x = 0 of "
        f"the reference pose {percent(data['without_point_in_the_plane_share'], 0)} of the targets "
        f"have no solution; at a switch of k the farther intersection jumps by {mm(jump, 0)}, the "
        f"nearer one by {tiny(near)}",
        holds=width > WIDE,
        reason="the three points are on the straight reference line; ours is the plane of that "
        "line and A_N,d",
    )


def directions_of_14(found: Found) -> Verdict:
    """(14) to the letter: where the tip then is."""
    data = found["kinematics"]["links"]
    return Verdict(
        measured=f"the tip misses by {mm(data['printed_median_m'])} in the median and "
        f"{mm(data['printed_largest_m'])} at most; in the frame of the link before by "
        f"{tiny(data['ours_largest_m'])}",
        holds=data["printed_largest_m"] < EXACT,
        reason="joint angles turn in the frame of the link before, not in the world's",
    )


def boundary_can_be_reached(found: Found) -> Verdict:
    """4.3: is there a plane in which the whole square can be reached within joint limits?"""
    rows = found["kinematics"]["by_chi"]
    best = max(rows, key=lambda row: row["square_share"])
    free = max((row for row in rows if row["within_limit_share"] == 1.0),
               key=lambda row: row["chi_rad"], default=rows[0])  # fmt: skip
    return Verdict(
        measured=f"at most {percent(best['square_share'], 0)} of the square, at chi = "
        f"{best['chi_rad'] * DEGREES:.1f} deg; without any breach of the joint limit the disc's "
        f"radius is at most {mm(free['radius_m'])} (chi = {free['chi_rad'] * DEGREES:.1f} deg)",
        holds=best["square_share"] > WHOLE,
        reason="with the printed dimensions; plates touch at 39.1 deg. Each side can be reached, "
        "the corners cannot",
    )


def real_time(found: Found) -> Verdict:
    """Abstract, 4: time of a target."""
    data = found["kinematics"]["times"]
    return Verdict(
        measured=f"{micro(data['at_once_mean_s'])} per target for many at once; one by one median "
        f"{micro(data['one_by_one_median_s'])}, 99 of 100 within {micro(data['one_by_one_p99_s'])}",
        holds=data["one_by_one_p99_s"] < TICK,
        reason="other machine; a tick of 1 kHz is 1000 us",
    )


def iteration_is_too_slow(found: Found) -> Verdict:
    """Abstract, 1: do solvers that iterate miss a tick of 1 kHz?"""
    ours, *peers = found["kinematics"]["times"]["solvers"]
    told = ", ".join(
        f"{row['solver']} {row['median_us']:.2g} us ({row['median_us'] / ours['median_us']:.0f} "
        f"times ours, {percent(row['solved'], 0)} solved)"
        for row in peers
    )
    return Verdict(
        measured=f"median: {told}",
        holds=all(row["p99_us"] * 1e-6 > TICK for row in peers),
        reason="compiled as ours is, on today's machine, for ten joint angles, from the reference "
        "pose, to 1 um: slower, but not too slow for 1 kHz",
    )


KINEMATICS = (
    Claim(
        name="hole_angle",
        section="2.2.1, (4)-(7)",
        printed="the hole angle grows with the number i of the plate that a cable passes, and "
        "cable lengths are sums of the distances between these holes",
        needs=("kinematics",),
        judge=hole_angle,
    ),
    Claim(
        name="unique_angles",
        section="2.2.1, (8)",
        printed="three given cable lengths make the angles of a joint unique and definite",
        needs=("kinematics",),
        judge=unique_angles,
    ),
    Claim(
        name="no_analytic_solution",
        section="2.2.2",
        printed="an analytic solution of the inverse kinematics does not exist",
        needs=("kinematics",),
        judge=no_analytic_solution,
    ),
    Claim(
        name="geometric_solution",
        section="2.2.2, (10)-(15)",
        printed="the geometric method puts the tip on targets in the plane PTY with the last tube "
        "parallel to Y",
        needs=("kinematics",),
        judge=geometric_solution,
    ),
    Claim(
        name="fewest_joints",
        section="2.2.2, (11)",
        printed="moving the last N - k + 1 modules is enough",
        needs=("kinematics",),
        judge=fewest_joints,
    ),
    Claim(
        name="plane_of_13",
        section="2.2.2, (13)",
        printed="A_1r, A_N-2r and A_Nr define the plane in which A_k+1 is looked for",
        needs=("kinematics",),
        judge=plane_of_13,
    ),
    Claim(
        name="directions_of_14",
        section="2.2.2, (14)",
        printed="joint angles follow from the directions of neighbouring links in the world",
        needs=("kinematics",),
        judge=directions_of_14,
    ),
    Claim(
        name="boundary_can_be_reached",
        section="4.3",
        printed="the tip moves freely in a plane up to a boundary of +-18 cm in X and Z",
        needs=("kinematics",),
        judge=boundary_can_be_reached,
    ),
    Claim(
        name="real_time",
        section="abstract, 2.2.2, 4",
        printed="the inverse kinematics is fast enough for control in real time",
        needs=("kinematics",),
        judge=real_time,
    ),
    Claim(
        name="iteration_is_too_slow",
        section="abstract, 1, 2.2.2",
        printed="pseudo-inverse and iteration are so time-consuming that they hardly allow control "
        "in real time",
        needs=("kinematics",),
        judge=iteration_is_too_slow,
    ),
)
