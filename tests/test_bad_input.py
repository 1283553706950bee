"""Whatever is wrong with the input: exit code 2, one message that says where and what to do."""

import errno
import resource
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path

import pytest

from sinuous import shapes
from sinuous.cli import main
from sinuous.recording import writer

BAD_INPUT = 2
RADIUS = 0.02
AXIS = ((0.0, 0.0, -0.05), (0.0, 0.0, 0.3))

SCENARIO = """\
name = "tube"

[robot]
file = "robot.toml"
base_position_mm = [0, 0, 0]

[zone]
mesh = "tube.stl"
unit = "mm"

[mpc]
horizon = 2
rate_hz = 30
margin_mm = 3

[path]
waypoints_mm = [[0, 0, 210]]
max_steps = 4
"""

ROBOT = """\
name = "arm"
[[segment]]
length_mm = [150, 250]
home_length_mm = 200
disks = 10
cable_angles_deg = [0, 120, 240]
pitch_radius_mm = 6
body_radius_mm = 8
disk_thickness_mm = 2
min_bend_radius_mm = 50
[limits.simulation]
cable_speed_mm_s = 20
backbone_speed_mm_s = 10
cable_length_mm = [120, 280]
"""

JOINTED = """\
name = "arm"
[modules]
count = 3
holes = 9
radius_mm = 8
plate_offset_mm = 5
tube_length_mm = 40
max_bend_deg = 50
[limits.simulation]
cable_speed_mm_s = 100
"""

CSV = "t_s,x_mm,y_mm,z_mm\n0,0,0,200\n1,0,0,205\n"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A current directory with a good robot, mesh, path and scenario."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "robot.toml").write_text(ROBOT)
    (tmp_path / "path.csv").write_text(CSV)
    (tmp_path / "scenario.toml").write_text(SCENARIO)
    save_tube(tmp_path / "tube.stl")
    return tmp_path


def save_tube(
    path: Path,
    *,
    scale: float = 1e3,
    invert: bool = False,
    caps: bool = True,
    fin: bool = False,
) -> None:
    """Write a straight tube, or one with a mistake in it."""
    mesh = shapes.tube(AXIS, RADIUS, sections=12, caps=caps)
    if fin:
        far = [[0.1, 0.1, 0.1]]
        corners = [*mesh.faces[0][:2], len(mesh.vertices)]
        mesh = type(mesh)([*mesh.vertices, *far], [*mesh.faces, corners], process=False)
    if invert:
        mesh.invert()
    mesh.apply_scale(scale)
    mesh.export(path)


@dataclass(frozen=True, kw_only=True)
class Case:
    """One mistake.

    Arguments:
        name: of the case
        words: what the message has to contain: the file, the field and more
        swap: text of the scenario and what stands there instead
        spoil: what else is done before
        argv: the command line
    """

    name: str
    words: Sequence[str]
    swap: tuple[str, str] = ("", "")
    spoil: Callable[[], object] = field(default=lambda: None)
    argv: Sequence[str] = ("run", "scenario.toml", "--out", "out")


def write(name: str, text: str) -> Callable[[], object]:
    """Return what writes a file."""
    return lambda: Path(name).write_text(text)


PATH_LINES = "waypoints_mm = [[0, 0, 210]]"

