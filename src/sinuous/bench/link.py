"""`sinuous bench link`: every scheme on every connection, with and without passivity control."""

import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from multiprocessing import get_context

from sinuous.bench import link_arms, link_evolve, link_hand, link_models, link_pairs, link_worst
from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.link_drift import MINUTE
from sinuous.bench.link_figure import draw
from sinuous.bench.link_follower import HORIZON, LAG, WALL
from sinuous.bench.link_grid import (
    DELAYS,
    GRID,
    LEAST_JITTERED,
    MESHED,
    TROUBLED,
    Connection,
    Contact,
    Trouble,
)
from sinuous.bench.link_rig import IMPEDANCE
from sinuous.bench.link_summary import DT, FLOOR, LARGEST
from sinuous.bench.link_tables import TABLES
from sinuous.bench.link_task import Found, Task, work
from sinuous.bench.machine import machine, versions
from sinuous.bench.result import Result, Row

SIMPLE = (Contact.FREE, Contact.BOX)
TRIES = 40  # of evolution
EVOLVED = (
    Connection(delay=0.05, jitter=0.5, loss=0.3),
    Connection(delay=0.2, jitter=0.2, loss=0.1, trouble=Trouble.REORDERING),
    Connection(delay=0.2, jitter=0.2, loss=0.1, trouble=Trouble.OUTAGES),
)
LOSSY = tuple(Connection(delay=delay, jitter=0.0, loss=0.1) for delay in DELAYS)
QUICK = Connection(delay=0.05, jitter=0.5, loss=0.3)
QUICK_DURATION, QUICK_DRIFT, QUICK_TRIES = 1.4, 1.0, 1

NOTES = (
    "All signals on the wave side. Tracking and force errors: root mean square of X_sd - X and of "
    "F_m - F_s, the latter of each by one nominal delay before; drift: |X_sd - X| at the end of a "
    "run, at rest; peak: the largest |F_m|.",
    '"active": cells whose ledger fell below -F_max v_max dt = '
    f'-{LARGEST:g} N x {link_hand.FASTEST:g} m/s x 1 ms = {1e3 * FLOOR:g} mJ. "unbounded": what '
    "left 1 m, or moved more and more, from quarter to quarter of 40 s, with the hand at rest; "
    "errors are of the cells that are bounded.",
    "Control: passivity control at both ports, correction of drift, force from afar capped at "
    f"{LARGEST:g} N. Without: the newest wave is repeated until a newer one comes.",
    "Worst case: the motion with the least eigenvalue of the channel's energy, and the passive arm "
    "that gets most energy; a cell shows the worse of both in every number.",
)


def run(quick: bool, observe: Observe) -> Result:
    """Work through all connections, each in one of as many processes as there are cores."""
    tasks = list(_quick() if quick else _tasks())
    found = Found()
    for number, (task, rows) in enumerate(_map(tasks, 1 if quick else os.cpu_count() or 1)):
        observe(task.name, number, len(tasks))
        found.add(rows)
    observe("done", len(tasks), len(tasks))
    return Result(
        what="link",
        tables=tuple(table(found) for table in TABLES),
        about={
            **asdict(found),
            "settings": _settings(),
            "versions": versions(),
            "machine": machine(),
        },
        notes=NOTES,
    )


def _tasks() -> Iterator[Task]:
    """The longest first, so that no process is left with them in the end."""
    every = GRID + TROUBLED
    for connection in LOSSY:
        yield Task(connection=connection, seed=every.index(connection), drift=MINUTE)
    for connection in EVOLVED:
        yield Task(connection=connection, seed=every.index(connection), tries=TRIES)
    for seed, connection in enumerate(every):
        yield Task(
            connection=connection, seed=seed, contacts=SIMPLE, pairs=True, cost=connection.is_clean
        )
    for connection in MESHED:
        yield Task(connection=connection, seed=every.index(connection), contacts=(Contact.MESH,))


def _quick() -> Iterator[Task]:
    yield Task(
        connection=QUICK,
        seed=0,
        contacts=(Contact.BOX,),
        duration=QUICK_DURATION,
        pairs=True,
        drift=QUICK_DRIFT,
        tries=QUICK_TRIES,
    )


def _map(tasks: Sequence[Task], processes: int) -> Iterator[tuple[Task, Found]]:
    """Tasks in their order with what was found; it does not depend on how many processes."""
    if processes == 1:
        yield from ((task, work(task)) for task in tasks)
        return
    # Spawned, because a fork copies locks that other threads hold.
    with ProcessPoolExecutor(processes, get_context("spawn")) as executor:
        yield from zip(tasks, executor.map(work, tasks), strict=True)


def _settings() -> Row:
    """What a reader needs to do the same."""
    return {
        "tick_s": DT,
        "impedance_n_s_m": IMPEDANCE,
        "f_max_n": LARGEST,
        "v_max_m_s": link_hand.FASTEST,
        "hand": [leg._asdict() for leg in link_hand.LEGS],
        "arms": {name.value: arm._asdict() for name, arm in link_hand.ARMS.items()},
        "device_mass_kg": 0.1,
        "follower": f"first-order lag of {LAG:g} s; free, or with a virtual wall at {WALL:g} m; "
        f"mesh: the stress scene's robot, horizon {HORIZON}, 30 Hz",
        "jitter": "uniform, a share of the delay, of 20 ms if that is more; packets keep order",
        "jitter_at_least_of_s": LEAST_JITTERED,
        "burst_packets": link_models.BURST,
        "reordering": "order is not kept, and 10 % of packets arrive twice",
        "outages_s": link_models.OUTAGES,
        "delay_steps_s": link_models.STEPS,
        "delay_step_s": link_models.HIGHER,
        "search": {
            "motion": "least eigenvalue over cubic splines, without control; knots of "
            f"{link_worst.KNOT:g} s, at most {link_worst.SPACE:g} m to either side",
            "pairs": f"the same of motion and force, knots of {link_pairs.KNOT:g} s",
            "arms": len(link_arms.STIFFNESS) * len(link_arms.DAMPING),
            "evolution": f"(1 + 1), {link_evolve.PAIRS} amounts, {TRIES} tries",
        },
    }


LINK = Benchmark(run=run, draw=draw)
