"""Recordings on a page: moments, the file, the command line, and a browser."""

import shutil
from collections.abc import Generator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from sinuous.cli.codes import BAD_INPUT, GOOD
from sinuous.cli.main import main
from sinuous.errors import InputError
from sinuous.recording import Recorder, Recording, Sample
from sinuous.scenario import Scenario, load_scenario
from sinuous.session.header import make_header
from sinuous.view.page.recorded import Recorded
from sinuous.view.page.replay import FRAME, MOST_FRAMES, Replay, frames_of, status_line

SCENARIOS = Path(__file__).parents[3] / "examples" / "scenarios"
ROD, FREE = (load_scenario(SCENARIOS / f"{n}.toml") for n in ("live_watchdog", "free_space"))
CHROMIUM = shutil.which("chromium")
EXACT = 1e-9  # [m]


def sample(scenario: Scenario, k: int, period: float) -> Sample:
    """A robot that bends a little more at every step."""
    robot = scenario.robot
    c = scenario.first_configuration.copy()
    c[0] += 0.002 * k
    points, none = robot.points(c), np.zeros(len(robot.actuator_names))
    room = scenario.zone.clearance(points) - robot.radii
    clearance = float(np.min(room[robot.movable]))
    return Sample(
        time=k * period, target=points[-1] + 0.001,
        configuration=c, lengths=robot.lengths(c), rates=none, nominal_points=points,
        nominal_tip=points[-1], nominal_clearance=clearance,
        local_rates=none, clipped=0.0, offset=np.zeros(3),
        measured_points=points, measured_tip=points[-1], measured_lengths=robot.lengths(c),
        actual_points=points, actual_tip=points[-1], actual_clearance=clearance,
        status="tracking", solve_time=1e-3, iterations=1, planes=0, step_fraction=1.0,
        active=("a wall", "a cable", "another"),
    )  # fmt: skip


