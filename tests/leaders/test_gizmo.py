"""A target that a page drags: order of arrival, losses, smoothness at 1 kHz."""

from itertools import permutations
from threading import Thread

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.leaders import Gizmo, Smoothing

DT = 0.001


def settle(gizmo: Gizmo, since: float = 0.0, seconds: float = 1.0) -> Array:
    """Where the hand comes to rest."""
    for k in range(round(seconds / DT)):
        hand = gizmo.read(since + k * DT)
    return hand.position


def test_the_hand_goes_where_the_target_is() -> None:
    with Gizmo() as gizmo:
        np.testing.assert_array_equal(gizmo.read(0.0).position, np.zeros(3))
        gizmo.aim([0.01, -0.02, 0.03], stamp=1.0)
        np.testing.assert_allclose(settle(gizmo), [0.01, -0.02, 0.03], atol=1e-9)


def test_the_order_of_arrival_does_not_matter() -> None:
    sent = [(float(k), [0.01 * k, 0.0, -0.005 * k]) for k in range(1, 5)]
    for order in permutations(sent):
        gizmo = Gizmo()
        for stamp, target in order:
            gizmo.aim(target, stamp)
        np.testing.assert_allclose(settle(gizmo), [0.04, 0.0, -0.02], atol=1e-9)


def test_a_page_of_fifteen_targets_a_second_is_a_smooth_motion() -> None:
    gizmo, speed, interval = Gizmo(Smoothing(delay=0.04, speed=0.25)), 0.05, 1.0 / 15.0
    places, told = list[Array](), -1
    for k in range(2000):
        if int(k * DT / interval) > told:
            told = int(k * DT / interval)
            gizmo.aim([speed * told * interval, 0.0, 0.0], stamp=float(told))
        places.append(gizmo.read(k * DT).position)
    x = np.array(places)[:, 0]
    jumps = np.diff(x)
    assert np.max(jumps) < 0.25 * speed * interval, "steps of the page are seen in the motion"
    assert np.all(jumps >= 0.0)
    # A target that stays for an interval is half of it late, the filter adds its delay.
    late = np.mean(speed * DT * np.arange(1000, 2000) - x[1000:]) / speed
    assert late == pytest.approx(0.04 + interval / 2.0, abs=2.0 * DT)


def test_without_its_page_the_hand_holds_still_and_goes_on_with_it() -> None:
    gizmo = Gizmo()
    gizmo.aim([0.05, 0.0, 0.0], stamp=1.0)
    for k in range(100):
        moving = gizmo.read(k * DT)
    gizmo.lost()
    for k in range(100, 300):
        hand = gizmo.read(k * DT)
        assert not hand.connected
        assert not hand.held
        np.testing.assert_array_equal(hand.position, moving.position)
    gizmo.aim([0.06, 0.0, 0.0], stamp=2.0)
    hand = gizmo.read(0.3)
    assert hand.connected
    assert np.linalg.norm(hand.position - moving.position) <= 0.25 * DT
    np.testing.assert_allclose(settle(gizmo, 0.301), [0.06, 0.0, 0.0], atol=1e-9)


def test_age_is_that_of_the_newest_target() -> None:
    gizmo = Gizmo()
    gizmo.aim([0.0, 0.0, 0.0], stamp=1.0)
    assert gizmo.read(2.0).age == 0.0
    assert gizmo.read(2.25).age == pytest.approx(0.25)
    gizmo.aim([0.0, 0.0, 0.0], stamp=0.5)  # older: dropped
    assert gizmo.read(2.5).age == pytest.approx(0.5)
    gizmo.aim([0.0, 0.0, 0.0], stamp=2.0)
    assert gizmo.read(3.0).age == 0.0


def test_pages_in_other_threads_leave_the_latest_stamp() -> None:
    gizmo = Gizmo()

    def page(first: int) -> None:
        for stamp in range(first, 4000, 4):
            gizmo.aim([stamp * 1e-6, 0.0, 0.0], float(stamp))

    threads = [Thread(target=page, args=(first,)) for first in range(4)]
    for thread in threads:
        thread.start()
    for k in range(200):
        gizmo.read(k * DT)
    for thread in threads:
        thread.join()
    np.testing.assert_allclose(settle(gizmo, 1.0), [3999e-6, 0.0, 0.0], atol=1e-9)


@pytest.mark.parametrize("target", [[0.0, 0.0], [0.0, np.nan, 0.0], [[0.0, 0.0, 0.0]]])
def test_what_is_no_place_is_refused(target: object) -> None:
    with pytest.raises(ValueError, match="target must be three finite numbers"):
        Gizmo().aim(target, 1.0)
