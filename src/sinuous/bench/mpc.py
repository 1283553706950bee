"""`sinuous bench mpc`: one step of the controller beside others, on the stress scene."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.judge import judge
from sinuous.bench.loop import Drive, drive
from sinuous.bench.machine import machine, require, versions
from sinuous.bench.mpc_figure import draw
from sinuous.bench.ours import Ours
from sinuous.bench.result import Column, Result, Row, Table
from sinuous.bench.scene import STEPS, Scene, describe, stress_scene

OURS = "sinuous"
OURS_DISKS = "sinuous, disks only"

HORIZONS, DISKS = (2, 5, 10, 20), (30, 9)
QUICK_HORIZONS, QUICK_DISKS, QUICK_STEPS = (2,), (9,), 60

COLUMNS = (
    Column(key="controller", title="controller"),
    Column(key="horizon", title="N"),
    Column(key="disks", title="disks"),
    Column(key="median_ms", title="median", form=".3f"),
    Column(key="p99_ms", title="p99", form=".3f"),
    Column(key="max_ms", title="max", form=".2f"),
    Column(key="min_margin_mm", title="margin", form="+.2f"),
    Column(key="violations", title="broken"),
    Column(key="failures", title="failed"),
    Column(key="body_margin_mm", title="body", form="+.2f"),
    Column(key="tip_error_median_mm", title="tip", form=".3f"),
)
RATIO_COLUMNS = (
    Column(key="peer", title="peer"),
    Column(key="horizon", title="N"),
    Column(key="disks", title="disks"),
    Column(key="median", title="median", form=".1f"),
    Column(key="p99", title="p99", form=".1f"),
)

PROMISES = {
    OURS: "the whole body keeps 1 mm: 4 mm around its centre line, guarded every 3 mm, judged "
    "every 0.25 mm at the end of each step and on the way",
    OURS_DISKS: "disk centres keep 5 mm, with no allowance for what lies between, like the peers",
}
PEER_PROMISE = "disk centres keep 5 mm at the end of each step, formulation (18)"

NOTES = (
    "Processor time in ms, one thread; lengths in mm. Judged on the exact mesh, beyond what is "
    'required: "margin" is the least of what the controller guards (sinuous: the whole body, '
    'between steps too; others: disk centres), "broken" the steps that have less than none, '
    '"body" the least of the whole body.',
)

About = Mapping[str, Any]
Found = Iterator[tuple[str, Row, About]]


def run(quick: bool, observe: Observe) -> Result:
    """Measure all of it; the first run on a machine also compiles the peers' programs."""
    require("casadi", "mpc")
    horizons, disks = (QUICK_HORIZONS, QUICK_DISKS) if quick else (HORIZONS, DISKS)
    settings = [(count, horizon) for count in disks for horizon in horizons]
    steps = QUICK_STEPS if quick else STEPS
    rows, abouts = list[Row](), dict[str, list[About]]()
    for number, (count, horizon) in enumerate(settings):
        scene, setting = stress_scene(count, steps), {"horizon": horizon, "disks": count}

        def tell(what: str, done: int = number, N: int = horizon, D: int = count) -> None:
            observe(f"N = {N}, {D} disks: {what}", done, len(settings))

        for name, row, about in _measure(scene, horizon, tell):
            rows.append({"controller": name, **setting, **row})
            abouts.setdefault(name, []).append({**setting, **about})
    observe("done", len(settings), len(settings))
    return _result(rows, abouts, steps)


def _measure(scene: Scene, horizon: int, tell: Callable[[str], None]) -> Found:
    """Ours before and after all others, so that a busy machine is as unfair to us as to them."""
    from sinuous.bench.peers import all_peers  # needs CasADi

    ours = {
        OURS: Ours.of(scene, horizon, disks_only=False),
        OURS_DISKS: Ours.of(scene, horizon, disks_only=True),
    }
    before = dict[str, Drive]()
    for name, controller in ours.items():
        tell(name)
        before[name] = drive(controller, scene)
    tell("compiling the peers' programs")
    peers = all_peers(scene, horizon)
    found = list[tuple[str, Row, About]]()
    for peer in peers:
        tell(peer.name)
        if peer.controller is None:
            found.append((peer.name, {"status": peer.missing}, {"missing": peer.missing}))
            continue
        with peer.silence():
            done = drive(peer.controller, scene)
        about = {"settings": peer.settings, **_statuses(done), "log": peer.log}
        found.append((peer.name, judge(scene, done, whole_body=False), about))
    for name, controller in ours.items():
        tell(f"{name} again")
        both = before[name].followed_by(drive(controller, scene))
        yield name, judge(scene, both, whole_body=name == OURS), _statuses(both)
    yield from found


def _statuses(found: Drive) -> About:
    counts = Counter(outcome.status for outcome in found.outcomes)
    reasons = Counter(outcome.failure for outcome in found.outcomes if outcome.failure)
    return {"statuses": dict(counts), "failures": dict(reasons)}


def _result(rows: list[Row], abouts: dict[str, list[About]], steps: int) -> Result:
    from sinuous.bench.peers import TUNING  # needs CasADi

    participants = {
        name: {
            "promise": PROMISES.get(name, PEER_PROMISE),
            "tuning": TUNING.get(name, ()),
            "runs": runs,
        }
        for name, runs in abouts.items()
    }
    missing = {f"{row['controller']}: {row['status']}" for row in rows if "status" in row}
    return Result(
        what="mpc",
        tables=(
            Table(name="rows", title=f"{steps} steps each", columns=COLUMNS, rows=rows),
            Table(
                name="ratios",
                title="time of a peer by that of sinuous, whole body guarded",
                columns=RATIO_COLUMNS,
                rows=ratios(rows),
            ),
        ),
        about={
            "peers": {name: about for name, about in participants.items() if name not in PROMISES},
            "ours": {name: about for name, about in participants.items() if name in PROMISES},
            "scene": describe(steps),
            "settings": {
                "warm_up_steps_that_do_not_count": 3,
                "garbage_collector": "off while measuring",
                "order": "ours, peers, ours again; our times are pooled",
                "python_callbacks_in_peers": 0,
            },
            "versions": versions(),
            "machine": machine(),
        },
        notes=(*NOTES, *sorted(missing)),
    )


def ratios(rows: list[Row]) -> list[Row]:
    """Time of each peer by ours with the whole body guarded, CPU, in the same setting."""
    ours = {(r["horizon"], r["disks"]): r for r in rows if r["controller"] == OURS}
    found = list[Row]()
    for row in rows:
        base = ours[row["horizon"], row["disks"]]
        if row["controller"] in PROMISES or "median_ms" not in row:
            continue
        found.append(
            {
                "horizon": row["horizon"],
                "disks": row["disks"],
                "peer": row["controller"],
                **{
                    key: _number(row[f"{key}_ms"]) / _number(base[f"{key}_ms"])
                    for key in ("median", "p99")
                },
            }
        )
    return found


def _number(value: object) -> float:
    assert isinstance(value, float)
    return value


MPC = Benchmark(run=run, draw=draw)
