import dataclasses
import io
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from mcap.reader import make_reader
from mcap.writer import Writer
from rosbags.highlevel import AnyReader

from sinuous.control.report import Status
from sinuous.errors import InputError
from sinuous.recording import Header, Recorder, Recording, Sample, ZonePart, read, status_name
from sinuous.recording.messages import LEVELS, TOPICS, ZONE_COLORS

POINTS, ACTUATORS, COORDINATES, CABLES = 7, 5, 3, 4
ANY_FLOAT = st.floats(width=64)


def make_header(**changes: Any) -> Header:
    rng = np.random.default_rng(5)
    values: dict[str, Any] = {
        "name": "tube, curvé",
        "robot": 'name = "x"\n# µ\n',
        "scenario": "[mpc]\nhorizon = 5\n",
        "actuator_names": tuple(f"segment 1 cable {i + 1}" for i in range(ACTUATORS)),
        "rate_limits": np.tile([-0.02, np.inf], (ACTUATORS, 1)),
        "margin": 0.1 + 0.2,
        "dt": 1.0 / 30.0,
        "seed": 2**70,
        "versions": {"sinuous": "0.1.0", "numpy": "2"},
        "zone_triangles": rng.normal(size=(11, 3, 3)),
        "zone_parts": rng.integers(0, len(ZonePart), size=11),
        "radii": rng.random(POINTS),
        "disk_indices": np.array([1, 3, 6]),
        "tubes": np.array([[0, 1], [4, 6]]),
    }
    return Header(**values | changes)


def make_sample(k: int, seed: int = 0, **changes: Any) -> Sample:
    rng = np.random.default_rng((seed, k))
    values: dict[str, Any] = {
        "time": k * (1.0 / 30.0),
        "target": rng.normal(size=3),
        "configuration": rng.normal(size=COORDINATES),
        "lengths": rng.normal(size=ACTUATORS),
        "rates": rng.normal(size=ACTUATORS),
        "nominal_points": rng.normal(size=(POINTS, 3)),
        "nominal_tip": rng.normal(size=3),
        "nominal_clearance": float(rng.normal()),
        "measured_points": rng.normal(size=(POINTS, 3)),
        "measured_tip": rng.normal(size=3),
        "measured_lengths": rng.normal(size=ACTUATORS),
        "local_rates": rng.normal(size=ACTUATORS),
        "clipped": float(rng.random()),
        "offset": rng.normal(size=3),
        "actual_points": rng.normal(size=(POINTS, 3)),
        "actual_tip": rng.normal(size=3),
        "actual_clearance": np.inf,
        "status": "holding" if k % 7 == 3 else "tracking",
        "solve_time": float(rng.random()),
        "iterations": int(rng.integers(0, 100)),
        "planes": int(rng.integers(0, 100)),
        "step_fraction": float(rng.random()),
        "tensions": rng.random(CABLES),
        "contacts": rng.random(3),
        "pushed": int(rng.integers(0, POINTS)),
        "body_force": rng.normal(size=3),
        "active": ("cable 1.2 at its limit", "triangle 12 of tube.stl")[: k % 3],
    }
    return Sample(**values | changes)


def record(path: Path, header: Header, samples: list[Sample]) -> Path:
    with Recorder(path, header) as recorder:
        for sample in samples:
            recorder.write(sample)
    return path


def assert_same(a: Any, b: Any) -> None:
    """Every field of two dataclasses is the same, bit for bit."""
    for field in dataclasses.fields(a):
        one, other = getattr(a, field.name), getattr(b, field.name)
        if isinstance(one, Header):
            assert_same(one, other)
        elif isinstance(one, np.ndarray):
            assert one.dtype == other.dtype
            assert one.shape == other.shape
            assert one.tobytes() == other.tobytes(), field.name
        else:
            assert one == other, field.name


def test_what_is_written_is_read_bit_for_bit(tmp_path: Path) -> None:
    header, samples = make_header(), [make_sample(k) for k in range(100)]
    found = read(record(tmp_path / "new" / "run.mcap", header, samples))
    assert found.complete
    assert_same(found, Recording.from_samples(header, samples))


@settings(
    suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=40
)
@given(
    points=arrays(np.float64, st.tuples(st.integers(0, 5), st.just(3)), elements=ANY_FLOAT),
    rates=arrays(np.float64, ACTUATORS, elements=ANY_FLOAT),
    number=ANY_FLOAT,
    time=st.floats(0.0, 1e6),
    words=st.lists(st.text(st.characters(codec="utf-8", exclude_characters="\0"))),
)
def test_any_number_and_text_survives(
    tmp_path: Path, points: Any, rates: Any, number: float, time: float, words: list[str]
) -> None:
    sample = make_sample(
        0,
        time=time,
        nominal_points=points,
        rates=rates,
        nominal_clearance=number,
        step_fraction=number,
        status="".join(words),
        active=tuple(words),
    )
    found = read(record(tmp_path / "run.mcap", make_header(), [sample]))
    expected = Recording.from_samples(make_header(), [sample])
    assert np.array_equal(found.step_fraction, expected.step_fraction, equal_nan=True)
    # A NaN is written as text there and may lose its sign.
    assert_same(
        dataclasses.replace(found, step_fraction=np.zeros(1)),
        dataclasses.replace(expected, step_fraction=np.zeros(1)),
    )


