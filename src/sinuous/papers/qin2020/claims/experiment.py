"""4: the two sets."""

import numpy as np

from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.experiment import Data
from sinuous.papers.qin2020.claims.words import mm, the
from sinuous.papers.qin2020.sets.experiment import CONTACT, FREE, IMPEDANCE, PRESCRIBED

SMALL = 0.1  # of the range of motion: a small error
ALIKE = 1.1  # errors that differ by less approach each other
BETTER = 0.75  # of an error: obviously better
HALF = 1e-9  # how exactly half is half
SUDDEN = 5.0  # times the largest change in a tick of free motion: a step
FELT = 0.1  # a force that a hand feels [N]
REST = 0.005  # by which a force may be off that is held [N]


def _row(found: Found, name: str, scheme: str, hand: str = IMPEDANCE) -> Data:
    return the(found["sets"]["rows"], set=name, scheme=scheme, hand=hand)


def follows_closely(found: Found) -> Verdict:
    """Set 1: the follower against its desired place."""
    rows = {scheme: _row(found, FREE, scheme) for scheme in ("C1", "C2")}
    told = "; ".join(
        f"{scheme} rms {mm(row['free']['tracking_m'])}, largest "
        f"{mm(row['free']['tracking_largest_m'])}"
        for scheme, row in rows.items()
    )
    span = min(min(row["range_m"]) for row in rows.values())
    most = max(row["free"]["tracking_largest_m"] for row in rows.values())
    return Verdict(
        measured=f"{told}; the tip goes to and fro over {mm(span, 0)}",
        holds=most < SMALL * span,
        reason="the printed PIDs have no feed-forward: the tip lags by its speed by K_P",
    )


def tracking_alike(found: Found) -> Verdict:
    """C2's tracking error by C1's."""
    ratios, leaders = list[float](), list[float]()
    for name in (FREE, CONTACT):
        one, two = (_row(found, name, scheme)["all"] for scheme in ("C1", "C2"))
        ratios.append(two["tracking_m"] / one["tracking_m"])
        leaders.append(two["following_m"] / one["following_m"])
    return Verdict(
        measured="follower against desired place, C2 by C1: "
        + ", ".join(f"{value:.2f}" for value in ratios)
        + " (Set 1, Set 2)",
        holds=max(ratios) < ALIKE,
        reason="against the leader one delay before it is "
        + ", ".join(f"{value:.2f}" for value in leaders)
        + ": the low-pass costs another 1/lambda = 50 ms and 5 mm for every newton",
    )


def better_force(found: Found) -> Verdict:
    """Free motion: the error of the force with C2 by that with C1."""
    return _better(found, FREE, "free")


def better_force_in_contact(found: Found) -> Verdict:
    """Contact: the same."""
    return _better(found, CONTACT, "contact")


def _better(found: Found, name: str, where: str) -> Verdict:
    one, two = (_row(found, name, scheme)[where] for scheme in ("C1", "C2"))
    same = [_row(found, name, scheme, PRESCRIBED) for scheme in ("C1", "C2")]
    ratio = two["force_n"] / one["force_n"]
    half = _half(*same)
    return Verdict(
        measured=f"rms of F_m(t) - F_s(t - T): C1 {one['force_n']:.3f} N, C2 {two['force_n']:.3f} "
        f"N, ratio {ratio:.3f}; F_s itself {two['virtual_n']:.2f} N. On the same motion the ratio "
        f"is 0.5 at every tick, within {half:.0e} N",
        holds=ratio < BETTER and half < HALF,
        reason="by (21) the error is K b times the leader's speed, and K is halved; C1 as we "
        "read [36]: K = 1, no low-pass",
    )


def _half(one: Data, two: Data) -> float:
    """How far the error of the second scheme is from half of the first one's [N]."""
    first, second = (np.array(row["force_error_n"]) for row in (one, two))
    return float(np.max(np.abs(second - 0.5 * first)))


