"""4: both sets with both schemes, the whole chain at 1 kHz (Figs. 10 to 13).

operator -> leader -> mapping -> waves -> 0.2 s -> desired point -> inverse kinematics -> PIDs ->
cables -> forward kinematics -> virtual force -> 0.2 s -> leader
"""

from dataclasses import replace
from typing import Any

import numpy as np

from sinuous.control.geometric_ik import IKStatus
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.qin2020.runs import BOUNDARY, inverse, scenario
from sinuous.papers.qin2020.sets.figures import draw
from sinuous.papers.qin2020.sets.signals import AXES, Signals
from sinuous.papers.workers import Workers
from sinuous.recording import Recording
from sinuous.scenario import Scenario
from sinuous.session import Result
from sinuous.session import run as run_session
from sinuous.session.by_hand import ENERGIES, FAULT
from sinuous.teleop.waves import ModifiedWaves

FREE, CONTACT = "set1", "set2"
SETS = (FREE, CONTACT)
SCHEMES = {"C1": ModifiedWaves.c1(), "C2": ModifiedWaves.c2()}
IMPEDANCE, PRESCRIBED = "impedance", "trajectory"
HANDS = (IMPEDANCE, PRESCRIBED)
"""Who holds the leader: a spring and a damper, or a source of motion whatever is felt."""

QUICK_TIME = 6.5  # of a run, enough for the first contact [s]
STRIDE = 20  # ticks between the points that are kept
DIGITS = 6  # of metres and newtons that are kept

Item = tuple[str, str, str, bool]


def run(workers: Workers, quick: bool) -> Data:
    """Every set with every scheme and hand."""
    items: list[Item] = [
        (name, scheme, hand, quick) for name in SETS for scheme in SCHEMES for hand in HANDS
    ]
    return {
        "boundary_m": BOUNDARY,
        "axes": AXES,
        "gains": {name: scheme.gain for name, scheme in SCHEMES.items()},
        "impedance_n_s_m": SCHEMES["C2"].impedance,
        "rows": workers.map("sets of the experiment", drive, items),
    }


def drive(item: Item) -> dict[str, Any]:
    """One run."""
    name, scheme, hand, quick = item
    found = chain(name, scheme, hand, seconds=QUICK_TIME if quick else None)
    return judged(item, found, run_session(found))


def judged(item: Item, found: Scenario, done: Result) -> dict[str, Any]:
    """The row of a run."""
    name, scheme, hand, _ = item
    assert found.teleop is not None
    recording, delay = done.recording, found.teleop.table.delay
    signals = Signals.of(recording, delay)
    touching = np.any(signals.beyond(BOUNDARY), axis=1)
    touching &= name == CONTACT  # there is no boundary in Set 1
    by_21 = SCHEMES[scheme].gain * SCHEMES[scheme].impedance * signals.V
    return {
        "set": name,
        "scheme": scheme,
        "hand": hand,
        "delay_s": delay,
        "duration_s": len(signals.X) * signals.dt,
        "real_time_factor": done.summary["real_time_factor"],
        "all": signals.errors(np.ones_like(touching)),
        "free": signals.errors(~touching),
        "contact": signals.errors(touching),
        "range_m": np.ptp(signals.X_s, axis=0).tolist(),
        "largest_free_step_n": signals.largest_step(~touching),
        "felt_beside_21_n": float(np.max(np.abs(signals.force_error - by_21))),
        "contacts": signals.contacts(BOUNDARY) if name == CONTACT else [],
        **_robot(recording),
        **_curves(signals, hand),
    }


def chain(
    name: str, scheme: str, hand: str, *changes: str, seconds: float | None = None
) -> Scenario:
    """The scenario of a set with some of its fields changed, cut after so many seconds."""
    own = (f"teleop.scheme={scheme.lower()}", f"teleop.operator.kind={hand}")
    found = scenario(name, *own, *changes)
    if seconds is None:
        return found
    (leg,) = found.path
    return replace(found, path=(replace(leg, moving=seconds, max_steps=1),))


def _robot(recording: Recording) -> dict[str, Any]:
    """What the robot and the parts between it and the hand did."""
    ik = inverse()
    status = ik.solve(recording.target).status
    slack = ik.robot.bend_slack(recording.configuration)
    energies = np.array([recording.signal(name) for name in ENERGIES])
    return {
        "chi_rad": ik.chi(float(recording.target[0, 1])),
        "joint_limit_share": float(np.mean(status == IKStatus.JOINT_LIMIT)),
        "unreachable_share": float(np.mean(status == IKStatus.UNREACHABLE)),
        "least_bend_slack_m": float(np.min(slack)),
        "slowed_share": float(np.mean(recording.step_fraction < 1.0)),
        "clipped_share": float(np.mean(recording.clipped > 0.0)),
        "out_of_plane_m": float(np.max(np.abs(recording.actual_tip - recording.target)[:, 1])),
        "faults": int(np.count_nonzero(recording.signal(FAULT))),
        "least_energy_j": dict(zip(ENERGIES, energies.min(axis=1).tolist(), strict=True)),
        "last_energy_j": dict(zip(ENERGIES, energies[:, -1].tolist(), strict=True)),
    }


def _curves(signals: Signals, hand: str) -> dict[str, Any]:
    """Curves for the figures, axis by axis, and the force's error to compare schemes by."""
    kept = {
        "leader_m": signals.X,
        "desired_m": signals.X_sd,
        "follower_m": signals.X_s,
        "virtual_n": signals.F_s,
        "felt_n": signals.F_m,
    }
    curves = {key: value[::STRIDE].round(DIGITS).T.tolist() for key, value in kept.items()}
    return {
        "period_s": STRIDE * signals.dt,
        "curves": curves if hand == IMPEDANCE else None,
        "force_error_n": signals.force_error[::STRIDE].T.tolist() if hand == PRESCRIBED else None,
    }


THE_SETS = Experiment(
    name="sets",
    title="Teleoperation, Set 1 and Set 2 with C1 and C2 (Figs. 10 to 13)",
    section="4",
    run=run,
    draw=draw,
)
