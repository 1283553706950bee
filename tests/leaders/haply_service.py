"""The Haply Inverse service as its documentation describes it, version 3.5, without a device.

It speaks first, with everything about every device; then it answers each message with one message
that carries state only.
"""

import json
from threading import Thread
from typing import Any, Self

from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

DEVICE = "049D"
IDENTITY = {
    "position": {"x": 0, "y": 0, "z": 0},
    "rotation": {"w": 1, "x": 0, "y": 0, "z": 0},
    "scale": {"x": 1, "y": 1, "z": 1},
}
CONFIG = {
    "type": "inverse3",
    "port": "COM12",
    "device_info": {"major_version": 7, "minor_version": 4, "id": DEVICE, "device_type": 4},
    "gravity_compensation": {"enabled": True, "scaling_factor": 1.0},
    "handedness": "right",
    "streaming_mode": "USB",
    "torque_scaling": {"enabled": True},
    "home_return": {"enabled": False},
    "preset": "defaults",
    "basis": {"permutation": "XYZ"},
    "mount": IDENTITY,
    "filters": {"force_gate": {"gain": 0.3}, "damping": {"scalar": 0.0}},
}
ZERO = {"x": 0.0, "y": 0.0, "z": 0.0}


class Service:
    """What is plugged in, where its cursor is, and all that a client has sent."""

    def __init__(self) -> None:
        self.plugged, self.cursor = True, [0.0, -0.12, 0.15]
        self.grip: bool | None = None
        self.received = list[dict[str, Any]]()
        self._clients = list[ServerConnection]()
        self._port = 0
        self._start()

    @property
    def address(self) -> str:
        return f"ws://localhost:{self._port}"

    def forces(self) -> list[list[float]]:
        """Forces that were sent so far."""
        vectors = [
            device["commands"]["set_cursor_force"]["vector"]
            for message in list(self.received)
            for device in message["inverse3"]
        ]
        return [[vector[axis] for axis in "xyz"] for vector in vectors]

    def stop(self) -> None:
        """As if the service was stopped: connections end, nobody listens."""
        self._server.shutdown()
        for client in self._clients:
            client.close()
        self._thread.join()
        self._clients.clear()

    def start_again(self) -> None:
        self._start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def _start(self) -> None:
        self._server = serve(self._serve, "localhost", self._port, compression=None)
        self._port = self._server.socket.getsockname()[1]
        self._thread = Thread(target=self._server.serve_forever)
        self._thread.start()

    def _serve(self, client: ServerConnection) -> None:
        self._clients.append(client)
        try:
            client.send(self._message(first=True))
            for message in client:
                self.received.append(json.loads(message))
                client.send(self._message(first=False))
        except ConnectionClosed:
            pass

    def _message(self, *, first: bool) -> str:
        message: dict[str, Any] = {"session_id": 7} if first else {}
        message["inverse3"] = [self._inverse3(first=first)] if self.plugged else []
        message["verse_grip"] = []
        message["wireless_verse_grip"] = []
        if self.grip is not None:
            buttons = {"a": self.grip, "b": False, "c": False}
            state = {"orientation": IDENTITY["rotation"], "buttons": buttons}
            message["wireless_verse_grip"] = [{"device_id": "61576", "state": state}]
        return json.dumps(message)

    def _inverse3(self, *, first: bool) -> dict[str, Any]:
        device: dict[str, Any] = {"device_id": DEVICE}
        if first:
            device["config"] = CONFIG
            device["status"] = {"calibrated": True, "power_supply": True, "ready": True}
        device["state"] = {
            "cursor_position": dict(zip("xyz", self.cursor, strict=True)),
            "cursor_velocity": ZERO,
            "angular_position": {"a0": 0.0, "a1": 0.0, "a2": 0.0},
            "body_orientation": IDENTITY["rotation"],
            "current_cursor_force": ZERO,
            "control_domain": "cartesian",
            "control_mode": "force",
            "transform": IDENTITY,
        }
        return device
