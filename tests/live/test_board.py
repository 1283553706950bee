"""Memory that two processes share: whole rows or none."""

import threading
from pathlib import Path

import numpy as np
import pytest

from sinuous.live.board import Board, Ring, encoded
from sinuous.live.layout import TEXT, TIPS, WALLS, Part, Sizes
from sinuous.teleop.motion import Plane, Walls

SIZES = Sizes(configuration=3, actuators=4, points=5, signals=2)


def ring(capacity: int) -> Ring:
    rows = np.zeros(capacity, dtype=[("number", "i8"), ("a", "f8", (50,)), ("b", "f8", (50,))])
    rows["number"] = -1
    return Ring(rows, np.zeros(1, dtype=np.int64))


def test_the_newest_rows_are_there() -> None:
    table = ring(4)
    assert table.read(0) is None
    for k in range(10):
        table.write(a=float(k), b=-float(k))
    assert table.written == 10
    assert [table.read(k) is None for k in range(11)] == [True] * 6 + [False] * 4 + [True]
    row = table.read(7)
    assert row is not None
    assert np.all(row["a"] == 7.0)
    block = table.block(6, 4, "b")
    assert block is not None
    assert np.array_equal(block[:, 0], [-6.0, -7.0, -8.0, -9.0])
    assert table.block(5, 4, "b") is None
    assert table.block(8, 4, "b") is None
    assert table.read(-1) is None


def test_no_row_is_ever_half_of_one_and_half_of_another() -> None:
    table, stop = ring(2), threading.Event()

    def write() -> None:
        k = 0
        while not stop.is_set():
            table.write(a=float(k), b=float(k))
            k += 1

    thread = threading.Thread(target=write)
    thread.start()
    whole = 0
    try:
        while whole < 2000:
            number = table.written - 1
            row = table.read(number)
            if row is not None:
                assert np.all(row["a"] == number)
                assert np.all(row["b"] == number)
                whole += 1
    finally:
        stop.set()
        thread.join()


def test_memory_is_shared_and_given_back() -> None:
    board = Board.create(SIZES)
    name = board.name
    other = Board.attach(SIZES, name)
    other.put("slipped", 0.25)
    other.ready(Part.HAND)
    assert board.get("slipped") == 0.25
    assert not board.all_ready
    board.ready(Part.ROBOT)
    assert other.all_ready
    other.fail(Part.ROBOT, "the robot's side: no more")
    assert board.fault == "the robot's side: no more"
    other.close()
    board.close()
    board.unlink()
    assert not Path("/dev/shm", name).exists()
    with pytest.raises(FileNotFoundError):
        Board.attach(SIZES, name)


def test_tips_and_walls_are_found_by_their_tick() -> None:
    board, rng = Board.alone(SIZES), np.random.default_rng(0)
    tips, planes = rng.normal(size=(3 * TIPS, 3)), rng.normal(size=(3 * TIPS, *WALLS))
    for first in range(0, len(tips), 10):
        held, near = planes[first]
        board.tell_tips(tips[first : first + 10], Walls(Plane(*held), Plane(*near)))
        assert np.array_equal(np.array(board.walls(first)), planes[first])
        told = board.get("tips")
        assert np.array_equal(board.tip(told - 1), tips[told - 1])
        assert np.array_equal(board.tip(max(told - 50, 0)), tips[max(told - 50, 0)])


def test_long_texts_are_cut_between_letters() -> None:
    text = "ü" * TEXT
    assert encoded(text).decode() == "ü" * ((TEXT - 1) // 2)
