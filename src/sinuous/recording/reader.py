"""Reads a recording back, also one whose writer was killed."""

import os
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO, NoReturn

import numpy as np
from mcap import records
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.stream_reader import CRCValidationError, breakup_chunk
from rosbags.serde import SerdeError
from zstandard import ZstdError

from sinuous.arrays import Array, IntArray
from sinuous.errors import InputError
from sinuous.recording.header import METADATA, header, is_readable
from sinuous.recording.messages import (
    STORE,
    TOPICS,
    ZONE_TOPIC,
    marker_parts,
    marker_triangles,
)
from sinuous.recording.run import Recording, Sample

MAGIC = b"\x89MCAP0\r\n"
RECORD_HEAD = struct.Struct("<BQ")  # opcode, length of what follows

DAMAGED = (CRCValidationError, ZstdError, McapError, struct.error, UnicodeDecodeError)
"""What a record raises whose bytes are not those that were written."""

FOREIGN = (KeyError, IndexError, AttributeError, TypeError, ValueError, SerdeError)
"""What the content of a healthy file raises that `Recorder` did not write."""


def read(path: Path | str) -> Recording:
    """Everything that `Recorder` wrote, bit for bit.

    A file that was cut off or damaged is read up to there; `complete` is then False.

    Raises:
        InputError: if there is no such file, or it is not a recording
    """
    path = Path(path)
    content = _Content()
    try:
        with path.open("rb") as stream:
            if stream.read(len(MAGIC)) != MAGIC:
                _refuse(path, "a file of another format")
            _collect(stream, content)
    except OSError as error:
        _refuse(path, (error.strerror or str(error)).lower())
    except FOREIGN as error:
        _refuse(path, f"messages that do not belong to one ({type(error).__name__}: {error})")
    if not content.metadata:
        _refuse(path, "no header of such a run")
    if not is_readable(content.metadata):
        _refuse(path, f"format {content.metadata.get('format')}, written by another version")
    try:
        return content.recording()
    except FOREIGN as error:
        _refuse(path, f"a header or steps with missing parts ({type(error).__name__}: {error})")


@dataclass(kw_only=True)
class _Content:
    """What has been found in a file so far."""

    metadata: dict[str, str] = field(default_factory=dict[str, str])
    files: dict[str, str] = field(default_factory=dict[str, str])
    channels: dict[int, str] = field(default_factory=dict[int, str])
    triangles: Array = field(default_factory=lambda: np.empty((0, 3, 3)))
    parts: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    steps: dict[str, list[dict[str, Any]]] = field(
        default_factory=lambda: {topic.name: [] for topic in TOPICS}
    )
    complete: bool = False

    def recording(self) -> Recording:
        """All steps of which every topic is there: the n-th message of each is step n."""
        samples: list[Sample] = []
        for parts in zip(*self.steps.values(), strict=False):
            fields: dict[str, Any] = {}
            for part in parts:
                fields.update(part)
            samples.append(Sample(**fields))
        found = header(self.metadata, self.files, self.triangles, self.parts)
        return Recording.from_samples(found, samples, complete=self.complete)


def _collect(stream: BinaryIO, content: _Content) -> None:
    """Take every record up to the first one that is not whole."""
    for opcode, body in _whole_records(stream):
        try:
            record = _parse(opcode, body)
        except DAMAGED:
            return
        match record:
            case records.Metadata() if record.name == METADATA:
                content.metadata = record.metadata
            case records.Attachment():
                content.files[record.name] = record.data.decode()
            case records.Footer():
                content.complete = stream.read(len(MAGIC)) == MAGIC
                return
            case list():
                for inner in record:
                    _take(inner, content)
            case _:
                pass


def _whole_records(stream: BinaryIO) -> Iterator[tuple[int, bytes]]:
    """The records that are on disk from their first to their last byte."""
    size = os.fstat(stream.fileno()).st_size
    while len(head := stream.read(RECORD_HEAD.size)) == RECORD_HEAD.size:
        opcode, length = RECORD_HEAD.unpack(head)
        if stream.tell() + length > size:
            return
        yield opcode, stream.read(length)


def _parse(opcode: int, body: bytes) -> records.McapRecord | list[records.McapRecord] | None:
    """One record, or the records inside one chunk; None for those a recording has no use for."""
    data = ReadDataStream(BytesIO(body))
    match opcode:
        case Opcode.METADATA:
            return records.Metadata.read(data)
        case Opcode.ATTACHMENT:
            return records.Attachment.read(data)
        case Opcode.FOOTER:
            return records.Footer.read(data)
        case Opcode.CHUNK:
            return breakup_chunk(records.Chunk.read(data), validate_crc=True)
        case _:
            return None


def _take(record: records.McapRecord, content: _Content) -> None:
    """Decode one record of a chunk."""
    match record:
        case records.Channel():
            content.channels[record.id] = record.topic
        case records.Message():
            name = content.channels[record.channel_id]
            if name == ZONE_TOPIC:
                marker = STORE.deserialize_cdr(record.data, "visualization_msgs/msg/Marker")
                content.triangles = marker_triangles(marker)
                content.parts = marker_parts(marker)
            elif topic := BY_NAME.get(name):
                message = STORE.deserialize_cdr(record.data, topic.msgtype)
                content.steps[name].append(topic.decode(message))
        case _:
            pass


BY_NAME = {topic.name: topic for topic in TOPICS}


def _refuse(path: Path, found: str) -> NoReturn:
    raise InputError(
        file=str(path),
        expected="a recording of a run",
        found=found,
        remedy="Give the run.mcap that `sinuous run` wrote.",
    )
