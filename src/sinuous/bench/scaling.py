"""`sinuous bench scaling`: the cost of a step against robot, horizon and mesh."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from sinuous.bench import scene
from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.judge import judge
from sinuous.bench.loading import load
from sinuous.bench.loop import Drive, drive
from sinuous.bench.machine import machine, versions
from sinuous.bench.ours import Ours
from sinuous.bench.result import Column, Result, Row, Table
from sinuous.bench.scaling_figure import draw
from sinuous.bench.scene import STEPS, Scene, describe
from sinuous.bench.variants import Variant, scene_of, tube
from sinuous.geometry.safe_zone import SafeZone

DISKS, QUICK_DISKS = (9, 15, 30, 45, 60, 90), (9, 30)
SPACINGS, QUICK_SPACINGS = (0.012, 0.006, 0.003, 0.0015, 0.00075), (0.012,)  # [m]
SEGMENTS, QUICK_SEGMENTS = (1, 2, 3, 4, 5, 6), (1, 3)
HORIZONS, QUICK_HORIZONS = (1, 2, 3, 5, 8, 10, 15, 20), (2, 5)
VERTICES, QUICK_VERTICES = (350, 1_000, 3_000, 10_000, 30_000, 100_000), (350, 1_000)
MESH_HORIZONS = (2, 5)
QUICK_STEPS = 20

NOTES = (
    "Processor time of a step in ms, one thread, whole body guarded; lengths in mm, judged on the "
    'exact mesh, beyond what is required. "points": guarded points of the body.',
)


@dataclass(frozen=True, kw_only=True)
class Case:
    """One row: what is varied, and what of it the row says besides."""

    scene: Scene
    horizon: int
    about: Row


def run(quick: bool, observe: Observe) -> Result:
    """Vary one thing at a time."""
    steps = QUICK_STEPS if quick else STEPS
    zone = scene.tube()

    def of(variants: Sequence[Variant]) -> list[Case]:
        return [_case(variant, zone, steps) for variant in variants]

    with TemporaryDirectory() as folder:
        axes: dict[str, Callable[[], list[Case]]] = {
            "disks": lambda: of([Variant(disks=d) for d in (QUICK_DISKS if quick else DISKS)]),
            "points": lambda: of(
                [Variant(spacing=s) for s in (QUICK_SPACINGS if quick else SPACINGS)]
            ),
            "segments": lambda: of(
                [Variant(segments=m) for m in (QUICK_SEGMENTS if quick else SEGMENTS)]
            ),
            "horizon": lambda: of(
                [Variant(horizon=N) for N in (QUICK_HORIZONS if quick else HORIZONS)]
            ),
            "mesh": lambda: _meshes(QUICK_VERTICES if quick else VERTICES, Path(folder), steps),
        }
        rows = dict[str, list[Row]]()
        for number, (name, cases) in enumerate(axes.items()):
            observe(name, number, len(axes))
            rows[name] = measure(cases())
        observe("done", len(axes), len(axes))
    rows["loading"] = _loading(rows["mesh"])
    return _result(rows, steps)


def _case(variant: Variant, zone: SafeZone, steps: int) -> Case:
    made = scene_of(variant, zone, steps)
    about = {
        "horizon": variant.horizon,
        "disks": sum(segment.disks for segment in made.robot.segments),
        "segments": variant.segments,
        "spacing_mm": made.robot.spacing * 1e3,
        "points": len(made.robot.radii),
    }
    return Case(scene=made, horizon=variant.horizon, about=about)


def _meshes(vertices: Sequence[int], folder: Path, steps: int) -> list[Case]:
    """One zone per mesh, read from a file as a user's would be."""
    cases = list[Case]()
    for count in vertices:
        loaded = load(tube(count), folder / f"tube_{count}.stl")
        for horizon in MESH_HORIZONS:
            case = _case(Variant(horizon=horizon), loaded.zone, steps)
            cases.append(
                Case(scene=case.scene, horizon=horizon, about={**case.about, **loaded.row})
            )
    return cases


def _loading(mesh: Sequence[Row]) -> list[Row]:
    """One row per mesh."""
    once = {row["vertices"]: row for row in mesh}.values()
    return [{column.key: row[column.key] for column in LOADING} for row in once]


