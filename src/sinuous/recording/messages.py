"""Samples as standard ROS 2 messages, and back.

Every topic carries exactly one message per sample. Nothing is stored twice, and only
`/solve_time` depends on the wall clock, so that two runs can be compared topic by topic.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from rosbags.typesys import Stores, get_typestore
from rosbags.typesys.stores import ros2_humble as ros

from sinuous.arrays import Array, IntArray
from sinuous.control.report import Status
from sinuous.recording.run import Header, Sample, ZonePart, status_name

FRAME = "mesh"
"""Name of the one frame everything is expressed in: that of the zone's mesh."""

NS_PER_S = 1_000_000_000
UPRIGHT = ros.geometry_msgs__msg__Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
ZONE_TOPIC = "/zone"

# Sixteenths are the same in single precision, which messages have, and when read back.
ZONE_COLORS = {
    ZonePart.WALL: ros.std_msgs__msg__ColorRGBA(r=0.375, g=0.75, b=0.875, a=0.25),
    ZonePart.GUIDE: ros.std_msgs__msg__ColorRGBA(r=0.625, g=0.625, b=0.625, a=0.125),
    ZonePart.KEEP_OUT: ros.std_msgs__msg__ColorRGBA(r=0.375, g=0.4375, b=0.5, a=1.0),
}
PART_OF_COLOR = {(c.r, c.g, c.b, c.a): part for part, c in ZONE_COLORS.items()}

LEVELS: dict[str, int] = {
    status_name(Status.HOLDING): ros.diagnostic_msgs__msg__DiagnosticStatus.ERROR,
    status_name(Status.BLOCKED): ros.diagnostic_msgs__msg__DiagnosticStatus.WARN,
    status_name(Status.RECOVERING): ros.diagnostic_msgs__msg__DiagnosticStatus.WARN,
}
"""How viewers colour a status; every other one is good."""

STORE = get_typestore(Stores.ROS2_HUMBLE)
"""Definitions of the messages; those used here have not changed since that release."""


@dataclass(frozen=True, kw_only=True)
class Topic:
    """One topic: how a sample becomes its message, and which fields its message gives back."""

    name: str
    msgtype: str
    encode: Callable[[Sample, Header], object]
    decode: Callable[[Any], dict[str, Any]]


def nanoseconds(time: float) -> int:
    """Log time of a simulated time [s]."""
    return round(time * NS_PER_S)


def zone_marker(header: Header) -> object:
    """The zone's triangles as one marker that stays for ever, coloured by what they stand for."""
    return ros.visualization_msgs__msg__Marker(
        header=_stamped(0.0),
        ns="zone",
        id=0,
        type=ros.visualization_msgs__msg__Marker.TRIANGLE_LIST,
        action=ros.visualization_msgs__msg__Marker.ADD,
        pose=ros.geometry_msgs__msg__Pose(position=_point((0.0, 0.0, 0.0)), orientation=UPRIGHT),
        scale=ros.geometry_msgs__msg__Vector3(x=1.0, y=1.0, z=1.0),
        color=ZONE_COLORS[ZonePart.WALL],
        lifetime=ros.builtin_interfaces__msg__Duration(sec=0, nanosec=0),
        frame_locked=False,
        points=[_point(corner) for corner in header.zone_triangles.reshape(-1, 3).tolist()],
        colors=[ZONE_COLORS[ZonePart(p)] for p in header.zone_parts for _ in range(3)],
        texture_resource="",
        texture=ros.sensor_msgs__msg__CompressedImage(
            header=_stamped(0.0), format="", data=np.empty(0, dtype=np.uint8)
        ),
        uv_coordinates=[],
        text="",
        mesh_resource="",
        mesh_file=ros.visualization_msgs__msg__MeshFile(
            filename="", data=np.empty(0, dtype=np.uint8)
        ),
        mesh_use_embedded_materials=False,
    )


def marker_triangles(marker: Any) -> Array:
    """The triangles (T, 3, 3) [m] of a zone's marker."""
    return np.array([(p.x, p.y, p.z) for p in marker.points], dtype=np.float64).reshape(-1, 3, 3)