CASES = [
    # the scenario file
    Case(
        name="scenario missing",
        argv=("run", "scenarios.toml", "--out", "out"),
        words=("scenarios.toml", "nothing there", "Did you mean scenario.toml?"),
    ),
    Case(
        name="scenario is a folder",
        argv=("run", ".", "--out", "out"),
        words=(".:", "expected a file", "found a folder"),
    ),
    Case(
        name="scenario is not TOML",
        swap=('name = "tube"', "name = tube"),
        words=("scenario.toml", "valid TOML", "line 1"),
    ),
    Case(
        name="scenario is not text",
        spoil=lambda: Path("scenario.toml").write_bytes(b"name = \xff"),
        words=("scenario.toml", "UTF-8", "offset 7"),
    ),
    Case(
        name="unknown key",
        swap=("horizon = 2", "horizn = 2"),
        words=("scenario.toml: mpc.horizn", "unknown", "Did you mean horizon?"),
    ),
    Case(
        name="unknown table",
        swap=("[mpc]", "[mcp]"),
        words=("scenario.toml: mcp", "unknown", "mpc"),
    ),
    Case(
        name="unit missing in a key",
        swap=("margin_mm", "margin"),
        words=("scenario.toml: mpc.margin", "margin_mm", "unit"),
    ),
    Case(
        name="two units for a field",
        swap=("margin_mm = 3", "margin_mm = 3\nmargin_m = 0.003"),
        words=("scenario.toml: mpc.margin", "both margin_mm and margin_m", "Keep one"),
    ),
    Case(
        name="horizon zero",
        swap=("horizon = 2", "horizon = 0"),
        words=("scenario.toml: mpc.horizon", "at least 1", "found 0"),
    ),
    Case(
        name="horizon not whole",
        swap=("horizon = 2", "horizon = 2.5"),
        words=("scenario.toml: mpc.horizon", "whole number", "2.5"),
    ),
    Case(
        name="rate zero",
        swap=("rate_hz = 30", "rate_hz = 0"),
        words=("scenario.toml: mpc.rate_hz", "more than 0", "found 0"),
    ),
    Case(
        name="margin negative",
        swap=("margin_mm = 3", "margin_mm = -3"),
        words=("scenario.toml: mpc.margin_mm", "at least 0", "found -3"),
    ),
    Case(
        name="tip speed zero",
        swap=("rate_hz = 30", "rate_hz = 30\ntip_speed_mm_s = 0"),
        words=("scenario.toml: mpc.tip_speed_mm_s", "more than 0"),
    ),
    Case(
        name="unknown cost",
        swap=("rate_hz = 30", 'rate_hz = 30\ncost = "cheap"'),
        words=("scenario.toml: mpc.cost", "unbiased", "printed", "cheap"),
    ),
    Case(
        name="no path table",
        swap=(f"[path]\n{PATH_LINES}\nmax_steps = 4", ""),
        words=("scenario.toml: path", "Add path"),
    ),
    Case(
        name="neither way-points nor csv",
        swap=(PATH_LINES, ""),
        words=("scenario.toml: path.waypoints", "waypoints_mm or csv"),
    ),
    Case(
        name="way-points and csv",
        swap=(PATH_LINES, f'{PATH_LINES}\ncsv = "path.csv"'),
        words=("scenario.toml: path.csv", "not both", "Keep one"),
    ),
    Case(
        name="no way-point",
        swap=(PATH_LINES, "waypoints_mm = []"),
        words=("scenario.toml: path.waypoints_mm", "at least 1"),
    ),
    Case(
        name="way-point of two numbers",
        swap=(PATH_LINES, "waypoints_mm = [[0, 210]]"),
        words=("scenario.toml: path.waypoints_mm[0]", "list of at least 3"),
    ),
    Case(
        name="way-point is not a number",
        swap=(PATH_LINES, "waypoints_mm = [[0, 0, nan]]"),
        words=("scenario.toml: path.waypoints_mm[0][2]", "finite number", "nan"),
    ),
    Case(
        name="seed negative",
        swap=('name = "tube"', 'name = "tube"\nseed = -1'),
        words=("scenario.toml: seed", "at least 0"),
    ),
    Case(
        name="disturbance negative",
        swap=("[path]", "[plant.disturbance]\npoint_std_mm = -1\n[path]"),
        words=("scenario.toml: plant.disturbance.point_std_mm", "at least 0", "-1"),
    ),
    # the path
    Case(
        name="csv missing",
        swap=(PATH_LINES, 'csv = "pth.csv"'),
        words=("scenario.toml: path.csv", "pth.csv", "relative to the scenario"),
    ),
    Case(
        name="csv with nan",
        swap=(PATH_LINES, 'csv = "path.csv"'),
        spoil=write("path.csv", CSV.replace("205", "nan")),
        words=("path.csv: row 3, column z_mm", "finite number", "nan"),
    ),
    Case(
        name="csv back in time",
        swap=(PATH_LINES, 'csv = "path.csv"'),
        spoil=write("path.csv", CSV + "0.5,0,0,200\n"),
        words=("path.csv: row 4, column t_s", "after the one before", "0.5"),
    ),
    # the robot
    Case(
        name="robot file missing",
        swap=('"robot.toml"', '"robots/robot.toml"'),
        words=("scenario.toml: robot.file", "robots/robot.toml", "relative to the scenario"),
    ),
    Case(
        name="unknown preset",
        swap=('"robot.toml"', '"hachen2026"'),
        words=("scenario.toml: robot.file", "hachen2026", "Did you mean hachen2025?"),
    ),
    Case(
        name="unknown limits",
        swap=('"robot.toml"', '"robot.toml"\nlimits = "simulated"'),
        words=("scenario.toml: robot.limits", "robot.toml", "simulation"),
    ),
    Case(
        name="negative length in the robot",
        spoil=write("robot.toml", ROBOT.replace("body_radius_mm = 8", "body_radius_mm = -8")),
        words=("robot.toml: segment[0].body_radius_mm", "more than 0", "-8"),
    ),
    Case(
        name="too few holes for the cables of a jointed robot",
        spoil=write("robot.toml", JOINTED.replace("holes = 9", "holes = 6")),
        words=("robot.toml: modules.holes", "multiple of 3 and at least 9", "found 6"),
    ),
    Case(
        name="a jointed robot without modules",
        spoil=write("robot.toml", JOINTED.replace("count = 3", "count = 0")),
        words=("robot.toml: modules.count", "at least 1", "found 0"),
    ),
    Case(
        name="joints that bend beyond contact",
        spoil=write("robot.toml", JOINTED.replace("max_bend_deg = 50", "max_bend_deg = 70")),
        words=("robot.toml: modules.max_bend_deg", "at most 64.01 degrees", "touch", "found 70"),
    ),
    Case(
        name="a robot of segments and modules",
        spoil=write("robot.toml", ROBOT + JOINTED.partition("\n")[2].replace("simulation", "b")),
        words=("robot.toml", "either [[segment]] tables or a [modules] table", "both"),
    ),
    Case(
        name="base not finite",
        swap=("[0, 0, 0]", "[0, inf, 0]"),
        words=("scenario.toml: robot.base_position_mm[1]", "finite", "inf"),
    ),
    Case(
        name="too few start lengths",
        swap=("[0, 0, 0]", "[0, 0, 0]\nstart_lengths_mm = [200, 200]"),
        words=("scenario.toml: robot.start_lengths", "4 lengths", "segment 1 backbone"),
    ),
    Case(
        name="start lengths beyond the limits",
        swap=("[0, 0, 0]", "[0, 0, 0]\nstart_lengths_mm = [260, 260, 260, 260]"),
        words=("scenario.toml: robot.start_lengths", "10 mm beyond"),
    ),
    Case(
        name="start bent too far",
        swap=("[0, 0, 0]", "[0, 0, 0]\nstart_lengths_mm = [170, 215, 215, 200]"),
        words=("scenario.toml: robot.start_lengths", "bend limits", "segment 1"),
    ),
    Case(
        name="starts outside",
        swap=("[0, 0, 0]", "[0, 14, 0]"),
        words=("scenario.toml: robot.base_position", "beyond triangle", "tube.stl", "recover"),
    ),
    Case(
        name="starts within the margin",
        swap=("[0, 0, 0]", "[0, 10, 0]"),
        words=("scenario.toml: robot.base_position", "mm from triangle", "reduce mpc.margin"),
    ),
    # the mesh
    Case(
        name="mesh missing",
        swap=('"tube.stl"', '"pipe.stl"'),
        words=("scenario.toml: zone.mesh", "pipe.stl", "relative to the scenario"),
    ),
    Case(
        name="mesh of another format",
        swap=('"tube.stl"', '"robot.toml"'),
        words=("scenario.toml: zone.mesh", "STL, OBJ or PLY", "robot.toml"),
    ),
    Case(
        name="mesh open",
        spoil=lambda: save_tube(Path("tube.stl"), caps=False),
        words=("scenario.toml: zone.mesh", "open", "tube.stl", "cap"),
    ),
    Case(
        name="mesh not manifold",
        spoil=lambda: save_tube(Path("tube.stl"), fin=True),
        words=("scenario.toml: zone.mesh", "tube.stl", "edge"),
    ),
    Case(
        name="mesh in metres declared as millimetres",
        spoil=lambda: save_tube(Path("tube.stl"), scale=1.0),
        words=("scenario.toml: zone.mesh", "implausible size", "0.35 mm", "unit"),
    ),
    Case(
        name="mesh in millimetres declared as metres",
        swap=('unit = "mm"', 'unit = "m"'),
        words=("scenario.toml: zone.mesh", "implausible size", "350 m", "unit"),
    ),
    Case(
        name="mesh without a unit",
        swap=('unit = "mm"\n', ""),
        words=("scenario.toml: zone.unit", "Add unit"),
    ),
    Case(
        name="mesh in furlongs",
        swap=('unit = "mm"', 'unit = "furlong"'),
        words=("scenario.toml: zone.unit", "furlong", '"mm"'),
    ),
    Case(
        name="mesh without triangles",
        swap=('"tube.stl"', '"points.obj"'),
        spoil=write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
        words=("scenario.toml: zone.mesh", "points.obj", "triangles"),
    ),
    Case(
        name="mesh empty",
        spoil=write("tube.stl", ""),
        words=("scenario.toml: zone.mesh", "tube.stl", "empty"),
    ),
    Case(
        name="mesh cut off",
        spoil=lambda: Path("tube.stl").write_bytes(Path("tube.stl").read_bytes()[:300]),
        words=("scenario.toml: zone.mesh", "tube.stl"),
    ),
    Case(
        name="keep-out open",
        swap=('unit = "mm"', 'unit = "mm"\nkeep_out = ["open.stl"]'),
        spoil=lambda: save_tube(Path("open.stl"), caps=False),
        words=("scenario.toml: zone.keep_out[0]", "open.stl", "open"),
    ),
    Case(
        name="entrance far away",
        swap=('unit = "mm"', 'unit = "mm"\nentrance_mm = [500, 0, 0]'),
        words=("scenario.toml: zone.entrance", "nearest planar facet"),
    ),
    # the command line
    Case(
        name="--set without a value",
        argv=("run", "scenario.toml", "--out", "out", "--set", "mpc.horizon"),
        words=("--set", "key=value", "mpc.horizon"),
    ),
    Case(
        name="--set of an unknown key",
        argv=("run", "scenario.toml", "--out", "out", "--set", "mpc.speed=5"),
        words=("scenario.toml: mpc.speed", "unknown"),
    ),
    Case(
        name="--set below a number",
        argv=("run", "scenario.toml", "--out", "out", "--set", "mpc.horizon.deep=5"),
        words=("--set: mpc.horizon.deep", "a table", "found 2"),
    ),
    Case(
        name="out is a file",
        argv=("run", "scenario.toml", "--out", "path.csv"),
        words=("path.csv", "folder", "found a file"),
    ),
    Case(
        name="out is empty",
        argv=("run", "scenario.toml", "--out", ""),
        words=("--out", "an empty name"),
    ),
    Case(
        name="out is below a file",
        argv=("run", "scenario.toml", "--out", "path.csv/out"),
        words=("path.csv/out", "a file where a folder should be"),
    ),
    Case(
        name="out holds other things",
        argv=("run", "scenario.toml", "--out", "."),
        words=(".:", "other things", "path.csv", "another folder"),
    ),
    Case(
        name="check nothing",
        argv=("check", ""),
        words=("FILE", "an empty name"),
    ),
    Case(
        name="check a mesh without a unit",
        argv=("check", "tube.stl"),
        words=("--unit", "--unit mm"),
    ),
    Case(
        name="check a mesh in a wrong unit",
        argv=("check", "tube.stl", "--unit", "m"),
        words=("tube.stl", "implausible size"),
    ),
    Case(
        name="check an unknown preset",
        argv=("check", "hachen"),
        words=("hachen", "Did you mean hachen2025?"),
    ),
    Case(
        name="check some other file",
        spoil=write("notes.md", ""),
        argv=("check", "notes.md"),
        words=("notes.md", ".toml, .stl", '".md"'),
    ),
    Case(
        name="check some other TOML",
        spoil=write("notes.toml", "a = 1"),
        argv=("check", "notes.toml"),
        words=("notes.toml", "[[segment]]", "[modules]", "[robot]"),
    ),
    Case(
        name="target is not a place",
        argv=("check", "scenario.toml", "--target", "1,2"),
        words=("--target", "three finite numbers", '"1,2"'),
    ),
    Case(
        name="target is not finite",
        argv=("check", "scenario.toml", "--target", "1,2,nan"),
        words=("--target", "three finite numbers", "nan"),
    ),
    Case(
        name="target for a mesh",
        argv=("check", "tube.stl", "--unit", "mm", "--target", "1,2,3"),
        words=("--target", "scenario", "tube.stl"),
    ),
    Case(
        name="check a file that is not a recording",
        spoil=write("run.mcap", "nothing of the kind"),
        argv=("check", "run.mcap"),
        words=("run.mcap", "a recording"),
    ),
    Case(
        name="compare with something that is not a run",
        argv=("compare", "path.csv", "path.csv", "--out", "out"),
        words=("path.csv", "a recording of a run", "another format"),
    ),
    Case(
        name="compare with nothing",
        argv=("compare", "a", "b", "--out", "out"),
        words=("a:", "a recording of a run", "no such file"),
    ),
    Case(
        name="compare into nothing",
        argv=("compare", "a", "b", "--out", " "),
        words=("--out", "an empty name"),
    ),
]


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_one_message_and_exit_code_2(case: Case, capsys: pytest.CaptureFixture[str]) -> None:
    case.spoil()
    text = Path("scenario.toml").read_bytes()
    if case.swap[0]:
        assert case.swap[0].encode() in text
        Path("scenario.toml").write_bytes(
            text.replace(case.swap[0].encode(), case.swap[1].encode(), 1)
        )
    before = sorted(Path().rglob("*"))

    assert main(case.argv) == BAD_INPUT

    output = capsys.readouterr()
    assert output.err.startswith("sinuous: ")
    assert output.err.count("\n") == 1, output.err
    assert output.out == ""
    for word in case.words:
        assert word in output.err
    assert sorted(Path().rglob("*")) == before


