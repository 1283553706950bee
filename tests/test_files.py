"""Files in and out: every error by its message, units by their round trip."""

import errno
import math
import resource
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import AllowInfNan, BaseModel, ConfigDict, Field

from sinuous.errors import InputError
from sinuous.files import (
    Angle,
    Curvature,
    Duration,
    FieldError,
    Frequency,
    Length,
    Quantity,
    Speed,
    build,
    file_error,
    length_unit,
    override,
    read_path_csv,
    read_toml,
    write_text,
)

ROUNDING = 1e-15  # relative: a conversion multiplies and divides once, half an ulp each


class Colour(Enum):
    RED = "red"
    BLUE = "blue"


@dataclass(frozen=True, kw_only=True)
class Part:
    size: Annotated[Length, Field(gt=0.0, le=0.5)] | tuple[Length, Length]
    angles: tuple[Angle, ...] = ()
    points: tuple[tuple[Length, Length, Length], ...] = ()
    count: Annotated[int, Field(ge=1)] = 1
    curvature: Annotated[Curvature, AllowInfNan(True)] = math.inf
    low: float = 0.0
    high: float = 1.0

    def __post_init__(self) -> None:
        if self.low > self.high:
            raise FieldError("low", expected="a value below high", remedy="Swap them.")
        if self.count == 13:
            raise ValueError("Any count but 13")


class Inner(BaseModel):
    model_config = ConfigDict(frozen=True)
    speed: Speed
    kind: Literal["slow", "fast"] = "slow"


@dataclass(frozen=True, kw_only=True)
class Top:
    part: tuple[Part, ...] = ()
    inner: Inner | None = None
    named: dict[str, Part] = field(default_factory=dict[str, Part])
    colour: Colour = Colour.RED
    flag: bool = False
    file: Path | None = None
    rate: Frequency = 30.0
    wait: Duration | None = None
    window: Annotated[tuple[int, ...], Field(max_length=3)] = ()
    extra: dict[str, Any] = field(default_factory=dict[str, Any])

    def __post_init__(self) -> None:
        if self.window and sum(self.window) == 0:
            raise FieldError(("inner", "speed"), expected="a speed", remedy="Add one.")


GOOD: dict[str, Any] = {
    "part": [
        {"size_mm": 7, "angles_deg": [0, 180], "points_cm": [[1, 2, 3]]},
        {"size_m": [0.5, 1], "curvature_1_mm": 0.02, "count": 3},
    ],
    "inner": {"speed_mm_s": 20, "kind": "fast"},
    "named": {"a": {"size_cm": 1.5, "curvature_1_m": math.inf}},
    "colour": "blue",
    "flag": True,
    "file": "a.toml",
    "rate_hz": 40,
    "wait_ms": 250,
}


def test_build_resolves_units_everywhere() -> None:
    assert build(Top, GOOD, file="t.toml") == Top(
        part=(
            Part(size=0.007, angles=(0.0, math.pi), points=((0.01, 0.02, 0.03),)),
            Part(size=(0.5, 1.0), curvature=20.0, count=3),
        ),
        inner=Inner(speed=0.02, kind="fast"),
        named={"a": Part(size=0.015)},
        colour=Colour.BLUE,
        flag=True,
        file=Path("a.toml"),
        rate=40.0,
        wait=0.25,
    )


def test_build_leaves_the_table_as_it_is() -> None:
    table = {"part": [{"size_mm": [7, 8]}]}
    build(Top, table, file="t.toml")
    assert table == {"part": [{"size_mm": [7, 8]}]}