def test_without_steps_and_without_zone(tmp_path: Path) -> None:
    header = make_header(zone_triangles=np.empty((0, 3, 3)), zone_parts=np.zeros(0, dtype=np.int64))
    found = read(record(tmp_path / "run.mcap", header, []))
    assert len(found) == 0
    assert found.complete
    assert_same(found, Recording.from_samples(header, []))


def test_same_samples_give_same_bytes(tmp_path: Path) -> None:
    samples = [make_sample(k) for k in range(80)]
    one = record(tmp_path / "a" / "run.mcap", make_header(), samples)
    other = record(tmp_path / "b" / "other.mcap", make_header(), samples)
    assert one.read_bytes() == other.read_bytes()


def test_only_the_topic_of_solve_times_knows_the_wall_clock(tmp_path: Path) -> None:
    def messages(path: Path) -> list[tuple[str, int, bytes]]:
        with path.open("rb") as stream:
            return [
                (channel.topic, message.log_time, message.data)
                for _, channel, message in make_reader(stream).iter_messages()
                if channel.topic != "/solve_time"
            ]

    slow = [make_sample(k, solve_time=1.0) for k in range(40)]
    fast = [make_sample(k, solve_time=0.1) for k in range(40)]
    assert messages(record(tmp_path / "a.mcap", make_header(), slow)) == messages(
        record(tmp_path / "b.mcap", make_header(), fast)
    )


def test_a_reader_of_others_decodes_it_from_its_own_schemas(tmp_path: Path) -> None:
    header, samples = make_header(), [make_sample(k) for k in range(50)]
    path = record(tmp_path / "run.mcap", header, samples)
    tips: list[list[float]] = []
    with AnyReader([path]) as reader:
        types = {c.topic: c.msgtype for c in reader.connections}
        counts = {c.topic: c.msgcount for c in reader.connections}
        for connection, time, data in reader.messages():
            message: Any = reader.deserialize(data, connection.msgtype)
            if connection.topic == "/measured/tip":
                tips.append([message.point.x, message.point.y, message.point.z])
                assert message.header.frame_id == "mesh"
                stamp = message.header.stamp
                assert stamp.sec * 10**9 + stamp.nanosec == time == round(len(tips[1:]) / 30 * 1e9)
            elif connection.topic == "/nominal/joint_states":
                assert tuple(message.name) == header.actuator_names
            elif connection.topic == "/zone":
                colors = [ZONE_COLORS[ZonePart(p)] for p in header.zone_parts]
                assert [c.a for c in message.colors[::3]] == [c.a for c in colors]
                assert len(message.colors) == len(message.points)
            elif connection.topic == "/diagnostics":
                status = message.status[0]
                assert status.level == (2 if status.message == "holding" else 0)
    assert np.array_equal(tips, [s.measured_tip for s in samples])
    assert counts.pop("/zone") == 1
    assert set(counts.values()) == {len(samples)}
    assert types["/nominal/body"] == "nav_msgs/msg/Path"
    assert types["/zone"] == "visualization_msgs/msg/Marker"


def test_every_status_has_its_level() -> None:
    assert set(LEVELS) < {status_name(status) for status in Status}
    assert len({(c.r, c.g, c.b, c.a) for c in ZONE_COLORS.values()}) == len(ZonePart)


def test_the_container_is_chunked_indexed_and_checked(tmp_path: Path) -> None:
    path = record(tmp_path / "run.mcap", make_header(), [make_sample(k) for k in range(92)])
    with path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        assert summary is not None
        assert reader.get_header().profile == "ros2"
        # Preamble, three chunks of a second each, and the last step.
        assert len(summary.chunk_indexes) == 5
        assert {schema.encoding for schema in summary.schemas.values()} == {"ros2msg"}
        assert {channel.message_encoding for channel in summary.channels.values()} == {"cdr"}
        assert [m.name for m in reader.iter_metadata()] == ["sinuous"]
        assert [a.name for a in reader.iter_attachments()] == ["robot.toml", "scenario.toml"]
        times = [message.log_time for _, _, message in reader.iter_messages()]
    assert times == sorted(times)


def test_a_large_body_ends_chunks_early(tmp_path: Path) -> None:
    body = np.zeros((6000, 3))
    samples = [make_sample(k, nominal_points=body, measured_points=body) for k in range(4)]
    path = record(tmp_path / "run.mcap", make_header(), samples)
    with path.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    assert len(summary.chunk_indexes) == 3