@pytest.mark.parametrize(
    ("argv", "word"),
    [
        ((), "run"),
        (("fly",), "fly"),
        (("run", "scenario.toml"), "--out"),
        (("run", "scenario.toml", "--out", "out", "--fast"), "--fast"),
        (("compare", "a", "--out", "out"), "RUN"),
    ],
)
def test_wrong_arguments(
    argv: tuple[str, ...], word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(argv) == BAD_INPUT
    output = capsys.readouterr()
    assert word in output.err
    assert "Traceback" not in output.err
    assert output.out == ""


def test_an_inverted_mesh_is_repaired(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    save_tube(folder / "tube.stl", invert=True)
    assert main(("check", "tube.stl", "--unit", "mm")) == 0
    assert "repaired" in capsys.readouterr().out
    assert main(("check", "scenario.toml")) == 0


class FullDisk(BytesIO):
    """A file on a disk that has no room left."""

    def write(self, _: object) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")


def test_a_disk_that_is_full_from_the_start(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(writer, "_create", lambda path: FullDisk())
    assert main(("run", "scenario.toml", "--out", "out")) == BAD_INPUT
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert "run.mcap" in message
    assert "no space left" in message
    assert not (folder / "out").exists()


@contextmanager
def largest_file(size: int) -> Iterator[None]:
    """Let the system refuse files above a size [bytes], as a full disk would."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_a_disk_that_fills_up_keeps_what_was_recorded(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    argv = ("run", "scenario.toml", "--out", "out", "--set", "path.max_steps=300")
    argv = (*argv, "path.waypoints_mm=[[0, 0, 210], [0, 0, 200], [0, 0, 210], [0, 0, 200]]")
    assert main(("run", "scenario.toml", "--out", "whole")) == 0  # everything is compiled
    size = (folder / "whole" / "run.mcap").stat().st_size
    capsys.readouterr()
    with largest_file(3 * size):
        assert main(argv) == BAD_INPUT
    output = capsys.readouterr()
    assert output.err.count("\n") == 1
    assert "out/run.mcap" in output.err
    assert sorted(path.name for path in (folder / "out").iterdir()) == ["run.mcap"]
    assert main(("check", "out/run.mcap")) == 0
    assert "it was cut off" in capsys.readouterr().out
