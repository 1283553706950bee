"""Reports as 3Dconnexion devices send them, byte by byte, and a device that is pulled out."""

import queue

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.errors import InputError
from sinuous.leaders import Hand, Rates, SpaceMouse
from sinuous.leaders.spacemouse import MULTI_AXIS, deflection_in, find_spacemouse

from .eventually import eventually

# Captured from a SpaceMouse Compact, whose cap was pushed down and turned, and published in
# CloudCompare's pull request 2339.
COMPACT = """
02 20 00 00 00 17 00
01 12 00 00 00 f8 00
02 20 00 00 00 19 00
01 12 00 00 00 12 01
02 1d 00 00 00 1b 00
01 0d 00 00 00 25 01
"""

# Captured from a SpaceNavigator and published in AndunHH/spacemouse, SpaceNavigator.md: a turn, and
# both buttons pressed and released.
NAVIGATOR = """
01 00 00 00 00 00 00
02 00 00 e2 ff 00 00
03 01 00
03 00 00
03 02 00
03 03 00
"""

# As a SpaceMouse Wireless sends: translation and rotation in one report, and its battery.
WIRELESS = """
01 5e 01 a2 fe 00 00 05 00 fb ff 00 00
17 64
"""

DT = 0.001


def reports(text: str) -> list[bytes]:
    return [bytes.fromhex(line) for line in text.split("\n") if line]


class Plug:
    """The end of the cable: what a device of hidapi gives of the reports that are sent."""

    def __init__(self) -> None:
        self.reports, self.pulled, self.closed = queue.Queue[bytes](), False, False

    def read(self, max_length: int, timeout_ms: int, /) -> list[int]:
        if self.pulled:
            raise OSError("read error")
        try:
            return list(self.reports.get(timeout=0.005))[:max_length]
        except queue.Empty:
            return []

    def close(self) -> None:
        self.closed = True


@pytest.fixture
def plug() -> Plug:
    return Plug()


def run(mouse: SpaceMouse, since: float, seconds: float) -> Hand:
    """The hand after some time."""
    for k in range(round(seconds / DT) + 1):
        hand = mouse.read(since + k * DT)
    return hand


def test_captured_translations() -> None:
    """Pushed right and down: the device counts 0x12 along x, up to 0x125 along z, downwards."""
    found = [deflection_in(report) for report in reports(COMPACT)]
    assert found[::2] == [None, None, None]
    translations = np.array(found[1::2], dtype=np.float64) * 350.0
    np.testing.assert_allclose(translations, [[18, 0, -248], [18, 0, -274], [13, 0, -293]])


def test_captured_rest_turn_and_buttons_push_nothing() -> None:
    rest, *others = reports(NAVIGATOR)
    np.testing.assert_array_equal(deflection_in(rest), np.zeros(3))
    assert [deflection_in(report) for report in others] == [None] * len(others)


def test_the_combined_report_begins_with_the_translation() -> None:
    combined, battery = reports(WIRELESS)
    assert len(combined) == 13
    np.testing.assert_allclose(deflection_in(combined), [1.0, 1.0, 0.0])
    assert deflection_in(battery) is None


@given(st.tuples(*[st.integers(-(2**15), 2**15 - 1)] * 6))
def test_both_layouts_say_the_same(counts: tuple[int, ...]) -> None:
    numbers = np.array(counts, dtype="<i2")
    combined = bytes([1]) + numbers.tobytes()
    translation = bytes([1]) + numbers[:3].tobytes()
    one, other = deflection_in(combined), deflection_in(translation)
    assert one is not None
    np.testing.assert_array_equal(one, other)
    x, y, z = counts[:3]
    np.testing.assert_allclose(one, np.clip(np.array([x, -y, -z]) / 350.0, -1.0, 1.0))


@given(st.binary(max_size=20))
def test_no_report_is_ever_refused(report: bytes) -> None:
    found = deflection_in(report)
    assert found is None or np.all(np.abs(found) <= 1.0)


