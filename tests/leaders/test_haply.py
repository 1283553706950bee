"""The Inverse3 through a WebSocket and the JSON of its service."""

import contextlib
import json
import socket
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.leaders import Haply
from sinuous.leaders.clutch import Clutch
from sinuous.leaders.haply_messages import force_request, frame_in

from .eventually import eventually
from .haply_service import DEVICE, Service

NOTHING = np.zeros(3)


@pytest.fixture
def service() -> Iterator[Service]:
    with Service() as service:
        yield service


def haply(service: Service, **settings: float | bool) -> Haply:
    device = Haply(address=service.address, **settings)
    device._reader._retry = 0.02
    return device


def place(device: Haply, force: Array = NOTHING) -> Array:
    """Where the hand is, in a tick in which a force is felt."""
    device.feel(force)
    return device.read(0.0).position


def ready(device: Haply) -> bool:
    """Whether the device has said where it is."""
    device.feel(NOTHING)
    return device.read(0.0).held


def test_the_cursor_moves_the_hand_metre_by_metre(service: Service) -> None:
    with haply(service) as device:
        assert eventually(lambda: ready(device))
        np.testing.assert_array_equal(place(device), NOTHING)
        service.cursor = [0.03, -0.10, 0.14]
        moved = np.array([0.03, 0.02, -0.01])
        assert eventually(lambda: np.allclose(place(device), moved, atol=1e-12))


def test_the_first_message_says_who_we_are_and_which_axes(service: Service) -> None:
    with haply(service) as device:
        assert eventually(lambda: ready(device) and len(service.received) > 3)
    first, *others = service.received
    configure = first["session"]["configure"]
    assert configure == {"profile": {"name": "sinuous"}, "basis": {"permutation": "XYZ"}}
    assert all("session" not in message for message in others)
    assert all(message["inverse3"][0]["device_id"] == DEVICE for message in service.received)
    assert service.forces()[0] == [0.0, 0.0, 0.0]


def test_a_force_arrives_in_newtons_along_our_axes_and_is_cut(service: Service) -> None:
    with haply(service, strongest=2.0) as device:
        assert eventually(lambda: [0.5, -1.0, 1.5] in hear(device, service, [0.5, -1.0, 1.5]))
        assert eventually(lambda: [0.0, 0.0, -2.0] in hear(device, service, [0.0, 0.0, -9.0]))


def hear(device: Haply, service: Service, force: list[float]) -> list[list[float]]:
    """Forces that the service has heard of, after one more of ours."""
    device.feel(np.array(force))
    return service.forces()


@pytest.mark.parametrize("nonsense", [np.nan, np.inf])
def test_what_is_no_force_is_none(service: Service, nonsense: float) -> None:
    with haply(service) as device:
        assert eventually(lambda: [1.0, 0.0, 0.0] in hear(device, service, [1.0, 0.0, 0.0]))
        service.received.clear()
        assert eventually(lambda: [0.0, 0.0, 0.0] in hear(device, service, [nonsense, 0.0, 0.0]))
        assert np.all(np.isfinite(service.forces()))


def test_who_stops_telling_forces_lets_go(service: Service) -> None:
    with haply(service) as device:
        assert eventually(lambda: [1.0, 0.0, 0.0] in hear(device, service, [1.0, 0.0, 0.0]))
        assert eventually(lambda: service.forces()[-1] == [0.0, 0.0, 0.0])
        before = len(service.received)
        assert eventually(lambda: len(service.received) > before + 2), "it is asked no more"
        assert service.forces()[before:] == [[0.0, 0.0, 0.0]] * (len(service.forces()) - before)


def test_the_clutch_lets_the_device_go_elsewhere(service: Service) -> None:
    service.grip = True
    with haply(service, clutch=True) as device:
        assert eventually(lambda: ready(device))
        service.cursor = [0.05, -0.12, 0.15]
        assert eventually(lambda: np.allclose(place(device), [0.05, 0.0, 0.0]))
        service.grip = False
        assert eventually(lambda: not ready(device))
        service.cursor = [-0.05, 0.0, 0.0]
        before = len(service.received)
        assert eventually(lambda: bool(place(device).any()) and len(service.received) > before + 3)
        np.testing.assert_allclose(place(device), [0.05, 0.0, 0.0])
        service.grip = True
        assert eventually(lambda: ready(device))
        service.cursor = [-0.05, 0.01, 0.0]
        assert eventually(lambda: np.allclose(place(device), [0.05, 0.01, 0.0]))


def test_unplugged_it_holds_still_and_goes_on_from_there(service: Service) -> None:
    with haply(service) as device:
        assert eventually(lambda: ready(device))
        service.cursor = [0.0, -0.12, 0.20]
        assert eventually(lambda: np.allclose(place(device), [0.0, 0.0, 0.05]))
        service.plugged = False
        assert eventually(lambda: not device.read(0.0).connected)
        np.testing.assert_allclose(place(device), [0.0, 0.0, 0.05])
        service.cursor = [0.1, 0.1, 0.1]
        service.plugged = True
        assert eventually(lambda: ready(device))
        np.testing.assert_allclose(place(device), [0.0, 0.0, 0.05])


def test_a_service_that_is_started_again_is_found_again(service: Service) -> None:
    with haply(service) as device:
        assert eventually(lambda: ready(device))
        service.stop()
        assert eventually(lambda: not device.read(0.0).connected)
        service.start_again()
        assert eventually(lambda: ready(device))
        greetings = [message for message in service.received if "session" in message]
        assert len(greetings) == 2


def test_a_service_without_a_device_says_so(service: Service) -> None:
    service.plugged = False
    with pytest.raises(InputError, match="found a service without one"):
        haply(service).open()


def test_no_service_says_so() -> None:
    with socket.create_server(("localhost", 0)) as free:
        port = free.getsockname()[1]
    with pytest.raises(InputError, match=r"the Haply Inverse service, 3\.5 or newer"):
        Haply(address=f"ws://localhost:{port}").open()


def test_another_service_says_so() -> None:
    """One that takes the connection and never answers."""
    with (
        socket.create_server(("localhost", 0)) as mute,
        pytest.raises(InputError, match="the Haply Inverse service"),
    ):
        Haply(address=f"ws://localhost:{mute.getsockname()[1]}").open()


@given(st.one_of(st.text(), st.sampled_from(["[]", "7", "null", '{"inverse3": [{}]}', "{}"])))
def test_other_messages_are_refused_or_empty(message: str) -> None:
    with contextlib.suppress(ValueError):
        assert frame_in(message) is None


@given(st.tuples(*[st.floats(-10.0, 10.0)] * 3))
def test_forces_survive_the_way_to_the_bit(force: tuple[float, float, float]) -> None:
    """The message is the one of the documentation's page on control commands."""
    x, y, z = force
    vector = {"vector": {"x": x, "y": y, "z": z}}
    documented = {"inverse3": [{"device_id": "049D", "commands": {"set_cursor_force": vector}}]}
    assert json.loads(force_request("049D", np.array(force))) == documented


positions = st.tuples(*[st.floats(-0.2, 0.2)] * 3).map(np.array)


@given(st.lists(st.tuples(st.one_of(st.none(), positions), st.booleans())))
def test_only_motion_while_held_and_there_counts(
    readings: list[tuple[Array | None, bool]],
) -> None:
    clutch, total, before = Clutch(), np.zeros(3), None
    for device, held in readings:
        there = device if held else None
        if there is not None and before is not None:
            total = total + (there - before)
        before = there
        np.testing.assert_array_equal(clutch.move(device, held=held), total)
