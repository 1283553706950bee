"""Columns of numbers with units: any order, any unit, and words for what is wrong."""

import numpy as np
import pytest

from sinuous.csv_table import read_columns
from sinuous.errors import InputError
from sinuous.files import Quantity

COLUMNS = {"t": Quantity.DURATION, "x": Quantity.LENGTH, "bend": Quantity.ANGLE}


def read(text: str) -> dict[str, np.ndarray]:
    return read_columns(text, file="run.csv", columns=COLUMNS, example="t_s,x_mm,bend_deg")


def test_columns_in_any_order_and_unit_are_si() -> None:
    found = read("note,bend_deg, x_cm ,t_ms\nhello,180,1.5,0\n\n,90,-2,500\n")
    np.testing.assert_array_equal(found["t"], [0.0, 0.5])
    np.testing.assert_array_equal(found["x"], [0.015, -0.02])
    np.testing.assert_allclose(found["bend"], [np.pi, np.pi / 2], rtol=1e-15)


@pytest.mark.parametrize(
    ("text", "field", "expected", "found"),
    [
        ("", "", "a header and rows", "an empty file"),
        ("t_s,x_mm,bend_deg", "", "at least one row", "only a header"),
        ("t_s,x,bend_deg\n0,1,2", "row 1", "x_mm", "t_s, x, bend_deg"),
        ("t_s,x_mm,x_m,bend_deg\n0,1,2,3", "row 1", "one column x_mm", "x_m"),
        ("t_s,x_mm,bend_deg\n0,1,2\n1,two,3", "row 3, column x_mm", "a number", '"two"'),
        ("t_s,x_mm,bend_deg\n0,1", "row 2, column bend_deg", "a number", "nothing"),
        ("t_s,x_mm,bend_deg\n0,inf,2", "row 2, column x_mm", "a finite number", "inf"),
        ("t_s,x_mm,bend_deg\n1,0,0\n1,0,0", "row 3, column t_s", "a time after", "1"),
    ],
)
def test_what_is_wrong_is_named(text: str, field: str, expected: str, found: str) -> None:
    with pytest.raises(InputError) as error:
        read(text)
    assert (error.value.file, error.value.field) == ("run.csv", field)
    assert expected in error.value.expected
    assert found in error.value.found
    assert error.value.remedy.endswith(".")
