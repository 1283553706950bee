"""`sinuous bench rod`: files of shapes, what it makes of them, and what it refuses."""

import csv
import json
import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.bench import rod, rod_search
from sinuous.bench.benchmark import ignore
from sinuous.bench.rod import RodTask, orders
from sinuous.bench.rod_file import FROM_FILE, read_rod_file
from sinuous.bench.rod_search import find
from sinuous.cli import main
from sinuous.errors import InputError
from sinuous.plants.physics import rod_statics
from sinuous.plants.physics.rod_statics import BareRod, Equilibrium, Load
from sinuous.robots.rod_mechanics import RoundRod

LENGTH = 0.4
RUBBER = RoundRod(radius=4e-3, youngs_modulus=50e6, poisson=0.45, density=1100.0)
SHARES = ((0.0, 0.3, 0.7, 1.0), (0.0, 0.5, 1.0))  # stations, not the same number in both halves
ROUNDED = 1e-3  # mean error by the length: four digits in the file, and second order in space
ASKED_MEAN, ASKED_WORST = 0.005, 0.02
STEEL = RoundRod(radius=0.8e-3, youngs_modulus=200e9, poisson=0.33, density=7870.0)
STEEL_LENGTH, SOME = 0.6, 25
FILE = "opencr/sorosim_spring_steel_statics.csv"
TO_FILE = FROM_FILE.T


def loads(count: int, seed: int = 0) -> list[Load]:
    rng, EI = np.random.default_rng(seed), RUBBER.bending_stiffness
    return [
        Load(
            gravity=np.round(9.81 * Rotation.random(rng=rng).as_matrix()[0], 4),
            forces=np.round(rng.uniform(-1.0, 1.0, (2, 3)) * EI / LENGTH**2, 4),
            moments=np.round(rng.uniform(-1.0, 1.0, (2, 3)) * EI / LENGTH, 4),
        )
        for _ in range(count)
    ]


def lines(load: Load, points: Array, frames: Array, name: str) -> list[list[str]]:
    """Six rows of a file, in its own frame with x along the rod."""
    angles = Rotation.from_matrix(TO_FILE @ frames @ FROM_FILE).as_euler("XYZ").T
    angular = np.column_stack([np.zeros(3), *(load.moments @ FROM_FILE), angles])
    linear = np.column_stack(
        [TO_FILE @ load.gravity, *(load.forces @ FROM_FILE), TO_FILE @ points.T]
    )
    heads = [f"{q}_{name}" for q in ("EulX", "EulY", "EulZ", "Px", "Py", "Pz")]
    return [
        [head, *(f"{v:.4f}" for v in row)]
        for head, row in zip(heads, [*angular, *linear], strict=True)
    ]


def header() -> list[list[str]]:
    names = [f"seg{j}_s{k:02d}" for j, row in enumerate(SHARES, 1) for k in range(1, len(row) + 1)]
    shares = [str(share) for row in SHARES for share in row]
    return [
        ["rowLabel", "gravity", "mid_wrench", "tip_wrench", *names],
        ["arclength", "0", "0", "0", *shares],
    ]


def stations() -> Array:
    return np.array([0.5 * LENGTH * (j + share) for j, row in enumerate(SHARES) for share in row])


def solved(bare: BareRod, load: Load, found: Equilibrium, name: str) -> list[list[str]]:
    """The rows of a shape of ours; frames without twist, as a start for a search."""
    points = bare.points(found, stations())
    way = np.linspace(0.0, LENGTH, len(found.directions))
    z = np.stack([np.interp(stations(), way, found.directions[:, i]) for i in range(3)], axis=1)
    frames = [Rotation.align_vectors([each], [[0.0, 0.0, 1.0]])[0].as_matrix() for each in z]
    return lines(load, points, np.array(frames), name)


def written(path: Path, rows: Sequence[Sequence[str]]) -> str:
    path.write_text("\n".join(",".join(row) for row in rows) + "\n", encoding="utf-8")
    return str(path)


@pytest.fixture
def good(tmp_path: Path) -> str:
    """Five shapes of a rod of rubber, computed with many links."""
    bare, rows = BareRod(RUBBER, length=LENGTH, links=48), header()
    for number, load in enumerate(loads(5), 1):
        rows += solved(bare, load, bare.at_rest(load), f"s{number:03d}")
    return written(tmp_path / "rubber.csv", rows)