def measure(cases: Sequence[Case]) -> list[Row]:
    """Drive every case there and back again, so that a busy minute hits none of them alone."""
    ours = [Ours.of(case.scene, case.horizon, disks_only=False) for case in cases]
    first = [drive(controller, case.scene) for controller, case in zip(ours, cases, strict=True)]
    rows = list[Row]()
    for controller, case, before in reversed(list(zip(ours, cases, first, strict=True))):
        both: Drive = before.followed_by(drive(controller, case.scene))
        rows.append({**case.about, **judge(case.scene, both, whole_body=True)})
    return rows[::-1]


MEASURED = (
    Column(key="median_ms", title="median", form=".3f"),
    Column(key="p99_ms", title="p99", form=".3f"),
    Column(key="max_ms", title="max", form=".3f"),
    Column(key="min_margin_mm", title="margin", form="+.3f"),
    Column(key="violations", title="broken"),
    Column(key="failures", title="failed"),
    Column(key="tip_error_median_mm", title="tip", form=".3f"),
)
N, POINTS = Column(key="horizon", title="N"), Column(key="points", title="points")
VARIED = {
    "disks": (Column(key="disks", title="disks"), POINTS),
    "points": (Column(key="spacing_mm", title="spacing", form="g"), POINTS),
    "segments": (Column(key="segments", title="segments"), POINTS),
    "horizon": (N,),
    "mesh": (Column(key="vertices", title="vertices"), N),
}
LOADING = (
    Column(key="vertices", title="vertices"),
    Column(key="triangles", title="triangles"),
    Column(key="load_s", title="load [s]", form=".3f"),
    Column(key="build_s", title="build [s]", form=".3f"),
    Column(key="grid_s", title="grid [s]", form=".3f"),
    Column(key="peak_mb", title="peak [MB]", form=".0f"),
)
TITLES = {
    "disks": "disks, three segments, N = 2",
    "points": "distance of guarded points, 30 disks, N = 2",
    "segments": "segments of a robot that stays as long, 30 disks, N = 2",
    "horizon": "horizon, three segments, 30 disks",
    "mesh": "vertices of the same tube, three segments, 30 disks",
    "loading": "from a binary STL file to a zone",
}


def _result(rows: dict[str, list[Row]], steps: int) -> Result:
    found = summary(rows["mesh"])
    least, most = rows["mesh"][0]["vertices"], rows["mesh"][-1]["vertices"]
    ratios = ", ".join(f"{found[f'median_ratio_n{N}']:.2f} at N = {N}" for N in MESH_HORIZONS)
    line = (
        f"{most} vertices by {least}: median step {ratios}; load and build "
        f"{found['load_and_build_s']:.2f} s, grid {found['grid_s']:.2f} s."
    )
    tables = [
        Table(
            name=name,
            title=TITLES[name],
            columns=LOADING if name == "loading" else (*VARIED[name], *MEASURED),
            rows=rows[name],
        )
        for name in rows
    ]
    return Result(
        what="scaling",
        tables=tuple(tables),
        about={
            "summary": found,
            "scene": describe(steps),
            "settings": {
                "order": "every value of an axis, then all again backwards; times are pooled",
                "robots": "as long, bendable and fast at the tip with any number of segments or "
                "disks: segments are shorter, disks thinner",
                "meshes": "the same axis and radius at the vertices; binary STL in metres",
                "load_s": "read, join and check; build_s: tree and normals; grid_s: lower bounds",
                "peak_mb": "of what Python and numpy allocated meanwhile",
            },
            "versions": versions(),
            "machine": machine(),
        },
        notes=(*NOTES, line),
    )


def summary(mesh: Sequence[Row]) -> dict[str, float]:
    """What the largest mesh costs, beside the smallest."""
    found = dict[str, float]()
    for horizon in MESH_HORIZONS:
        rows = [row for row in mesh if row["horizon"] == horizon]
        found[f"median_ratio_n{horizon}"] = number(rows[-1], "median_ms") / number(
            rows[0], "median_ms"
        )
    last = mesh[-1]
    found["load_and_build_s"] = number(last, "load_s") + number(last, "build_s")
    found["grid_s"] = number(last, "grid_s")
    return found


def number(row: Row, key: str) -> float:
    """A number of a row."""
    value = row[key]
    assert isinstance(value, int | float)
    return float(value)


SCALING = Benchmark(run=run, draw=draw)
