from collections.abc import Callable, Generator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib import rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.image import imread
from mpl_toolkits.mplot3d.axes3d import Axes3D

from sinuous.recording import Recording
from sinuous.view import save_comparison, save_figures, style
from sinuous.view.comparison import effort
from sinuous.view.curves import way_point_switches, way_points
from sinuous.view.style import DPI

NAMES = ["shapes.png", "tip_error.png", "clearance.png", "rates.png", "solve_time.png"]
Simulate = Callable[..., Recording]


@dataclass(frozen=True)
class Drawn:
    """Figures that were written, and the files."""

    figures: list[Figure]
    files: list[Path]


@contextmanager
def keeping_figures() -> Generator[list[Figure]]:
    """Every figure that is written meanwhile."""
    figures: list[Figure] = []

    class Kept(Figure):
        def savefig(self, *args: Any, **kwargs: Any) -> None:
            figures.append(self)
            super().savefig(*args, **kwargs)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(style, "Figure", Kept)
        yield figures


@pytest.fixture(scope="module")
def drawn(run: Recording, tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """The figures of the run in the tube."""
    with keeping_figures() as figures:
        files = save_figures(run, tmp_path_factory.mktemp("run") / "new" / "figures")
    return Drawn(figures, files)


def visible_labels(axes: Axes) -> list[str]:
    labels = [axes.get_xlabel(), axes.get_ylabel()]
    if isinstance(axes, Axes3D):
        labels.append(axes.get_zlabel())
    return [label for label in labels if label]


def test_all_figures_are_written_with_units(drawn: Drawn) -> None:
    assert [file.name for file in drawn.files] == NAMES
    for file, figure in zip(drawn.files, drawn.figures, strict=True):
        height, width, _ = imread(file).shape
        assert (width, height) == pytest.approx(figure.get_size_inches() * DPI, abs=1)
        labels = [label for axes in figure.axes for label in visible_labels(axes)]
        assert labels
        assert all(label.endswith("]") for label in labels), labels


def test_scene_has_equal_scales(drawn: Drawn) -> None:
    axes: Any = drawn.figures[0].axes
    space, *planes = axes[:3]
    limits = np.array([space.get_xlim(), space.get_ylim(), space.get_zlim()])
    # There is no public way to read the box's sides back.
    scale = np.diff(limits)[:, 0] / np.asarray(space._box_aspect)
    assert scale == pytest.approx(np.full(3, scale[0]))
    assert all(plane.get_aspect() == 1.0 for plane in planes)


def test_violations_are_counted_in_the_legend(run: Recording, drawn: Drawn) -> None:
    (axes,) = drawn.figures[NAMES.index("clearance.png")].axes
    count = int(np.count_nonzero(run.nominal_clearance < run.header.margin - 1e-9))
    assert count > 0
    assert f"margin violated ({count} steps)" in axes.get_legend_handles_labels()[1]


@pytest.mark.parametrize(("steps", "walls"), [(0, True), (1, True), (2, False)])
def test_short_runs_leave_no_trace(
    simulated: Simulate, tmp_path: Path, steps: int, walls: bool
) -> None:
    before = dict(rcParams)
    files = save_figures(simulated(seed=3, steps=steps, walls=walls), tmp_path)
    assert all(file.stat().st_size > 0 for file in files)
    assert dict(rcParams) == before


def test_free_space_says_so(simulated: Simulate, tmp_path: Path) -> None:
    with keeping_figures() as figures:
        save_figures(simulated(seed=3, steps=20, walls=False, moving=True), tmp_path)
    (axes,) = figures[NAMES.index("clearance.png")].axes
    assert [text.get_text() for text in axes.texts] == ["no wall: clearance is unlimited"]
    assert not axes.lines


def test_way_points_are_found_only_where_the_target_jumps(simulated: Simulate) -> None:
    jumping = simulated(seed=1, steps=30)
    assert list(way_point_switches(jumping)) == [10, 20]
    assert np.array_equal(way_points(jumping), jumping.target[[0, 10, 20]])
    moving = simulated(seed=1, steps=30, moving=True)
    assert len(way_point_switches(moving)) == 0
    assert len(way_points(moving)) == 0


def test_rates_have_one_panel_per_kind(run: Recording, drawn: Drawn) -> None:
    panels: Any = drawn.figures[NAMES.index("rates.png")].axes
    kinds = ["cable", "backbone", "insertion"]
    assert [axes.get_ylabel() for axes in panels] == [f"{kind} rate [mm/s]" for kind in kinds]
    for axes, limit in zip(panels, (20.0, 10.0, 15.0), strict=True):
        heights = [list(line.get_ydata()) for line in axes.lines if len(line.get_ydata()) == 2]
        assert [-limit, -limit] in heights
        assert [limit, limit] in heights
    keys = [[text.get_text() for text in axes.get_legend().get_texts()] for axes in panels]
    cables = ["cable 1", "cable 2", "cable 3"]
    assert keys[0] == ["segment 1", "segment 2", *cables, "limit"]
    assert keys[1] == ["segment 1", "segment 2", "limit"]
    assert keys[2] == ["insertion", "limit"]
    curves = [line for line in panels[0].lines if len(line.get_ydata()) == len(run)]
    # There is no public way to read a line's own dashes back.
    looks = {(str(c.get_color()), str(c._unscaled_dash_pattern)) for c in curves}
    assert len(looks) == len(curves) == 6


def test_steps_that_take_longer_than_the_period_are_counted(run: Recording, tmp_path: Path) -> None:
    late = replace(run, solve_time=np.where(np.arange(len(run)) < 7, 1.0, 1e-3))
    with keeping_figures() as figures:
        save_figures(late, tmp_path)
    labels = figures[NAMES.index("solve_time.png")].axes[0].get_legend_handles_labels()[1]
    period = f"control period: {1e3 * run.header.dt:.3g} ms"
    assert [f"in time ({len(run) - 7} steps)", "late (7 steps)", period] == labels[:3]


def test_effort_is_a_share_of_the_limits(run: Recording) -> None:
    values = effort(run)
    by_hand = np.mean(np.abs(run.rates) / run.header.rate_limits[:, 1], axis=1)
    assert values == pytest.approx(by_hand)
    assert values.max() <= 1.0


@pytest.mark.parametrize("steps", [(60, 50), (60, 0)])
def test_comparison(simulated: Simulate, tmp_path: Path, steps: tuple[int, int]) -> None:
    a, b = (simulated(seed=i, steps=n) for i, n in enumerate(steps))
    with keeping_figures() as figures:
        (file,) = save_comparison(a, b, tmp_path / "out", labels=("before", "after"))
    assert file.name == "comparison.png"
    assert file.stat().st_size > 0
    (figure,) = figures
    texts = [cell.get_text().get_text() for cell in figure.axes[-1].tables[0].get_celld().values()]
    assert {"before", "after", "tip error, RMS"} <= set(texts)
    labels = [label for axes in figure.axes for label in visible_labels(axes)]
    assert all(label.endswith("]") for label in labels)