def made(scenario: Scenario, steps: int, period: float = 0.02) -> Recording:
    samples = [sample(scenario, k, period) for k in range(steps)]
    return Recording.from_samples(make_header(scenario), samples)


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short recording."""
    path = tmp_path_factory.mktemp("run") / "run.mcap"
    with Recorder(path, make_header(ROD)) as recorder:
        for k in range(60):
            recorder.write(sample(ROD, k, 0.02))
    return path


def test_a_moment_has_the_nearest_point_of_the_walls() -> None:
    recording = made(ROD, 5)
    moment = Recorded.of(recording, file="run.mcap").moment(4)
    near = ROD.zone.nearest(recording.actual_points[4])
    nearest = int(np.argmin(near.clearance - ROD.robot.radii))
    assert moment.nearest == nearest
    assert np.allclose(moment.wall, near.foot[nearest], atol=EXACT)
    apart = float(np.linalg.norm(moment.wall - moment.actual[nearest]))
    assert apart - ROD.robot.radii[nearest] == pytest.approx(moment.clearance, abs=EXACT)


def test_the_robot_stands_where_it_stood() -> None:
    recorded = Recorded.of(made(ROD, 2), file="run.mcap")
    points = recorded.robot.points(recorded.recording.configuration[1])
    assert np.allclose(points, recorded.recording.nominal_points[1], atol=EXACT)


def test_free_space_has_no_walls() -> None:
    recorded = Recorded.of(made(FREE, 2), file="run.mcap")
    assert np.isinf(recorded.moment(1).clearance)
    assert "no walls" in status_line(recorded, 1)


def test_the_hand_feels_the_opposite_of_the_force_on_the_robot() -> None:
    recording = made(ROD, 3, ROD.controller.dt)
    names = ("virtual_n_x", "virtual_n_y", "virtual_n_z")
    header = replace(recording.header, signals=names, tick=recording.header.dt)
    signals = np.arange(9.0).reshape(3, 3)
    recorded = Recorded.of(replace(recording, header=header, signals=signals), file="run.mcap")
    assert np.allclose(recorded.forces[1], -signals[1])


def test_nothing_recorded_is_refused() -> None:
    with pytest.raises(InputError, match="a recording with steps"):
        Recorded.of(made(ROD, 0), file="run.mcap")


def test_what_was_built_in_python_is_refused() -> None:
    recording = made(ROD, 2)
    bare = replace(recording, header=replace(recording.header, robot="# built in Python\n"))
    with pytest.raises(InputError, match="texts of its robot"):
        Recorded.of(bare, file="run.mcap")


@pytest.mark.parametrize(("steps", "period"), [(1, 0.02), (100, 0.02), (100, 0.1), (90, 4.0)])
def test_frames_are_even_in_time_and_not_too_many(steps: int, period: float) -> None:
    recording = made(ROD, steps, period)
    chosen, every = frames_of(Recorded.of(recording, file="run.mcap"))
    assert every >= FRAME
    assert len(chosen) <= MOST_FRAMES
    assert chosen[0] == 0
    late = np.arange(len(chosen)) * every - recording.time[chosen]
    assert np.all((late > -EXACT) & (late < period + EXACT))
    assert recording.time[-1] - recording.time[chosen[-1]] < every + period


def test_status_says_what_limits_the_robot_and_that_a_recording_is_cut() -> None:
    recorded = Recorded.of(replace(made(ROD, 2), complete=False), file="run.mcap")
    line = status_line(recorded, 1)
    assert "tracking" in line
    assert "a wall; a cable and 1 more" in line
    assert "cut off" in line


def test_html_has_all_frames(
    file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "page.html"
    assert main(["replay", str(file.parent), "--html", str(out), "--port", "8730"]) == GOOD
    frames = int(59 * 0.02 / FRAME + 1e-9) + 1
    assert f"{frames} frames, 30 per second" in capsys.readouterr().out
    assert "__VISER_EMBED_DATA__" in out.read_text(encoding="utf-8")
    assert out.stat().st_size < 5_000_000


def test_it_ends_by_itself(file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--duration", "0.3", "--no-browser", "--port", "8740"]
    assert main(["replay", str(file), *options]) == GOOD
    assert "http://127.0.0.1:" in capsys.readouterr().out


@pytest.mark.parametrize(
    "bad", [["nothing.mcap"], [" "], ["x", "--duration", "0"], ["x", "--port", "0"]]
)
def test_bad_input_is_one_line(bad: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["replay", *bad]) == BAD_INPUT
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_a_step_shows_and_the_end_begins_again() -> None:
    with Replay(Recorded.of(made(ROD, 20), file="run.mcap"), port=8750) as replay:
        slider = replay._slider  # pyright: ignore[reportPrivateUsage]
        replay.show(7)
        assert slider.value == pytest.approx(0.14)
        replay.advance(0.1)
        assert slider.value == pytest.approx(0.24)
        replay.advance(1.0)
        assert slider.value == pytest.approx(0.0)


@pytest.fixture
def replayed() -> Generator[Replay]:
    """A page that stands still."""
    with Replay(Recorded.of(made(ROD, 20), file="run.mcap"), port=8760) as replay:
        yield replay


@pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium")
def test_a_browser_shows_it(replayed: Replay) -> None:
    sync_api = pytest.importorskip("playwright.sync_api")
    flags = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    with sync_api.sync_playwright() as browsers:
        browser = browsers.chromium.launch(executable_path=CHROMIUM, args=flags)
        page = browser.new_page(viewport={"width": 1000, "height": 700})
        page.goto(replayed.address)
        page.get_by_text("time [s]").first.wait_for(timeout=20_000)
        assert page.get_by_role("slider").count() >= 1
        canvas = page.locator("canvas").first
        canvas.wait_for(timeout=10_000)
        page.wait_for_timeout(3000)
        assert len(canvas.screenshot()) > 8000  # a blank one has 3 to 5 kB
        browser.close()