@pytest.mark.parametrize("share", [0.35, 0.5, 0.7, 0.9, 0.999])
def test_a_file_that_was_cut_off_is_read_up_to_there(tmp_path: Path, share: float) -> None:
    samples = [make_sample(k) for k in range(150)]
    path = record(tmp_path / "run.mcap", make_header(), samples)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    found = read(path)
    assert not found.complete
    assert len(found) < 150 if share < 0.9 else len(found) <= 150
    assert len(found) > 30 * int(5 * share - 1.5)
    expected = Recording.from_samples(make_header(), samples[: len(found)], complete=False)
    assert_same(found, expected)


def test_a_killed_process_leaves_all_but_the_last_second(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "run.mcap", make_header())
    for k in range(100):
        recorder.write(make_sample(k))
    found = read(tmp_path / "run.mcap")
    recorder.close()
    assert not found.complete
    assert len(found) == 91
    assert len(read(tmp_path / "run.mcap")) == 100


def test_an_exception_in_the_run_leaves_a_whole_file(tmp_path: Path) -> None:
    def interrupted() -> None:
        with Recorder(tmp_path / "r.mcap", make_header()) as recorder:
            recorder.write(make_sample(0))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    found = read(tmp_path / "r.mcap")
    assert found.complete
    assert len(found) == 1


def test_damage_ends_the_reading(tmp_path: Path) -> None:
    path = record(tmp_path / "run.mcap", make_header(), [make_sample(k) for k in range(150)])
    with path.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    third = summary.chunk_indexes[2]
    data = bytearray(path.read_bytes())
    data[third.chunk_start_offset + third.chunk_length // 2] ^= 0xFF
    path.write_bytes(data)
    found = read(path)
    assert not found.complete
    assert len(found) == 31


def _foreign(metadata: dict[str, str] | None) -> bytes:
    """A healthy MCAP file that no recorder wrote."""
    stream = io.BytesIO()
    writer = Writer(stream)
    writer.start(profile="ros2", library="other")
    if metadata is not None:
        writer.add_metadata("sinuous", metadata)
    writer.finish()
    return stream.getvalue()


MAGIC = b"\x89MCAP0\r\n"
NOT_RECORDINGS = {
    "empty": (b"", "another format"),
    "text": (b"time,x\n0,1\n", "another format"),
    "magic only": (MAGIC, "no header"),
    "nonsense": (MAGIC + bytes(range(256)) * 4, "no header"),
    "long record": (MAGIC + struct.pack("<BQ", 12, 2**63), "no header"),
    "other": (_foreign(None), "no header"),
    "newer": (_foreign({"format": "5"}), "format 5"),
    "incomplete": (_foreign({"format": "4", "name": '"x"'}), "missing parts"),
    "not json": (_foreign({"format": "4", "name": "{"}), "missing parts"),
}


@pytest.mark.parametrize("case", NOT_RECORDINGS)
def test_what_is_not_a_recording_is_refused(tmp_path: Path, case: str) -> None:
    data, found = NOT_RECORDINGS[case]
    path = tmp_path / "bad.mcap"
    path.write_bytes(data)
    with pytest.raises(InputError, match=found) as error:
        read(path)
    assert error.value.file == str(path)


def test_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read(tmp_path / "none.mcap")
    with pytest.raises(InputError, match="is a directory"):
        read(tmp_path)


def test_a_place_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match=r"file/run\.mcap.*file exists \(.*/file\)"):
        Recorder(tmp_path / "file" / "run.mcap", make_header())
    with pytest.raises(InputError, match="is a directory"):
        Recorder(tmp_path, make_header())


@pytest.mark.parametrize("space", [0, 4000])
def test_a_disk_that_fills_up_names_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, space: int
) -> None:
    path = tmp_path / "run.mcap"

    class Full(io.FileIO):
        def write(self, data: Any, /) -> int:
            if self.tell() + len(data) > space:
                raise OSError(28, "No space left on device")
            return super().write(data)

    def open_full(self: Path, mode: str) -> io.BufferedWriter:
        return io.BufferedWriter(Full(self, mode))

    monkeypatch.setattr(Path, "open", open_full)
    with pytest.raises(InputError, match=r"run\.mcap.*no space left"):
        record(path, make_header(), [make_sample(k) for k in range(200)])
    monkeypatch.undo()
    if space:
        assert not read(path).complete


def test_a_recording_that_does_not_know_what_walls_push_is_read() -> None:
    (report,) = (topic for topic in TOPICS if topic.name == "/diagnostics")
    message: Any = report.encode(make_sample(1), make_header())
    values = message.status[0].values
    values[:] = [one for one in values if one.key not in {"pushed", "body_force"}]
    found = report.decode(message)
    assert found["pushed"] == 0
    assert np.array_equal(found["body_force"], np.zeros(3))
