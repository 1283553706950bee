"""The thread that waits for devices, and what every leader has in common."""

import sys
import threading
from collections.abc import Callable

import numpy as np
import pytest

from sinuous.errors import InputError
from sinuous.leaders import Gamepad, Haply, Leader, SpaceMouse, Trajectory
from sinuous.leaders.freshness import Freshness
from sinuous.leaders.reader import Reader
from sinuous.leaders.spacemouse import MODULE

from .eventually import eventually


class Counting:
    """A line that counts, and is lost after so many."""

    def __init__(self, until: int) -> None:
        self._until, self._count, self.closed = until, 0, False

    def wait(self) -> int | None:
        if self._count == self._until:
            raise OSError("gone")
        self._count += 1
        return self._count

    def close(self) -> None:
        self.closed = True


def absent() -> Counting:
    raise InputError(file="leader", expected="a device", found="none", remedy="Plug it in.")


def test_what_connecting_says_is_raised_where_it_was_opened() -> None:
    reader = Reader(absent, name="reader of the test")
    with pytest.raises(InputError, match="Plug it in"):
        reader.open()
    assert "reader of the test" not in {thread.name for thread in threading.enumerate()}


def test_numbers_go_on_over_losses_and_every_line_is_closed() -> None:
    lines = [Counting(3), Counting(2)]
    waiting = iter(lines)

    def connect() -> Counting:
        return next(waiting, None) or absent()

    reader = Reader(connect, name="reader of the test", retry=0.001)
    reader.open()
    assert eventually(lambda: reader.latest.number == 5 and not reader.latest.connected)
    assert reader.latest.said is None, "what a lost device has said is still believed"
    reader.close()
    assert all(line.closed for line in lines)


def test_a_closed_reader_has_no_thread_and_opens_again() -> None:
    made = list[Counting]()

    def connect() -> Counting:
        made.append(Counting(10**9))
        return made[-1]

    reader = Reader(connect, name="reader of the test")
    for k in range(2):
        reader.open()
        assert eventually(lambda: reader.latest.connected)
        reader.close()
        assert made[k].closed
        assert not reader.latest.connected
    assert "reader of the test" not in {thread.name for thread in threading.enumerate()}


def test_age_counts_from_when_something_new_was_seen() -> None:
    freshness = Freshness()
    assert [freshness.age(number, time) for number, time in [(0, 5.0), (0, 5.5), (3, 6.0)]] == [
        0.0,
        0.5,
        0.0,
    ]


@pytest.mark.parametrize(
    ("module", "package", "build"),
    [
        (MODULE, "hidapi", SpaceMouse),
        ("sdl2", "pysdl2", Gamepad),
        ("websockets.sync.client", "websockets", Haply),
    ],
)
def test_a_package_that_is_missing_names_the_extra(
    monkeypatch: pytest.MonkeyPatch, module: str, package: str, build: Callable[[], Leader]
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(InputError, match=rf"the package {package}.*pip install sinuous\["):
        build().open()


def test_leaders_without_force_feel_nothing() -> None:
    with Trajectory([0.0, 1.0], np.zeros((2, 3))) as trajectory:
        trajectory.feel(np.ones(3))
