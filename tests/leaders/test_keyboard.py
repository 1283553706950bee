"""Keys of a page: directions, ramps, order of arrival, a page that is lost."""

from itertools import permutations

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.leaders import Hand, Keyboard, Rates

DT = 0.001
RATES = Rates(speed=0.02, acceleration=0.2)


def run(keyboard: Keyboard, since: float, seconds: float) -> Hand:
    """The hand after some time."""
    for k in range(round(seconds / DT) + 1):
        hand = keyboard.read(since + k * DT)
    return hand


@pytest.mark.parametrize(
    ("key", "direction"),
    [
        ("ArrowRight", [1, 0, 0]),
        ("ArrowLeft", [-1, 0, 0]),
        ("ArrowUp", [0, 1, 0]),
        ("ArrowDown", [0, -1, 0]),
        ("PageUp", [0, 0, 1]),
        ("PageDown", [0, 0, -1]),
    ],
)
def test_each_key_moves_along_its_axis(key: str, direction: list[int]) -> None:
    with Keyboard(RATES) as keyboard:
        keyboard.press(key, 1.0)
        hand = run(keyboard, 0.0, 1.0)
    # 0.1 s of ramp cost half of its way.
    np.testing.assert_allclose(hand.position, 0.02 * 0.95 * np.array(direction), atol=1e-9)


def test_letting_go_comes_to_rest() -> None:
    keyboard = Keyboard(RATES)
    keyboard.press("ArrowUp", 1.0)
    run(keyboard, 0.0, 0.5)
    keyboard.release("ArrowUp", 2.0)
    after = run(keyboard, 0.501, 0.2)
    assert after.connected
    np.testing.assert_array_equal(run(keyboard, 0.702, 0.5).position, after.position)


def test_opposite_keys_rest_and_two_axes_add_up() -> None:
    keyboard = Keyboard(RATES)
    keyboard.press("ArrowLeft", 1.0)
    keyboard.press("ArrowRight", 1.0)
    np.testing.assert_array_equal(run(keyboard, 0.0, 0.5).position, np.zeros(3))
    keyboard.release("ArrowLeft", 2.0)
    keyboard.press("PageDown", 2.0)
    x, y, z = run(keyboard, 0.501, 0.5).position
    assert (x, y) == (pytest.approx(-z), 0.0)


def test_the_order_of_arrival_does_not_matter() -> None:
    events = [
        ("press", "ArrowUp", 1.0),
        ("release", "ArrowUp", 2.0),
        ("press", "ArrowUp", 3.0),
        ("press", "PageUp", 1.5),
        ("release", "PageUp", 2.5),
    ]
    ends = set[tuple[float, ...]]()
    for order in permutations(events):
        keyboard = Keyboard(RATES)
        for name, key, stamp in order:
            getattr(keyboard, name)(key, stamp)
        ends.add(tuple(run(keyboard, 0.0, 0.05).position.tolist()))
    ((x, y, z),) = ends
    assert y > 0.0
    assert (x, z) == (0.0, 0.0)


def test_a_page_that_loses_the_focus_releases_all_keys() -> None:
    keyboard = Keyboard(RATES)
    keyboard.press("ArrowUp", 1.0)
    keyboard.press("PageUp", 1.0)
    run(keyboard, 0.0, 0.3)
    keyboard.release_all(2.0)
    rest = run(keyboard, 0.301, 0.2)
    np.testing.assert_array_equal(run(keyboard, 0.502, 0.2).position, rest.position)


def test_a_lost_page_stops_at_once_and_its_next_key_brings_it_back() -> None:
    keyboard = Keyboard(RATES)
    keyboard.press("ArrowUp", 1.0)
    moving = run(keyboard, 0.0, 0.3)
    keyboard.lost()
    hand = run(keyboard, 0.301, 0.3)
    assert not hand.connected
    np.testing.assert_array_equal(hand.position, moving.position)
    keyboard.press("ArrowRight", 2.0)
    hand = run(keyboard, 0.602, 0.3)
    assert hand.connected
    assert hand.position[1] == moving.position[1], "the key of before is still down"
    assert hand.position[0] > 0.0


def test_a_pause_of_the_session_is_no_motion() -> None:
    keyboard = Keyboard(RATES)
    keyboard.press("ArrowUp", 1.0)
    before = run(keyboard, 0.0, 0.3).position
    after = keyboard.read(60.0).position
    way: Array = after - before
    assert np.linalg.norm(way) <= 0.02 * 0.05 + 1e-12


def test_other_keys_do_nothing() -> None:
    keyboard = Keyboard(RATES)
    keyboard.press("KeyQ", 1.0)
    np.testing.assert_array_equal(run(keyboard, 0.0, 0.3).position, np.zeros(3))