def boundary_is_felt(found: Found) -> Verdict:
    """Set 2: a step and a force that stays, at every side, at the leader one delay later."""
    rows = [_row(found, CONTACT, scheme) for scheme in ("C1", "C2")]
    contacts = [(row, contact) for row in rows for contact in row["contacts"]]
    sides = [
        {(one["axis"], one["side"]) for one in row["contacts"]} for row in rows
    ]  # fmt: skip
    steps = [contact["step_n"] / row["largest_free_step_n"] for row, contact in contacts]
    held = [contact["rest_felt_n"] for _, contact in contacts]
    apart = [abs(one["rest_felt_n"] - one["rest_virtual_n"]) for _, one in contacts]
    beside = max(row["felt_beside_21_n"] for row in rows)
    if not contacts:
        return Verdict(measured="no contact", holds=False)
    return Verdict(
        measured=f"{min(map(len, sides))} of 4 sides with each scheme; in the tick of contact F_s "
        f"steps by {min(one['step_n'] for _, one in contacts) * 1e3:.0f} mN or more, "
        f"{min(steps):.0f} times any change in a tick of free motion; held, {min(held):.2f} N or "
        f"more are felt, {max(apart) * 1e3:.1f} mN beside F_s(t - T)",
        holds=min(map(len, sides)) == 4
        and min(steps) > SUDDEN
        and min(held) > FELT
        and max(apart) < REST,
        reason=f"F_m less K b v_m is F_s of exactly one delay before, within {beside:.0e} N; the "
        "step is c_b v, small beside the force of the tracking error on the way",
    )


def real_time_chain(found: Found) -> Verdict:
    """How much faster than real time the whole chain runs here."""
    rows = found["sets"]["rows"]
    slowest = min(row["real_time_factor"] for row in rows)
    fastest = max(row["real_time_factor"] for row in rows)
    return Verdict(
        measured=f"the whole chain at 1 kHz runs {slowest:.1f} to {fastest:.1f} times faster than "
        "real time, both ends and the robot in one process",
        holds=slowest > 1.0,
        reason="other machine; with other work on the same cores",
    )


def prototype(found: Found) -> Verdict:
    """Not to be had in simulation."""
    return Verdict(
        measured="",
        holds=None,
        reason="needs the arm and the Touch: both are simulated here, and how the stylus moved "
        "is not printed",
    )


def perception(found: Found) -> Verdict:
    """Not to be had without people."""
    return Verdict(
        measured="",
        holds=None,
        reason="needs people: our operators are a spring with a damper, or go where they will",
    )


EXPERIMENT = (
    Claim(
        name="follows_closely",
        section="4.3, Figs. 10, 11",
        printed="the follower tracks the desired trajectory with a small error",
        needs=("sets",),
        judge=follows_closely,
    ),
    Claim(
        name="tracking_alike",
        section="4.3, Figs. 10, 11",
        printed="the tracking of C2 approaches that of C1, as b is the same",
        needs=("sets",),
        judge=tracking_alike,
    ),
    Claim(
        name="better_force",
        section="4.3, Figs. 10, 11",
        printed="the force feedback of C2 is obviously better than that of C1 in free motion",
        needs=("sets",),
        judge=better_force,
    ),
    Claim(
        name="better_force_in_contact",
        section="4.3, Figs. 12, 13",
        printed="in contact too C2's force feedback is more accurate",
        needs=("sets",),
        judge=better_force_in_contact,
    ),
    Claim(
        name="boundary_is_felt",
        section="4.3, Figs. 12, 13",
        printed="reaching the boundary at +-18 cm makes a sudden change of force, which the "
        "operator perceives",
        needs=("sets",),
        judge=boundary_is_felt,
    ),
    Claim(
        name="real_time_chain",
        section="4.1",
        printed="haptics and cable control run at 1 kHz",
        needs=("sets",),
        judge=real_time_chain,
    ),
    Claim(
        name="prototype",
        section="4, abstract",
        printed="practical experiments verify the model and the scheme",
        needs=(),
        judge=prototype,
    ),
    Claim(
        name="perception",
        section="abstract, 4.3",
        printed="the virtual force improves the operators' assistance and perception",
        needs=(),
        judge=perception,
    ),
)
