"""Fits a robot file to recorded motor positions and tip positions."""

from sinuous.calibration.calibrate import Calibration, calibrate
from sinuous.calibration.columns import Columns
from sinuous.calibration.recording import Recording, read_recording

__all__ = ["Calibration", "Columns", "Recording", "calibrate", "read_recording"]