def marker_parts(marker: Any) -> IntArray:
    """The `ZonePart` (T,) of every triangle of a zone's marker.

    Raises:
        KeyError: if a colour stands for none
    """
    parts = [PART_OF_COLOR[c.r, c.g, c.b, c.a] for c in marker.colors[::3]]
    return np.array(parts, dtype=np.int64)


def _stamped(time: float) -> ros.std_msgs__msg__Header:
    seconds, rest = divmod(nanoseconds(time), NS_PER_S)
    return ros.std_msgs__msg__Header(
        stamp=ros.builtin_interfaces__msg__Time(sec=seconds, nanosec=rest), frame_id=FRAME
    )


def _point(p: Any) -> ros.geometry_msgs__msg__Point:
    return ros.geometry_msgs__msg__Point(x=float(p[0]), y=float(p[1]), z=float(p[2]))


def _position(name: str, field: str) -> Topic:
    """A topic with one point of R^3."""

    def encode(sample: Sample, _: Header) -> object:
        return ros.geometry_msgs__msg__PointStamped(
            header=_stamped(sample.time), point=_point(getattr(sample, field))
        )

    def decode(message: Any) -> dict[str, Any]:
        p = message.point
        return {field: np.array((p.x, p.y, p.z))}

    return Topic(name=name, msgtype="geometry_msgs/msg/PointStamped", encode=encode, decode=decode)


def _body(name: str, field: str) -> Topic:
    """A topic with the points of a body, drawn by viewers as a line."""

    def encode(sample: Sample, _: Header) -> object:
        header = _stamped(sample.time)
        points: Array = getattr(sample, field)
        poses = [
            ros.geometry_msgs__msg__PoseStamped(
                header=header,
                pose=ros.geometry_msgs__msg__Pose(position=_point(p), orientation=UPRIGHT),
            )
            for p in points.tolist()
        ]
        return ros.nav_msgs__msg__Path(header=header, poses=poses)

    def decode(message: Any) -> dict[str, Any]:
        points = [stamped.pose.position for stamped in message.poses]
        return {field: np.array([(p.x, p.y, p.z) for p in points]).reshape(-1, 3)}

    return Topic(name=name, msgtype="nav_msgs/msg/Path", encode=encode, decode=decode)


def _joints(name: str, position: str, velocity: str | None) -> Topic:
    """A topic with actuator lengths and, if there are any, rates."""

    def encode(sample: Sample, header: Header) -> object:
        return ros.sensor_msgs__msg__JointState(
            header=_stamped(sample.time),
            name=list(header.actuator_names),
            position=np.asarray(getattr(sample, position), dtype=np.float64),
            velocity=np.asarray(getattr(sample, velocity) if velocity else (), dtype=np.float64),
            effort=np.empty(0),
        )

    def decode(message: Any) -> dict[str, Any]:
        fields = {position: message.position}
        return fields | {velocity: message.velocity} if velocity else fields

    return Topic(name=name, msgtype="sensor_msgs/msg/JointState", encode=encode, decode=decode)


def _vector(name: str, field: str) -> Topic:
    """A topic with an array of numbers."""

    def encode(sample: Sample, _: Header) -> object:
        values = np.asarray(getattr(sample, field), dtype=np.float64)
        size = values.size
        dimension = ros.std_msgs__msg__MultiArrayDimension(label=field, size=size, stride=size)
        layout = ros.std_msgs__msg__MultiArrayLayout(dim=[dimension], data_offset=0)
        return ros.std_msgs__msg__Float64MultiArray(layout=layout, data=values)

    def decode(message: Any) -> dict[str, Any]:
        return {field: message.data}

    return Topic(name=name, msgtype="std_msgs/msg/Float64MultiArray", encode=encode, decode=decode)


