"""Streams a run into one MCAP file, chunk by chunk."""

from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Self

from mcap.writer import Writer

from sinuous.errors import InputError
from sinuous.recording.header import MEDIA_TYPE, METADATA, attachments, metadata
from sinuous.recording.messages import STORE, TOPICS, ZONE_TOPIC, nanoseconds, zone_marker
from sinuous.recording.run import Header, Sample

CHUNK_BYTES = 2**20
CHUNK_SECONDS = 1.0
"""A chunk ends with the sample that reaches either; a killed process loses no more than one."""

NEVER = 2**62
ZONE_TYPE = "visualization_msgs/msg/Marker"


class Recorder:
    """Writes samples while the run goes on.

    The same header and samples give the same bytes: time is simulated time, and nothing is
    read from the clock. Messages of one sample always share a chunk, so that a file that was
    cut off holds whole samples only.

    Arguments:
        path: the `.mcap` file to write; missing folders are made, an old file is replaced
        header: what does not change during the run

    Raises:
        InputError: if the file cannot be written, now or later (no permission, disk full)
    """

    def __init__(self, path: Path | str, header: Header) -> None:
        self._path = Path(path)
        self._header = header
        self._channels: dict[str, int] = {}
        self._sequence = 0
        self._pending_bytes = 0
        self._chunk_start = 0.0
        self._stream = _create(self._path)
        # Chunks end between samples, which only this class knows, never at a size.
        self._mcap = Writer(self._stream, chunk_size=NEVER)
        with self._guard():
            self._write_preamble()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def write(self, sample: Sample) -> None:
        """Add one step.

        Raises:
            InputError: if the file cannot be written
        """
        time = nanoseconds(sample.time)
        with self._guard():
            for topic in TOPICS:
                self._add(topic.name, topic.msgtype, topic.encode(sample, self._header), time)
            self._sequence += 1
            full = self._pending_bytes >= CHUNK_BYTES
            if full or sample.time - self._chunk_start >= CHUNK_SECONDS:
                self._end_chunk()
                self._chunk_start = sample.time

    def close(self) -> None:
        """Write the index and close the file; again or after an error it does nothing.

        Raises:
            InputError: if the file cannot be written
        """
        if self._stream.closed:
            return
        with self._guard():
            self._mcap.finish()
            self._stream.close()

    def _write_preamble(self) -> None:
        """Everything that is known before the first step, so that any cut-off file has it."""
        self._mcap.start(profile="ros2", library="sinuous")
        self._mcap.add_metadata(METADATA, metadata(self._header))
        for name, text in attachments(self._header).items():
            self._mcap.add_attachment(0, 0, name, MEDIA_TYPE, text.encode())
        schemas: dict[str, int] = {}
        for name, msgtype in ((ZONE_TOPIC, ZONE_TYPE), *((t.name, t.msgtype) for t in TOPICS)):
            if msgtype not in schemas:
                definition, _ = STORE.generate_msgdef(msgtype, ros_version=2)
                schemas[msgtype] = self._mcap.register_schema(
                    msgtype, "ros2msg", definition.encode()
                )
            self._channels[name] = self._mcap.register_channel(name, "cdr", schemas[msgtype])
        if len(self._header.zone_triangles):
            self._add(ZONE_TOPIC, ZONE_TYPE, zone_marker(self._header), 0)
        self._end_chunk()

    def _add(self, topic: str, msgtype: str, message: object, time: int) -> None:
        data = bytes(STORE.serialize_cdr(message, msgtype, little_endian=True))
        self._mcap.add_message(
            self._channels[topic], time, data, publish_time=time, sequence=self._sequence
        )
        self._pending_bytes += len(data)

    def _end_chunk(self) -> None:
        self._mcap.flush()
        self._pending_bytes = 0

    @contextmanager
    def _guard(self) -> Generator[None]:
        """Turn what the system says about the file into advice, and give the file up."""
        try:
            yield
        except OSError as error:
            # Closing flushes what is buffered, which fails for the same reason as before.
            with suppress(OSError):
                self._stream.close()
            raise _advice(self._path, error) from error


def _create(path: Path) -> BinaryIO:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        return path.open("wb")
    except OSError as error:
        raise _advice(path, error) from error


def _advice(path: Path, error: OSError) -> InputError:
    found = (error.strerror or str(error)).lower()
    if error.filename and str(error.filename) != str(path):
        found += f" ({error.filename})"
    return InputError(
        file=str(path),
        expected="a file that can be written",
        found=found,
        remedy="Free some space or choose another place for the output.",
    )