def test_it_finds_shapes_of_another_material(good: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rod, "QUICK_LINKS", (4, 8, 16))
    result = RodTask(path=good, rod=RUBBER, length=LENGTH).run(True, ignore)
    read = json.loads(result.as_json())
    assert read["mean_error_fraction"] < ROUNDED
    assert read["worst_error_fraction"] >= read["mean_error_fraction"]
    assert (read["shapes"], read["not_converged"], read["other_shape"]) == (5, 0, 0)
    assert [row["shape"] for row in read["rows"]] == [f"s{k:03d}" for k in range(1, 6)]
    assert read["convergence"][0]["order"] == pytest.approx(2.0, abs=0.2)


def test_the_frame_of_the_file_has_x_along_the_rod(good: str) -> None:
    file = read_rod_file(good, length=LENGTH)
    np.testing.assert_allclose(file.arcs, stations(), rtol=0, atol=1e-12)
    for shape, load in zip(file.shapes, loads(5), strict=True):
        for ours, theirs in zip(
            (shape.load.gravity, shape.load.forces, shape.load.moments),
            (load.gravity, load.forces, load.moments),
            strict=True,
        ):
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-4)
        np.testing.assert_allclose(shape.points[0], 0.0, atol=1e-12)
        assert abs(shape.points[1, 2] - stations()[1]) < 0.1 * LENGTH


def test_another_material_shows(good: str) -> None:
    softer = replace(RUBBER, youngs_modulus=0.7 * RUBBER.youngs_modulus)
    result = RodTask(path=good, rod=softer, length=LENGTH).run(True, ignore)
    assert json.loads(result.as_json())["mean_error_fraction"] > 10 * ROUNDED


def test_a_buckled_rod_has_two_shapes_and_the_one_of_the_file_counts(tmp_path: Path) -> None:
    """Pressed together by thrice what buckles it, it may go either way."""
    press = 3.0 * (np.pi / 2.0) ** 2 * RUBBER.bending_stiffness / LENGTH**2
    bare = BareRod(RUBBER, length=LENGTH, links=16)

    def pushed(side: float) -> Load:
        forces = np.array([[0.0, 0.0, 0.0], [side * 1e-3, 0.0, -press]])
        return Load(gravity=np.zeros(3), forces=forces)

    left, right = (bare.at_rest(pushed(side)) for side in (-1.0, 1.0))
    other = bare.near(pushed(1.0), left.angles)
    assert other.converged
    assert other.frames[-1, 0] < 0.0 < right.frames[-1, 0]
    rows = [*header(), *solved(bare, pushed(1.0), other, "s001")]
    file = read_rod_file(written(tmp_path / "two.csv", rows), length=LENGTH)
    found = find(bare, file.arcs, file.shapes[0])
    assert found.converged
    assert found.other
    assert np.max(found.error) < ROUNDED
    assert np.max(found.straight_error) > 0.5


def test_what_is_not_found_is_no_good_shape(good: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rod_statics, "ITERATIONS", 0)
    result = RodTask(path=good, rod=RUBBER, length=LENGTH).run(True, ignore)
    read = json.loads(result.as_json())
    assert read["not_converged"] == 5
    assert read["mean_error_fraction"] == rod_search.FAILED
    assert not any(row["converged"] for row in read["rows"])


def test_orders_of_convergence() -> None:
    rows = orders([0.04, 0.01, 0.005])
    assert [row.get("order") for row in rows] == [2.0, 1.0, None, None]


def steel() -> Path:
    """The shapes of the public repository, or a skip that says where to get them."""
    shared = Path(__file__).parents[3] / "shared" / "data"
    path = Path(os.environ.get("SINUOUS_DATA", shared)) / FILE
    if not path.exists():
        pytest.skip(
            f"needs {path.name} of the public repository ContinuumRoboticsLab/opencr-mujoco in "
            f"$SINUOUS_DATA/opencr, looked for it in {path.parent}"
        )
    return path


def test_shapes_of_another_solver(tmp_path: Path) -> None:
    """As many as fit a test; `sinuous bench rod` takes all 500."""
    rows = steel().read_text(encoding="utf-8").splitlines()[: 2 + 6 * SOME]
    path = written(tmp_path / "some.csv", [row.split(",") for row in rows])
    result = RodTask(path=path, rod=STEEL, length=STEEL_LENGTH).run(True, ignore)
    read = json.loads(result.as_json())
    assert read["mean_error_fraction"] < ASKED_MEAN
    assert read["worst_error_fraction"] < ASKED_WORST
    assert read["not_converged"] == 0