BAD_TABLES: list[tuple[str, dict[str, Any], str]] = [
    (
        "unknown key",
        {"colr": "red"},
        "t.toml: colr: expected a key of this file, found an unknown one. Did you mean colour?",
    ),
    (
        "unknown key, nothing near",
        {"inner": {"speed_m_s": 1, "zzzz": 1}},
        "t.toml: inner.zzzz: expected a key of inner, found an unknown one. "
        "Known keys: speed_mm_s, speed_cm_s, speed_m_s, kind.",
    ),
    (
        "unit missing in the key",
        {"part": [{"size_mm": 1}, {"size": 7}]},
        "t.toml: part[1].size: expected a key of part[1], found an unknown one. "
        "Write size_mm, size_cm or size_m: a key carries its unit.",
    ),
    (
        "unknown unit",
        {"part": [{"size_inch": 7}]},
        "t.toml: part[0].size_inch: expected a key of part[0], found an unknown one. "
        "Did you mean size_cm, size_m or size_mm?",
    ),
    (
        "two units",
        {"part": [{"size_mm": 7, "size_m": 0.007}]},
        "t.toml: part[0].size_m: expected the size once, found both size_mm and size_m. "
        "Keep one of them.",
    ),
    (
        "missing, with a unit",
        {"part": [{"count": 1}]},
        "t.toml: part[0].size: expected a value, found nothing. "
        "Add size_mm, size_cm or size_m to part[0].",
    ),
    (
        "missing in a pydantic model",
        {"inner": {}},
        "t.toml: inner.speed: expected a value, found nothing. "
        "Add speed_mm_s, speed_cm_s or speed_m_s to inner.",
    ),
    (
        "number in quotes",
        {"inner": {"speed_mm_s": "20"}},
        't.toml: inner.speed_mm_s: expected a number, found "20". Write the number without quotes.',
    ),
    (
        "true for a number",
        {"inner": {"speed_mm_s": True}},
        "t.toml: inner.speed_mm_s: expected a number, found true. Correct this value.",
    ),
    (
        "neither number nor pair",
        {"part": [{"size_mm": "big"}]},
        't.toml: part[0].size_mm: expected a number or a list, found "big". '
        "Write the number without quotes.",
    ),
    (
        "pair with a word",
        {"part": [{"size_mm": [1, "a"]}]},
        't.toml: part[0].size_mm[1]: expected a number, found "a". '
        "Write the number without quotes.",
    ),
    (
        "pair of one",
        {"part": [{"size_mm": [1]}]},
        "t.toml: part[0].size_mm: expected a number or a list of at least 2, found [1]. "
        "Correct this value.",
    ),
    (
        "point of two",
        {"part": [{"size_mm": 1, "points_mm": [[1, 2, 3], [4, 5]]}]},
        "t.toml: part[0].points_mm[1]: expected a list of at least 3, found [4, 5]. "
        "Correct this value.",
    ),
    (
        "too many",
        {"window": [1, 2, 3, 4]},
        "t.toml: window: expected a list of at most 3, found [1, 2, 3, 4]. Correct this value.",
    ),
    (
        "negative, bound in the user's unit",
        {"part": [{"size_mm": -7}]},
        "t.toml: part[0].size_mm: expected more than 0 or a list, found -7. Correct this value.",
    ),
    (
        "too large, bound in the user's unit",
        {"part": [{"size_mm": 501}]},
        "t.toml: part[0].size_mm: expected at most 500 or a list, found 501. Correct this value.",
    ),
    (
        "fraction for a count",
        {"part": [{"size_mm": 1, "count": 2.5}]},
        "t.toml: part[0].count: expected a whole number, found 2.5. Correct this value.",
    ),
    (
        "count of nothing",
        {"part": [{"size_mm": 1, "count": 0}]},
        "t.toml: part[0].count: expected at least 1, found 0. Correct this value.",
    ),
    (
        "nan",
        {"part": [{"size_mm": [1, math.nan]}]},
        "t.toml: part[0].size_mm[1]: expected a finite number, found nan. Correct this value.",
    ),
    (
        "nan where infinity is allowed",
        {"part": [{"size_mm": 1, "curvature_1_m": math.nan}]},
        "t.toml: part[0].curvature_1_m: expected a finite number, found nan. Correct this value.",
    ),
    (
        "infinity",
        {"rate_hz": math.inf},
        "t.toml: rate_hz: expected a finite number, found inf. Correct this value.",
    ),
    (
        "nan where anything goes",
        {"extra": {"deep": [{"x": math.nan}]}},
        "t.toml: extra.deep[0].x: expected a finite number, found nan. Correct this value.",
    ),
    (
        "integer beyond floats",
        {"rate_hz": 10**400},
        f"t.toml: rate_hz: expected a finite number, found 1{'0' * 56}.... Correct this value.",
    ),
    (
        "unknown choice",
        {"colour": "green"},
        't.toml: colour: expected "red" or "blue", found "green". Correct this value.',
    ),
    (
        "unknown literal",
        {"inner": {"speed_m_s": 1, "kind": "brisk"}},
        't.toml: inner.kind: expected "slow" or "fast", found "brisk". Correct this value.',
    ),
    (
        "word for a flag",
        {"flag": "yes"},
        't.toml: flag: expected true or false, found "yes". Correct this value.',
    ),
    (
        "number for text",
        {"file": 3},
        "t.toml: file: expected text, found 3. Correct this value.",
    ),
    (
        "single brackets",
        {"part": {"size_mm": 1}},
        "t.toml: part: expected a list, found a table. "
        "Write its header with double brackets, [[part]].",
    ),
    (
        "double brackets",
        {"inner": [{"speed_mm_s": 1}]},
        "t.toml: inner: expected a table, found [a table]. "
        "Write its header with single brackets, [inner].",
    ),
    (
        "value for a table",
        {"named": {"a": 3}},
        "t.toml: named.a: expected a table, found 3. Correct this value.",
    ),
    (
        "fields that do not fit",
        {"named": {"a": {"size_mm": 1, "low": 5.0}}},
        "t.toml: named.a.low: expected a value below high, found 5.0. Swap them.",
    ),
    (
        "a field missing because of another",
        {"window": [1, -1]},
        "t.toml: inner.speed: expected a speed, found nothing. Add one.",
    ),
    (
        "a field wrong because of another",
        {"window": [1, -1], "inner": {"speed_mm_s": 3}},
        "t.toml: inner.speed_mm_s: expected a speed, found 3. Add one.",
    ),
    (
        "a plain ValueError",
        {"part": [{"size_mm": 1, "count": 13}]},
        "t.toml: part[0]: expected Any count but 13, found a table. Correct this value.",
    ),
]