def test_a_push_moves_the_hand_until_it_is_let_go(plug: Plug) -> None:
    rates = Rates(speed=0.03)
    with SpaceMouse(rates, find=lambda: plug) as mouse:
        assert run(mouse, 0.0, 0.01).connected
        plug.reports.put(bytes.fromhex("01 00 00 00 00 5e 01"))  # down, as far as it goes
        assert eventually(lambda: mouse.read(0.01).age == 0.0 and moving(mouse))
        down = run(mouse, 0.02, 0.1)
        assert down.position[2] < 0.0
        assert np.all(down.position[:2] == 0.0)
        plug.reports.put(bytes([1]) + bytes(6))  # let go
        assert eventually(lambda: not moving(mouse))
        still = run(mouse, 0.5, 0.2)
        np.testing.assert_array_equal(run(mouse, 0.701, 0.2).position, still.position)
    assert plug.closed


def moving(mouse: SpaceMouse) -> bool:
    said = mouse._reader.latest.said
    return said is not None and bool(np.any(said != 0.0))


def test_a_push_that_is_not_repeated_ends(plug: Plug) -> None:
    with SpaceMouse(find=lambda: plug) as mouse:
        plug.reports.put(reports(COMPACT)[-1])
        assert eventually(lambda: moving(mouse))
        rest = run(mouse, 0.0, 0.5)
        assert np.linalg.norm(rest.position) > 0.0
        np.testing.assert_array_equal(run(mouse, 0.501, 0.5).position, rest.position)


def test_pulled_out_it_holds_still_and_plugged_in_it_goes_on() -> None:
    plugs = [Plug(), Plug()]
    waiting = iter(plugs)

    def find() -> Plug:
        if (plug := next(waiting, None)) is None:
            raise InputError(file="leader", expected="a plug", found="none", remedy="Wait.")
        return plug

    mouse = SpaceMouse(find=find)
    mouse._reader._retry = 0.01
    with mouse:
        plugs[0].reports.put(reports(COMPACT)[-1])
        assert eventually(lambda: moving(mouse))
        before = run(mouse, 0.0, 0.1)
        plugs[0].pulled = True
        assert eventually(lambda: plugs[0].closed)
        after = mouse.read(0.101)
        assert np.linalg.norm(after.position - before.position) <= 0.03 * DT
        assert eventually(lambda: mouse.read(0.102).connected)
        rest = run(mouse, 0.103, 0.2)
        np.testing.assert_array_equal(rest.position, after.position)
        plugs[1].reports.put(reports(COMPACT)[-1])
        assert eventually(lambda: moving(mouse))
        assert run(mouse, 0.304, 0.1).position[2] < rest.position[2]


class Usb:
    """The package hidapi on a machine with some devices."""

    def __init__(self, devices: list[dict[str, object]], *, may_open: bool = True) -> None:
        self._devices, self._may_open = devices, may_open

    def enumerate(self, vendor: int, product: int) -> list[dict[str, object]]:
        return [d for d in self._devices if vendor in (0, d["vendor_id"])]

    def device(self) -> "Usb":
        return self

    def open_path(self, path: bytes) -> None:
        if not self._may_open:
            raise OSError("open failed")
        self.opened = path


def entry(path: bytes, vendor: int, page: int, usage: int) -> dict[str, object]:
    return {
        "path": path,
        "vendor_id": vendor,
        "usage_page": page,
        "usage": usage,
        "product_string": "SpaceMouse",
    }


@pytest.fixture
def usb(monkeypatch: pytest.MonkeyPatch) -> list[Usb]:
    """A place to plug a `Usb` in."""
    found = list[Usb]()
    monkeypatch.setattr("sinuous.leaders.spacemouse.require", lambda *_, **__: found[0])
    return found


def test_of_all_interfaces_the_multi_axis_one_is_opened(usb: list[Usb]) -> None:
    usb.append(
        Usb(
            [
                entry(b"mouse", 0x046D, 0x01, 0x02),
                entry(b"receiver, keyboard", 0x256F, 0x01, 0x06),
                entry(b"receiver, cap", 0x256F, *MULTI_AXIS),
                entry(b"stick of another maker", 0x1234, *MULTI_AXIS),
            ]
        )
    )
    find_spacemouse()
    assert usb[0].opened == b"receiver, cap"


def test_what_may_not_be_opened_names_the_remedy(usb: list[Usb]) -> None:
    usb.append(Usb([entry(b"cap", 0x256F, *MULTI_AXIS)], may_open=False))
    with pytest.raises(InputError, match="udev rule"):
        SpaceMouse().open()


def test_without_a_device_the_message_says_so() -> None:
    """With hidapi itself, on a machine that has none."""
    with pytest.raises(InputError, match="found no 3Dconnexion device"):
        SpaceMouse().open()