def _encode_signals(sample: Sample, header: Header) -> object:
    """What every tick of the sample had, tick by tick."""
    values = np.ascontiguousarray(sample.signals, dtype=np.float64)
    rows, columns = values.shape
    dimensions = [
        ros.std_msgs__msg__MultiArrayDimension(label="tick", size=rows, stride=rows * columns),
        ros.std_msgs__msg__MultiArrayDimension(
            label=",".join(header.signals), size=columns, stride=columns
        ),
    ]
    layout = ros.std_msgs__msg__MultiArrayLayout(dim=dimensions, data_offset=0)
    return ros.std_msgs__msg__Float64MultiArray(layout=layout, data=values.ravel())


def _decode_signals(message: Any) -> dict[str, Any]:
    rows, columns = (dimension.size for dimension in message.layout.dim)
    return {"signals": message.data.reshape(rows, columns)}


def _number(name: str, field: str) -> Topic:
    """A topic with one number."""

    def encode(sample: Sample, _: Header) -> object:
        return ros.std_msgs__msg__Float64(data=float(getattr(sample, field)))

    def decode(message: Any) -> dict[str, Any]:
        return {field: message.data}

    return Topic(name=name, msgtype="std_msgs/msg/Float64", encode=encode, decode=decode)


def _encode_report(sample: Sample, header: Header) -> object:
    """The controller's report; its time is exact, log times are rounded to nanoseconds."""
    values = [
        ("time", repr(float(sample.time))),
        ("iterations", str(sample.iterations)),
        ("planes", str(sample.planes)),
        ("step_fraction", repr(float(sample.step_fraction))),
        ("pushed", str(sample.pushed)),
        ("body_force", " ".join(repr(f) for f in sample.body_force.tolist())),
        *(("active", what) for what in sample.active),
    ]
    status = ros.diagnostic_msgs__msg__DiagnosticStatus(
        level=LEVELS.get(sample.status, ros.diagnostic_msgs__msg__DiagnosticStatus.OK),
        name="controller",
        message=sample.status,
        hardware_id=header.name,
        values=[ros.diagnostic_msgs__msg__KeyValue(key=k, value=v) for k, v in values],
    )
    return ros.diagnostic_msgs__msg__DiagnosticArray(header=_stamped(sample.time), status=[status])


def _decode_report(message: Any) -> dict[str, Any]:
    status = message.status[0]
    values = {item.key: item.value for item in status.values}
    return {
        "status": status.message,
        "time": float(values["time"]),
        "iterations": int(values["iterations"]),
        "planes": int(values["planes"]),
        "step_fraction": float(values["step_fraction"]),
        # Older recordings do not know what walls push.
        "pushed": int(values.get("pushed", "0")),
        "body_force": np.array([float(f) for f in values.get("body_force", "0 0 0").split()]),
        "active": tuple(item.value for item in status.values if item.key == "active"),
    }


TOPICS = (
    _position("/target", "target"),
    _vector("/configuration", "configuration"),
    _joints("/nominal/joint_states", "lengths", "rates"),
    _body("/nominal/body", "nominal_points"),
    _position("/nominal/tip", "nominal_tip"),
    _number("/clearance/nominal", "nominal_clearance"),
    _joints("/measured/joint_states", "measured_lengths", None),
    _body("/measured/body", "measured_points"),
    _position("/measured/tip", "measured_tip"),
    _body("/actual/body", "actual_points"),
    _position("/actual/tip", "actual_tip"),
    _number("/clearance/actual", "actual_clearance"),
    _vector("/local/rates", "local_rates"),
    _number("/local/clipped", "clipped"),
    _position("/offset", "offset"),
    _vector("/tensions", "tensions"),
    _vector("/contacts", "contacts"),
    _number("/solve_time", "solve_time"),
    Topic(
        name="/signals",
        msgtype="std_msgs/msg/Float64MultiArray",
        encode=_encode_signals,
        decode=_decode_signals,
    ),
    Topic(
        name="/diagnostics",
        msgtype="diagnostic_msgs/msg/DiagnosticArray",
        encode=_encode_report,
        decode=_decode_report,
    ),
)
