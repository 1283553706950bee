"""Runs on disk: one MCAP file of ROS 2 messages, written step by step and read back exactly."""

from sinuous.recording.reader import read
from sinuous.recording.run import Header, Recording, Sample, ZonePart, status_name
from sinuous.recording.writer import Recorder

__all__ = ["Header", "Recorder", "Recording", "Sample", "ZonePart", "read", "status_name"]
