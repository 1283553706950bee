"""(22), and three axes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from sinuous.teleop.mapping import Mapping

ROUNDING = 1e-13  # [m]
NUMBER = st.floats(-1.0, 1.0)


def test_the_plane_is_22_as_printed() -> None:
    k_x, k_y, y0 = 2.0, 3.0, 0.62
    mapping, x_m, y_m = Mapping.plane((k_x, k_y), y0), 0.03, -0.05
    printed = np.array([[k_x, 0, 0], [0, 0, 0], [0, k_y, 0]]) @ [x_m, y_m, 0.4] + [0, y0, 0]
    X = mapping.scale * np.array([x_m, y_m])
    np.testing.assert_allclose(mapping.place(X), printed, rtol=0, atol=ROUNDING)


def test_what_is_off_the_plane_is_dropped() -> None:
    mapping = Mapping.plane(2.25, y0=0.6)
    np.testing.assert_allclose(mapping.project([0.1, 0.9, -0.2]), [0.1, -0.2], atol=ROUNDING)
    assert mapping.place(mapping.project([0.1, 0.9, -0.2]))[1] == 0.6


@given(vector=st.tuples(NUMBER, NUMBER, NUMBER), place=st.tuples(NUMBER, NUMBER, NUMBER))
def test_space_there_and_back(
    vector: tuple[float, float, float], place: tuple[float, float, float]
) -> None:
    turned = Rotation.from_rotvec(vector).as_matrix()
    mapping = Mapping.space(1.5, origin=(0.1, 0.2, 0.3), rotation=turned)
    np.testing.assert_allclose(mapping.place(mapping.project(place)), place, atol=ROUNDING)
    np.testing.assert_allclose(
        mapping.place(np.array(place)), turned @ place + [0.1, 0.2, 0.3], atol=ROUNDING
    )


def test_a_distance_is_kept_on_the_way_to_the_world() -> None:
    """Wave-side coordinates are metres of the follower: power is the same in both."""
    mapping = Mapping.space((1.0, 2.0, 3.0), origin=(0, 0, 0), rotation=np.eye(3)[[2, 0, 1]])
    a, b = np.array([0.1, 0.2, -0.3]), np.array([-0.2, 0.05, 0.1])
    apart = np.linalg.norm(mapping.place(a) - mapping.place(b))
    assert apart == pytest.approx(np.linalg.norm(a - b))


@pytest.mark.parametrize(
    ("broken", "says"),
    [
        ({"scale": (0.0, 1.0)}, "scale must be positive"),
        ({"scale": (np.nan, 1.0)}, "scale must be a vector of finite"),
        ({"origin": (0.0, np.inf, 0.0)}, "origin must be a vector of finite"),
        ({"origin": (0.0, 0.0)}, r"origin \(3,\)"),
        ({"axes": np.eye(3)}, r"axes must be \(3, 2\)"),
        ({"axes": np.ones((3, 2))}, "orthogonal unit"),
        ({"axes": 2.0 * np.eye(3)[:, :2]}, "orthogonal unit"),
    ],
)
def test_mappings_that_make_no_sense(broken: dict[str, object], says: str) -> None:
    good = {"scale": (1.0, 1.0), "axes": np.eye(3)[:, :2], "origin": np.zeros(3)}
    with pytest.raises(ValueError, match=says):
        Mapping(**good | broken)  # type: ignore[arg-type]


def test_a_point_has_three_numbers() -> None:
    with pytest.raises(ValueError, match="three numbers"):
        Mapping.plane(1.0, y0=0.0).project([0.0, 0.0])
