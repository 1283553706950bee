"""III-C: convergence under disturbances, and what is said of it elsewhere."""

import numpy as np

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.hachen2025.claims.words import mean, mm, values, worst

DLS, DLS_BEST, LOCAL = "DLS, printed gains", "DLS, best gains", "MPC + local"
ALONE, FREE = "MPC alone", "MPC offset-free"

# A run has converged if its error at rest is no larger than what the disturbance alone makes of
# a robot that stands at the target. Both are means over a few dozen draws.
CHANCE = 1.35
NOMINAL = 1e-5  # nominal error that counts as none [m]
SAME_TIME = 1.5  # times that differ by less are about the same
STRAIGHT = 0.95  # R^2 of an error that falls in a straight line
DECAYED = 0.1  # of the error of a robot that nothing corrects, left before the next draw
AROUND = (0.5e-3, 1.5e-3)  # "around 1 mm" [m]


def everything_converges(found: Found) -> Verdict:
    """Runs whose error at rest is more than the disturbance's own."""
    rows = found["convergence"]["rows"]
    ratio = [row["tip_error_at_rest_m"] / row["tip_error_from_disturbance_m"] for row in rows]
    failed = sum(value > CHANCE for value in ratio)
    nominal = worst(rows, "nominal_error_final_m", controller=LOCAL)
    return Verdict(
        measured=f"{failed} of {len(rows)} runs end with more than {CHANCE} times the error that "
        f"the disturbance makes by itself, at most {max(ratio):.2f} times; largest nominal "
        f"error of MPC + local {mm(nominal, 5)}",
        holds=failed == 0 and nominal < NOMINAL,
    )


def same_time(found: Found) -> Verdict:
    """Settling times of the controllers."""
    rows = found["convergence"]["rows"]
    dls = float(np.nanmedian(values(rows, "settling_time_s", controller=DLS)))
    mpc = float(np.nanmedian(values(rows, "settling_time_s", controller=LOCAL)))
    return Verdict(
        measured=f"median time until a tenth of the way is left: DLS {dls:.2f} s, MPC {mpc:.2f} s",
        holds=max(dls, mpc) / min(dls, mpc) < SAME_TIME,
        reason="the MPC is as fast as its limits, and the speed limits of the simulation are not "
        "printed; DLS has a fixed gain",
    )


def better_tracking(found: Found) -> Verdict:
    """Tip errors at rest of all controllers."""
    rows = found["convergence"]["rows"]
    names = list(dict.fromkeys(row["controller"] for row in rows))
    at_rest = {name: mean(rows, "tip_error_at_rest_m", controller=name) for name in names}
    return Verdict(
        measured="mean tip error at rest: "
        + ", ".join(f"{name} {mm(error)}" for name, error in at_rest.items()),
        holds=at_rest[LOCAL] <= min(at_rest[DLS], at_rest[DLS_BEST]),
        reason="it is the local controller that does it",
    )


def linear_approach(found: Found) -> Verdict:
    """How straight the nominal error falls."""
    straight = values(found["convergence"]["rows"], "approach_linearity", controller=LOCAL)
    median = float(np.nanmedian(straight))
    return Verdict(
        measured=f"R^2 of a line until a tenth is left, median: {median:.3f}",
        holds=median > STRAIGHT,
    )


def local_error_vanishes(found: Found) -> Verdict:
    """What is left of the local error when the next disturbance comes."""
    rows = found["convergence"]["rows"]
    local = mean(rows, "local_error_before_draws_m", controller=LOCAL)
    alone = mean(rows, "local_error_before_draws_m", controller=ALONE)
    always = mean(rows, "local_error_at_rest_m", controller=LOCAL)
    return Verdict(
        measured=f"before each new draw {mm(local)} are left, {mm(alone)} without the local "
        f"controller; mean over all time {mm(always)}",
        holds=local < DECAYED * alone,
        reason="between draws it vanishes; each draw makes a new one",
    )


def body_error(found: Found) -> Verdict:
    """The body error (32) at rest."""
    rows = found["convergence"]["rows"]
    body = mean(rows, "body_error_at_rest_m", controller=LOCAL)
    return Verdict(
        measured=f"{mm(body)}, without the local controller "
        f"{mm(mean(rows, 'body_error_at_rest_m', controller=ALONE))}",
        holds=AROUND[0] < body < AROUND[1],
        reason="the printed w_y alone is 1.6 mm on average, 1 mm on each axis, and no actuator "
        "undoes it",
    )


CONVERGENCE = (
    Claim(
        name="convergence_under_disturbances",
        section="III-C",
        printed="both controllers converge to the set point under disturbances",
        needs=("convergence",),
        judge=everything_converges,
    ),
    Claim(
        name="same_convergence_time",
        section="III-C",
        printed="they do so within approximately the same time",
        needs=("convergence",),
        judge=same_time,
    ),
    Claim(
        name="better_tracking",
        section="abstract",
        printed="the MPC outperforms the Jacobian-based controller in position tracking, "
        "particularly under disturbances",
        needs=("convergence",),
        judge=better_tracking,
    ),
    Claim(
        name="linear_approach",
        section="III-C",
        printed="the nominal error falls about linearly to zero, limited by the input",
        needs=("convergence",),
        judge=linear_approach,
    ),
    Claim(
        name="local_error_vanishes",
        section="III-C",
        printed="the error between real and nominal tip converges to zero",
        needs=("convergence",),
        judge=local_error_vanishes,
    ),
    Claim(
        name="body_error",
        section="III-C",
        printed="the body error has a steady state of around 1 mm",
        needs=("convergence",),
        judge=body_error,
    ),
)