@pytest.mark.parametrize(
    ("data", "message"), [case[1:] for case in BAD_TABLES], ids=[case[0] for case in BAD_TABLES]
)
def test_bad_table(data: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError) as caught:
        build(Top, data, file="t.toml")
    assert str(caught.value) == message


def test_a_field_measures_one_thing() -> None:
    @dataclass
    class Mixed:
        both: tuple[Length, Angle]

    with pytest.raises(TypeError, match="one quantity"):
        build(Mixed, {"both_mm": [1, 2]}, file="t.toml")


@given(
    st.sampled_from([(q, name) for q in Quantity for name in q.units]),
    st.floats(min_value=-1e12, max_value=1e12, allow_subnormal=False),
)
def test_units_round_trip(which: tuple[Quantity, str], value: float) -> None:
    quantity, name = which
    unit = quantity.units[name]
    assert unit.from_si(unit.to_si(value)) == pytest.approx(value, rel=ROUNDING, abs=1e-300)


@given(st.integers(min_value=-(10**9), max_value=10**9))
def test_whole_millimetres_are_the_nearest_metres(value: int) -> None:
    assert Quantity.LENGTH.units["mm"].to_si(value) == float(f"{value}e-3")


@given(st.floats(allow_nan=False, allow_infinity=False, min_value=-1e12, max_value=1e12))
def test_metres_come_through_bit_for_bit(value: float) -> None:
    built = build(Inner, {"speed_m_s": value}, file="t.toml")
    assert built.speed == value


@pytest.mark.parametrize(("name", "metres"), [("m", 1.0), ("cm", 0.01), ("mm", 0.001)])
def test_length_unit(name: str, metres: float) -> None:
    assert length_unit(name, file="s.toml", field="mesh.unit") == metres