# --- bad input -------------------------------------------------------------------------------

Change = Callable[[list[list[str]]], None]


def cell(row: int, column: int, text: str) -> Change:
    def change(rows: list[list[str]]) -> None:
        rows[row - 1][column] = text

    return change


def without_column(name: str) -> Change:
    def change(rows: list[list[str]]) -> None:
        column = rows[0].index(name)
        for row in rows:
            del row[column]

    return change


def in_millimetres(rows: list[list[str]]) -> None:
    for row in rows[2:]:
        if row[0].startswith("P"):
            row[4:] = [str(1e3 * float(v)) for v in row[4:]]


def last_row_lost(rows: list[list[str]]) -> None:
    rows.pop()


def only_header(rows: list[list[str]]) -> None:
    del rows[2:]


def no_second_half(rows: list[list[str]]) -> None:
    for row in rows:
        del row[-3:]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (without_column("gravity"), ("row 1", "gravity")),
        (without_column("tip_wrench"), ("row 1", "tip_wrench")),
        (no_second_half, ("row 1", "seg2_")),
        (cell(2, 5, "1.3"), ("row 2", "seg1_", "0 to 1")),
        (cell(2, 5, "0"), ("row 2", "increase")),
        (cell(5, 6, "nan"), ("row 5", "seg1_s03", "finite", "nan")),
        (cell(5, 1, "x"), ("row 5", "gravity", "a number", '"x"')),
        (cell(10, 2, ""), ("row 10", "mid_wrench", "nothing")),
        (cell(4, 0, "EulZ_s001"), ("row 4", "EulY_s001")),
        (cell(15, 0, "EulX_s004"), ("row 16", "EulY_s004")),
        (last_row_lost, ("6 rows for each shape", "29 rows")),
        (only_header, ("6 rows for each shape", "0 rows")),
        (in_millimetres, ("rows 6 to 8", "0.4 m", "--length", "metres")),
    ],
)
def test_bad_files(good: str, tmp_path: Path, change: Change, words: tuple[str, ...]) -> None:
    with Path(good).open(encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    change(rows)
    path = written(tmp_path / "bad.csv", rows)
    with pytest.raises(InputError) as caught:
        read_rod_file(path, length=LENGTH)
    for word in (path, *words):
        assert word in str(caught.value)


@pytest.mark.parametrize("length", [0.3, 0.9, 400.0])
def test_a_length_that_is_not_the_files(good: str, length: float) -> None:
    with pytest.raises(InputError, match="--length"):
        read_rod_file(good, length=length)


ROD = {"length": "0.4", "radius": "0.004", "youngs": "50e6", "poisson": "0.45", "density": "1100"}


def argv(file: str, **changes: str) -> list[str]:
    options = {**ROD, **changes}
    return ["bench", "rod", file, *(x for k, v in options.items() if v for x in (f"--{k}", v))]


def test_on_the_command_line(good: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, file = tmp_path / "out", tmp_path / "rod.json"
    assert main([*argv(good), "--quick", "--json", str(file), "--out", str(out)]) == 0
    assert json.loads(file.read_text())["worst_error_fraction"] < ASKED_WORST
    assert (out / "rod.png").stat().st_size > 10_000
    assert "links per half" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"length": ""}, "--length"),
        ({"density": ""}, "--density"),
        ({"length": "-1"}, "--length"),
        ({"radius": "0"}, "radius"),
        ({"poisson": "0.7"}, "poisson"),
        ({"youngs": "nan"}, "youngs_modulus"),
        ({"length": "nan"}, "--length"),
    ],
)
def test_no_rod(
    good: str, tmp_path: Path, changes: dict[str, str], word: str,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    assert main([*argv(good, **changes), "--out", str(tmp_path)]) == 2
    message = capsys.readouterr().err
    assert word in message
    assert message.count("\n") == 1


def test_without_a_file_and_with_one_too_many(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["bench", "rod", "--length", "1", "--out", str(tmp_path)]) == 2
    assert "a file of shapes" in capsys.readouterr().err
    assert main(["bench", "qp", "some.csv", "--out", str(tmp_path)]) == 2
    assert "some.csv" in capsys.readouterr().err
