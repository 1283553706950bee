"""`sinuous bench link`."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.bench import link_arms, link_cost, link_hand, link_task
from sinuous.bench.link_arms import worst_arm
from sinuous.bench.link_cost import cost
from sinuous.bench.link_drift import drift
from sinuous.bench.link_drive import Trace, drive, is_unbounded, judge
from sinuous.bench.link_evolve import evolve
from sinuous.bench.link_follower import place
from sinuous.bench.link_grid import (
    GRID,
    MESHED,
    TROUBLED,
    Connection,
    Contact,
    Hand,
    SchemeName,
    Trouble,
)
from sinuous.bench.link_hand import ARMS, FASTEST, LEGS, RELAXED, SETTLED, STIFF, arm, puppet
from sinuous.bench.link_models import OUTAGES, STEPS, model
from sinuous.bench.link_pairs import attempt, pairs
from sinuous.bench.link_rig import connect, scheme
from sinuous.bench.link_summary import FLOOR, failures, number, worst_of
from sinuous.bench.link_task import Task, work
from sinuous.bench.link_worst import search
from sinuous.teleop.ledger import Energies
from sinuous.teleop.link import ConstantDelay, Packet
from sinuous.teleop.worst_case import Schedule

DT = 1e-3
KEYS = {
    "scheme", "passivity_control", "delay_s", "jitter_s", "loss", "operator", "contact",
    "ledger_min_j", "unbounded", "drift_m", "tracking_rms_m", "force_rms_n", "peak_force_n",
}  # fmt: skip
BAD = Connection(delay=0.05, jitter=0.5, loss=0.3)
BROKEN = Connection(delay=0.05, jitter=0.2, loss=0.1, trouble=Trouble.OUTAGES)
CLEAN = Connection(delay=0.05, jitter=0.0, loss=0.0)
ROUNDING = 1e-12  # [J]
FORECAST = 1e-5  # relative: the ports themselves, run twice
SAME = 1e-6  # relative: a run and its copy that adds up in another order


def test_every_cell_has_its_row(bench: Callable[[str], dict[str, Any]]) -> None:
    found = bench("link")
    assert found["figures"] == ["link.png"]
    rows = found["rows"]
    assert all(row.keys() >= KEYS for row in rows)
    cells = {(row["scheme"], row["passivity_control"], row["operator"]) for row in rows}
    assert cells == {(s, c, h) for s in SchemeName for c in (False, True) for h in Hand}
    controlled = [row for row in rows if row["passivity_control"]]
    assert all(row["ledger_min_j"] >= FLOOR and not row["unbounded"] for row in controlled)
    worst = {row["scheme"]: row for row in found["pairs"] if not row["passivity_control"]}
    assert all(row["ledger_min_j"] < 0.0 for row in worst.values())
    assert found["settings"]["v_max_m_s"] == FASTEST


def test_the_grid_is_the_whole_grid() -> None:
    assert len({(c.delay, c.jitter, c.loss) for c in GRID}) == 4 * 3 * 3
    assert {c.trouble for c in TROUBLED} == set(Trouble) - {Trouble.NONE}
    assert set(MESHED) <= set(GRID) | set(TROUBLED)


def test_the_path_goes_where_it_should_and_no_faster_than_a_hand() -> None:
    for leg in LEGS:
        assert link_hand.place(leg.end) == pytest.approx(leg.to)
    x = np.array([link_hand.place(t) for t in np.arange(0.0, SETTLED, DT)])
    assert np.abs(np.diff(x)).max() < FASTEST * DT
    assert x[-1] == 0.0


def ages(connection: Connection, ticks: int = 6000) -> Array:
    """Age of the newest packet by tick [s]."""
    link = model(connection, 1, DT)
    return DT * (np.arange(ticks, dtype=np.float64) - Schedule.of(link, link, ticks).forward)


def test_connections_do_what_their_names_say() -> None:
    assert model(CLEAN, 0, DT) == ConstantDelay(delay=0.05, dt=DT)
    steady = ages(BAD)[1000:]
    assert 0.025 <= steady.min() < steady.max() < 0.3
    away = ages(BROKEN)
    assert away[round(OUTAGES[0][1] / DT)] == pytest.approx(2.0 + 0.05, abs=0.1)
    steps = ages(Connection(delay=0.05, jitter=0.0, loss=0.0, trouble=Trouble.STEPS))
    up, down, _ = (round(t / DT) for t in STEPS)
    assert steps[up - 1] == pytest.approx(0.05)
    assert steps[up + 200] == pytest.approx(0.15)
    assert steps[down + 200] == pytest.approx(0.05)


@pytest.mark.parametrize("trouble", [Trouble.NONE, Trouble.REORDERING])
def test_order_is_kept_unless_it_is_not(trouble: Trouble) -> None:
    connection = Connection(delay=0.05, jitter=0.2, loss=0.1, trouble=trouble)
    link, packets = model(connection, 1, DT).open(0), list[int]()
    for k in range(3000):
        packets += [p.number for p in link.step(Packet(np.zeros(1), np.zeros(1), number=k))]
    arrived = len(set(packets)) / 3000
    assert arrived == pytest.approx(0.9, abs=0.06)  # bursts of ten: 300 of them
    if trouble is Trouble.NONE:
        assert packets == sorted(set(packets))
    else:
        assert packets != sorted(packets)
        assert len(packets) > 1.05 * len(set(packets))


def trace(x: Array, *, complete: bool = True) -> Trace:
    """One where both ends are at x (K,), and nothing else."""
    column = x[:, None]
    zero = np.zeros_like(column)
    none = Energies(0.0, 0.0, 0.0)
    return Trace(column, zero, zero, column, zero, zero, none, zero[:, 0], complete)


def test_what_grows_at_rest_is_unbounded() -> None:
    t = np.arange(0.0, 9.0, DT)
    swing = 0.01 * np.sin(20.0 * t)
    growing, dying = swing * np.exp(0.3 * t), swing * np.exp(-0.3 * t)
    assert is_unbounded(trace(growing), DT)
    assert not is_unbounded(trace(dying), DT)
    assert not is_unbounded(trace(swing), DT)
    assert not is_unbounded(trace(1e-3 * growing), DT)  # less than a tremble
    assert is_unbounded(trace(0.0 * t, complete=False), DT)


def test_what_still_moves_is_watched_until_it_rests() -> None:
    where, late = place(Contact.FREE, DT), ConstantDelay(delay=0.7)
    slow, fast = (
        connect(where, scheme(name, DT), arm(RELAXED, 1), late, control=True, correction=True)
        for name in (SchemeName.STANDARD, SchemeName.C2)
    )
    watched, rested = (drive(both, place(Contact.FREE, DT).follower, where.tip_w, 9.0, longest=40.0)
                       for both in (slow, fast))  # fmt: skip
    assert 15.0 < DT * len(watched.X) < 40.0
    assert 9.0 <= DT * len(rested.X) < 15.0
    assert not is_unbounded(watched, DT)
    assert watched.complete


def test_errors_are_by_one_delay_before() -> None:
    t = np.arange(0.0, 3.0, DT)[:, None]
    late, force = np.sin(t - 0.05), np.cos(t)
    seen = Trace(
        X=np.sin(t), V=t, F_m=np.cos(t - 0.05), X_sd=late + 0.01, V_sd=t, F_s=force,
        least=Energies(-1.0, -2.0, -3.0), energy=t[:, 0], complete=True,
    )  # fmt: skip
    row = judge(seen, DT, 0.05, 3.0)
    assert row["tracking_rms_m"] == pytest.approx(0.01)
    assert row["force_rms_n"] == pytest.approx(0.0, abs=1e-12)
    assert row["peak_force_n"] == pytest.approx(1.0, abs=1e-3)
    assert (row["ledger_min_j"], row["operator_min_j"], row["follower_min_j"]) == (-1, -2, -3)


def test_the_worst_of_each_is_reported() -> None:
    a = {"ledger_min_j": -1.0, "drift_m": 1.0, "tracking_rms_m": 5.0, "force_rms_n": 0.0}
    b = {"ledger_min_j": -3.0, "drift_m": 2.0, "tracking_rms_m": 4.0, "force_rms_n": 1.0}
    more = {"peak_force_n": 1.0, "operator_min_j": 0.0, "follower_min_j": 0.0}
    found = worst_of([{**a, **more, "unbounded": True}, {**b, **more, "unbounded": False}])
    assert found["ledger_min_j"] == -3.0
    assert (found["drift_m"], found["tracking_rms_m"], found["force_rms_n"]) == (2.0, 5.0, 1.0)
    assert found["unbounded"]


def test_failures_are_counted_by_kind_of_connection() -> None:
    about = {"scheme": "C1", "operator": "stiff", "passivity_control": False, "unbounded": False}
    clean = {**about, "jitter": 0.0, "loss": 0.0, "trouble": "-", "ledger_min_j": 0.0}
    lossy = {**clean, "loss": 0.1, "ledger_min_j": 2.0 * FLOOR}
    away = {**lossy, "jitter": 0.2, "trouble": "outages", "unbounded": True}
    fine = {**lossy, "ledger_min_j": 0.5 * FLOOR}
    controlled = {**lossy, "passivity_control": True}
    table = failures([clean, lossy, fine, away, controlled])
    row = next(row for row in table.rows if row["scheme"] == "C1")
    assert row["clean"] == "0+0/1"
    assert row["loss"] == "1+0/2"
    assert row["outages"] == "1+1/1"
    assert row["both"] == "-"


@pytest.mark.parametrize("name", SchemeName)
@pytest.mark.parametrize("connection", [BAD, BROKEN])
def test_both_ends_together_take_what_the_eigenvalue_says_and_nothing_under_control(
    name: SchemeName, connection: Connection
) -> None:
    link, moving = model(connection, 3, DT), 1.5
    worst = pairs(name, link, DT, 1, moving)
    x, force, size = worst.mix(np.ones(1), DT)
    forecast = float(worst.energy[0]) * size**2
    assert forecast < 0.0
    without, with_ = (
        attempt(name, link, x, force, DT, control=control) for control in (False, True)
    )
    assert without.energy[round(moving / DT) - 1] == pytest.approx(forecast, rel=FORECAST)
    assert with_.least.channel >= -scheme(name, DT).loan - ROUNDING


def test_evolution_finds_worse_and_the_same_again() -> None:
    def found() -> dict[str, Any]:
        rng, link = np.random.default_rng(0), model(BAD, 3, DT)
        return dict(evolve(SchemeName.C1, BAD, link, DT, tries=6, rng=rng, moving=1.0))

    row = found()
    assert 0.0 <= row["kept_least"] < row["kept_first"]
    assert row["ledger_min_j"] >= -ROUNDING
    assert found() == row


def test_the_worst_arm_is_as_bad_when_it_is_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(link_arms, "STIFFNESS", np.geomspace(10.0, 1000.0, 5))
    monkeypatch.setattr(link_arms, "DAMPING", np.array([0.0, 5.0]))
    own, link = scheme(SchemeName.STANDARD, DT), model(BROKEN, 3, DT)
    found = worst_arm(own, Schedule.of(link, link, 3000), Contact.BOX)
    assert found.tried == 10
    assert found.energy < 0.0
    where = place(Contact.BOX, DT)
    both = connect(where, own, arm(found.arm, 1), link, control=False, correction=False)
    alone = drive(both, where.follower, where.tip_w, 3.0)
    assert alone.least.channel == pytest.approx(found.energy, rel=SAME)


@pytest.mark.parametrize("contact", Contact)
def test_the_worst_motion_takes_more_than_an_arm(contact: Contact) -> None:
    own, link = scheme(SchemeName.STANDARD, DT), model(BAD, 3, DT)
    worst = search(own, Schedule.of(link, link, 3000), contact)
    assert worst.power < 0.0
    assert np.abs(np.diff(worst.x)).max() < 1.001 * FASTEST * DT
    axes = 3 if contact is Contact.MESH else 1
    least = list[float]()
    for operator in (puppet(worst.x, DT, axes), arm(STIFF, axes)):
        where = place(contact, DT)
        both = connect(where, own, operator, link, control=False, correction=False)
        least.append(drive(both, where.follower, where.tip_w, 3.0).least.channel)
    assert least[0] < 10.0 * least[1] < 0.0


def test_a_minute_leaves_no_drift_where_it_is_corrected() -> None:
    lossy = Connection(delay=0.05, jitter=0.0, loss=0.1)
    rows = drift(SchemeName.C2, lossy, model(lossy, 2, DT), DT, 16.0)
    kinds = {row["kind"]: number(row, "drift_m") for row in rows}
    assert kinds["control, correction"] < 1e-5 < kinds["none"]


@pytest.mark.parametrize("name", [SchemeName.STANDARD, SchemeName.C1, SchemeName.C2])
def test_control_changes_nothing_on_a_clean_connection(
    name: SchemeName, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(link_cost, "DURATION", 2.0)
    monkeypatch.setattr(link_cost, "ARMS", {Hand.STIFF: ARMS[Hand.STIFF]})
    for row in cost(name, CLEAN, model(CLEAN, 0, DT), DT):
        assert row["tracking_rms_m_change"] == row["force_rms_n_change"] == 0.0


def test_work_is_the_same_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(link_task, "SchemeName", [SchemeName.C2])
    task = Task(connection=BAD, seed=3, contacts=(Contact.MESH,), duration=1.0)
    first, again = work(task), work(task)
    assert first.rows == again.rows
    assert first.worst == again.worst
    assert "30%" in task.name