@pytest.mark.parametrize("name", ["", "inch", "MM", "km", "metre"])
def test_unknown_length_unit(name: str) -> None:
    with pytest.raises(InputError) as caught:
        length_unit(name, file="s.toml", field="mesh.unit")
    assert str(caught.value) == (
        f's.toml: mesh.unit: expected one of "m", "cm", "mm", found "{name}". '
        "Name the unit that the numbers in the file are in."
    )


MPC = {"horizon": 2, "step_mm": 2}
OVERRIDES: list[tuple[str, list[str], dict[str, Any]]] = [
    ("number", ["mpc.horizon=5"], {"mpc": {"horizon": 5, "step_mm": 2}}),
    ("spaces", [" mpc.horizon = 5 "], {"mpc": {"horizon": 5, "step_mm": 2}}),
    ("other unit", ["mpc.step_m=0.1"], {"mpc": {"horizon": 2, "step_m": 0.1}}),
    ("no unit stays beside", ["mpc.step=1"], {"mpc": MPC | {"step": 1}}),
    ("speed is no duration", ["mpc.step_mm_s=1"], {"mpc": MPC | {"step_mm_s": 1}}),
    ("new tables", ["a.b.c_mm=0.2"], {"a": {"b": {"c_mm": 0.2}}}),
    ("bare word", ["a=path/to.csv"], {"a": "path/to.csv"}),
    ("quoted", ['a="5"'], {"a": "5"}),
    ("list", ["a=[1, 2.5]"], {"a": [1, 2.5]}),
    ("table", ["a={x = 1}"], {"a": {"x": 1}}),
    ("flag", ["a=true"], {"a": True}),
    ("equals sign in the value", ["a=b=c"], {"a": "b=c"}),
    ("two lines are one text", ["a=1\nb=2"], {"a": "1\nb=2"}),
    ("item by dot", ["segment.1.length_cm=4"], {"segment": [{"length_mm": 1}, {"length_cm": 4}]}),
    (
        "item by bracket",
        ["segment[0].x=4"],
        {"segment": [{"length_mm": 1, "x": 4}, {"length_mm": 2}]},
    ),
    ("number in a list", ["point_mm[2]=9"], {"point_mm": [1, 2, 9]}),
    ("the last one holds", ["a=1", "a=2"], {"a": 2}),
]
BASE: dict[str, Any] = {
    "mpc": MPC,
    "segment": [{"length_mm": 1}, {"length_mm": 2}],
    "point_mm": [1, 2, 3],
}


@pytest.mark.parametrize(
    ("assignments", "changed"), [case[1:] for case in OVERRIDES], ids=[c[0] for c in OVERRIDES]
)
def test_override(assignments: list[str], changed: dict[str, Any]) -> None:
    before = repr(BASE)
    assert override(BASE, assignments) == BASE | changed
    assert repr(BASE) == before


