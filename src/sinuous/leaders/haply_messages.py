"""The messages of the Haply Inverse service, version 3.5 (docs.haply.co/inverseSDK, 3.5.x).

Over the WebSocket the service speaks first, with all that it knows of every device; from then on it
answers every message with one message. A force holds for one message only: who stops sending lets
go of the device. Units are SI; the basis XYZ is right, forward, up, which are our axes.
"""

import json
from typing import Any, NamedTuple, cast

import numpy as np

from sinuous.arrays import Array

PROFILE = "sinuous"  # by which Haply Hub shows the session


class Frame(NamedTuple):
    """What a message of the service says of one Inverse3.

    Arguments:
        device: its name
        position: of the cursor (3,) [m]
        grip: whether button a of the first wireless VerseGrip is pressed
    """

    device: str
    position: Array
    grip: bool


def frame_in(message: str | bytes, device: str | None = None) -> Frame | None:
    """What a message says of a device, or of the first one; None if it does not name it.

    Raises:
        ValueError: if the message is none of the service
    """
    try:
        content = cast(dict[str, Any], json.loads(message))
        for one in content.get("inverse3", ()):
            if device is None or one["device_id"] == device:
                cursor = one["state"]["cursor_position"]
                position = np.array([cursor["x"], cursor["y"], cursor["z"]], dtype=np.float64)
                return Frame(one["device_id"], position, _grip(content))
    except (KeyError, TypeError, AttributeError) as error:
        raise ValueError(f"a message without {error}") from error
    return None


def first_request(device: str) -> str:
    """Who we are and which axes we speak of, with no force."""
    session = {"configure": {"profile": {"name": PROFILE}, "basis": {"permutation": "XYZ"}}}
    return json.dumps({"session": session} | _command(device, np.zeros(3)))


def force_request(device: str, force: Array) -> str:
    """A force (3,) [N] on the cursor, until the next message."""
    return json.dumps(_command(device, force))


def _command(device: str, force: Array) -> dict[str, Any]:
    x, y, z = force.tolist()
    vector = {"vector": {"x": x, "y": y, "z": z}}
    return {"inverse3": [{"device_id": device, "commands": {"set_cursor_force": vector}}]}


def _grip(content: dict[str, Any]) -> bool:
    for grip in content.get("wireless_verse_grip", ()):
        return bool(grip.get("state", {}).get("buttons", {}).get("a", False))
    return False
