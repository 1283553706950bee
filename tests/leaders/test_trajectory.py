"""Recorded hands: through every row, never beyond, gently."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from sinuous.errors import InputError
from sinuous.leaders import Trajectory

steps = st.lists(
    st.tuples(st.floats(0.01, 1.0), *[st.floats(-0.1, 0.1)] * 3), min_size=2, max_size=12
)


@example([(1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 5e-324)])
@given(steps)
def test_it_goes_through_every_row_and_stays_between_them(rows: list[tuple[float, ...]]) -> None:
    table = np.array(rows)
    times, places = np.cumsum(table[:, 0]), table[:, 1:]
    with Trajectory(times, places) as trajectory:
        for k in range(len(times) - 1):
            for s in (0.0, 0.3, 0.8):
                t = (1.0 - s) * times[k] + s * times[k + 1]
                place = trajectory.read(t - times[0]).position + places[0]
                low, high = np.sort(places[k : k + 2], axis=0)
                assert np.all(place >= low - 1e-12)
                assert np.all(place <= high + 1e-12)
        end = trajectory.read(times[-1] - times[0] + 1.0)
    np.testing.assert_allclose(end.position + places[0], places[-1], atol=1e-12)


def test_a_straight_line_is_straight_and_begins_at_the_first_reading() -> None:
    trajectory = Trajectory([0.0, 1.0, 2.0], [[0.1, 0.0, 0.0], [0.2, 0.0, 0.0], [0.3, 0.0, 0.0]])
    np.testing.assert_array_equal(trajectory.read(5.0).position, np.zeros(3))
    np.testing.assert_allclose(trajectory.read(5.7).position, [0.07, 0.0, 0.0], atol=1e-12)
    assert trajectory.duration == 2.0
    trajectory.open()
    np.testing.assert_array_equal(trajectory.read(9.0).position, np.zeros(3))


def test_a_file_is_read_in_its_units(tmp_path: Path) -> None:
    file = tmp_path / "hand.csv"
    file.write_text("t_s,x_mm,y_mm,z_mm\n0,5,0,0\n0.5,15,1,-2\n1,25,2,-4\n")
    trajectory = Trajectory.load(file)
    trajectory.read(0.0)
    np.testing.assert_allclose(trajectory.read(0.5).position, [0.01, 0.001, -0.002], atol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t_s,x_mm,y_mm,z_mm\n0,0,0,0\n", "two rows of numbers or more, found one"),
        ("t_s,x_mm,y_mm,z_mm\n0,0,0,0\n0,1,1,1\n", "a time after the one before"),
        ("t_s,x_mm,y_mm\n0,0,0\n", "one column z_mm"),
        ("t_s,x_mm,y_mm,z_mm\n0,0,0,0\n1,nan,1,1\n", "a finite number"),
    ],
)
def test_a_bad_file_is_named(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "hand.csv"
    file.write_text(text)
    with pytest.raises(InputError, match=message) as error:
        Trajectory.load(file)
    assert "hand.csv" in str(error.value)


def test_arrays_that_do_not_fit_are_refused() -> None:
    with pytest.raises(ValueError, match="two or more"):
        Trajectory([0.0, 1.0], [[0.0, 0.0], [1.0, 1.0]])
    with pytest.raises(ValueError, match="times that increase"):
        Trajectory([0.0, 0.0], np.zeros((2, 3)))