HOW = "Write it like --set mpc.horizon=5 or --set segment[0].length_mm=60."


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("mpc.horizon", f'--set: expected key=value, found "mpc.horizon". {HOW}'),
        ("mpc.horizon=", f'--set: expected key=value, found "mpc.horizon=". {HOW}'),
        ("=5", f'--set: expected key=value, found "=5". {HOW}'),
        ("mpc..horizon=5", f'--set: expected key=value, found "mpc..horizon=5". {HOW}'),
        ("mpc horizon=5", f'--set: expected key=value, found "mpc horizon=5". {HOW}'),
        ("a=[1, 2", "--set: a: expected a TOML value, found [1, 2. Check its brackets and quotes."),
        (
            "segment[2].length_mm=4",
            '--set: segment[2].length_mm: expected the index of an item, found "2". '
            "The list has 2 items, counted from 0.",
        ),
        (
            "segment.last.length_mm=4",
            '--set: segment.last.length_mm: expected the index of an item, found "last". '
            "The list has 2 items, counted from 0.",
        ),
        (
            "mpc.horizon.x=4",
            "--set: mpc.horizon.x: expected mpc.horizon to be a table or a list, found 2. "
            "Check the key.",
        ),
        (
            "mpc.horizon.x.y=4",
            "--set: mpc.horizon.x.y: expected mpc.horizon to be a table or a list, found 2. "
            "Check the key.",
        ),
    ],
)
def test_bad_override(assignment: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        override(BASE, [assignment])
    assert str(caught.value) == message


def test_read_toml(tmp_path: Path) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(b"\xef\xbb\xbfx = 1\n[t]\ny = [1.5, 2]\n")
    assert read_toml(path) == read_toml(str(path)) == {"x": 1, "t": {"y": [1.5, 2]}}


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"x = 1\ny = = 2\n", "expected valid TOML, found invalid value at line 2, column 5. "),
        (b"x = 1\nx = 2\n", "expected valid TOML, found cannot overwrite a value at line 2, "),
        (b"[t\n", "expected valid TOML, found expected ']' at the end of a table declaration "),
        (b"x = [1,", "expected valid TOML, found invalid value at end of document. "),
        (b"x = " + b"[" * 100_000, "expected valid TOML, found "),
        (b"x = " + b"1" * 10_000, "expected valid TOML, found "),
        (b"x = '\xff'", "expected text in UTF-8, found byte 0xff at offset 5. "),
    ],
)
def test_bad_toml(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "a.toml"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_toml(path)
    assert str(caught.value).startswith(f"{path}: {message}")


def test_missing_files_and_folders(tmp_path: Path) -> None:
    (tmp_path / "tube.toml").write_text("")
    for name, message in [
        ("tub.toml", f"expected a file, found nothing there. Did you mean {tmp_path}/tube.toml?"),
        ("zzz", "expected a file, found nothing there. Check the path."),
        (
            "no/such.toml",
            f"expected a file, found nothing there. The folder {tmp_path}/no does not exist; "
            f"{tmp_path} does.",
        ),
        (".", "expected a file, found a folder. Name a file."),
        (
            "tube.toml/x",
            "expected a readable file, found a file where a folder should be. Check the path.",
        ),
        ("a\0b", "expected a readable file, found embedded null byte. Check the path."),
    ]:
        with pytest.raises(InputError) as caught:
            read_toml(tmp_path / name)
        assert str(caught.value) == f"{tmp_path / name}: {message}"


def test_file_error_gives_advice() -> None:
    full = file_error(
        "out/run.mcap", OSError(errno.ENOSPC, "No space left on device"), expected="room"
    )
    assert str(full) == (
        "out/run.mcap: expected room, found no space left on device. "
        "Free some space or choose another folder."
    )


def test_path_csv(tmp_path: Path) -> None:
    path = tmp_path / "path.csv"
    path.write_text("label, z_cm, t_s, x_mm,y_m\na,1,0,10,0.5\n\nb, 2 ,0.5,-20,1e-1\n")
    times, points = read_path_csv(path)
    np.testing.assert_array_equal(times, [0.0, 0.5])
    np.testing.assert_array_equal(points, [[0.01, 0.5, 0.01], [-0.02, 0.1, 0.02]])


def test_path_csv_of_one_row(tmp_path: Path) -> None:
    path = tmp_path / "path.csv"
    path.write_text("t_ms,x_mm,y_mm,z_mm\r\n500,1,2,3\r\n")
    times, points = read_path_csv(path)
    assert times.tolist() == [0.5]
    assert points.tolist() == [[0.001, 0.002, 0.003]]


@given(st.lists(st.tuples(*[st.floats(-1e6, 1e6, allow_nan=False)] * 3), min_size=1, max_size=20))
def test_path_csv_round_trip(tmp_path_factory: pytest.TempPathFactory, points: list[Any]) -> None:
    path = tmp_path_factory.mktemp("csv") / "path.csv"
    rows = [f"{k / 8},{x!r},{y!r},{z!r}" for k, (x, y, z) in enumerate(points)]
    write_text(path, "\n".join(["t_s,x_m,y_m,z_m", *rows]))
    times, read = read_path_csv(path)
    assert times.tolist() == [k / 8 for k in range(len(points))]
    assert read.tolist() == [list(point) for point in points]


HEADER = "t_s,x_mm,y_mm,z_mm\n"
FINITE = "expected a finite number, found"
FIX = "Correct or remove that row."
NAMES = "Name the columns in the first row, like t_s,x_mm,y_mm,z_mm."


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", ": expected a header and rows of numbers, found an empty file. "),
        (HEADER, ": expected at least one row of numbers, found only a header. "),
        (
            "t_s,x_mm,y_mm\n0,1,2\n",
            ": row 1: expected one column z_mm, z_cm or z_m, found the columns t_s, x_mm, y_mm. "
            + NAMES,
        ),
        (
            "t,x_mm,y_mm,z_mm\n0,1,2,3\n",
            ": row 1: expected one column t_s or t_ms, found the columns t, x_mm, y_mm, z_mm. "
            + NAMES,
        ),
        (
            "t_s,x_mm,y_mm,z_mm,x_m\n0,1,2,3,4\n",
            ": row 1: expected one column x_mm, x_cm or x_m, found the columns "
            "t_s, x_mm, y_mm, z_mm, x_m. " + NAMES,
        ),
        (
            HEADER + "0,1,2,3\n1,one,2,3\n",
            f': row 3, column x_mm: expected a number, found "one". {FIX}',
        ),
        (HEADER + "0,1,2\n", f": row 2, column z_mm: expected a number, found nothing. {FIX}"),
        (HEADER + "0,1,,3\n", f": row 2, column y_mm: expected a number, found nothing. {FIX}"),
        (HEADER + "0,1,nan,3\n", f": row 2, column y_mm: {FINITE} nan. {FIX}"),
        (HEADER + "0,1,2,-inf\n", f": row 2, column z_mm: {FINITE} -inf. {FIX}"),
        (
            HEADER + "0,1,2,3\n\n2,1,2,3\n1.5,1,2,3\n",
            f": row 5, column t_s: expected a time after the one before, found 1.5. {FIX}",
        ),
        (
            HEADER + "0,1,2,3\n0,1,2,3\n",
            f": row 3, column t_s: expected a time after the one before, found 0. {FIX}",
        ),
    ],
)
def test_bad_path_csv(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "path.csv"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        read_path_csv(path)
    assert str(caught.value).startswith(f"{path}{message}")


def names(folder: Path) -> list[str]:
    return [path.name for path in folder.iterdir()]


def test_write_text_makes_folders_and_replaces(tmp_path: Path) -> None:
    path = tmp_path / "new" / "deep" / "a.txt"
    write_text(path, "one\n")
    write_text(path, "two °\n")
    assert path.read_bytes() == "two °\n".encode()
    assert names(path.parent) == ["a.txt"]


def test_write_text_follows_links(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "real")
    write_text(tmp_path / "link", "x")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_text() == "x"


@contextmanager
def largest_file(size: int) -> Iterator[None]:
    """Let the system refuse files beyond a size [bytes], as a full disk would."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_write_text_leaves_nothing_half_written(tmp_path: Path) -> None:
    path = tmp_path / "summary.json"
    write_text(path, "before")
    with largest_file(1000), pytest.raises(InputError) as caught:
        write_text(path, "x" * 100_000)
    assert str(caught.value) == (
        f"{path}: expected a file that can be written, found file too large. "
        "Free some space or choose another folder."
    )
    assert path.read_text() == "before"
    assert names(tmp_path) == ["summary.json"]


def test_write_text_where_it_cannot(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for target, message in [
        (tmp_path, "expected a file, found a folder. Name a file."),
        (Path("/dev/null"), "expected a file, found a device. Name a file."),
        (
            tmp_path / "file" / "x",
            "expected a file that can be written, found a file where a folder should be. "
            "Check the path.",
        ),
    ]:
        with pytest.raises(InputError) as caught:
            write_text(target, "x")
        assert str(caught.value) == f"{target}: {message}"
