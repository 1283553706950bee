"""The header of a run as MCAP metadata (JSON values) and attachments (the two TOML files)."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.recording.run import Header

METADATA = "sinuous"
FORMAT = 4
"""Grows when a recording can no longer be read by older versions."""

ROBOT_FILE = "robot.toml"
SCENARIO_FILE = "scenario.toml"
MEDIA_TYPE = "application/toml"


def metadata(header: Header) -> dict[str, str]:
    """What is neither text of a file nor the zone. JSON keeps every bit of a float."""
    values: dict[str, object] = {
        "format": FORMAT,
        "name": header.name,
        "actuator_names": list(header.actuator_names),
        "rate_limits": np.asarray(header.rate_limits, dtype=np.float64).tolist(),
        "margin": float(header.margin),
        "dt": float(header.dt),
        "seed": header.seed,
        "versions": header.versions,
        "radii": np.asarray(header.radii, dtype=np.float64).tolist(),
        "disk_indices": np.asarray(header.disk_indices, dtype=np.int64).tolist(),
        "tubes": np.asarray(header.tubes, dtype=np.int64).tolist(),
        "signals": list(header.signals),
        "tick": float(header.tick),
    }
    return {key: json.dumps(value, ensure_ascii=False) for key, value in values.items()}


def attachments(header: Header) -> dict[str, str]:
    """The files the run was made from, by name."""
    return {ROBOT_FILE: header.robot, SCENARIO_FILE: header.scenario}


def is_readable(data: Mapping[str, str]) -> bool:
    """Whether this version understands that metadata."""
    return data.get("format") == str(FORMAT)


def header(
    data: Mapping[str, str], files: Mapping[str, str], triangles: Array, parts: IntArray
) -> Header:
    """The inverse of `metadata` and `attachments`.

    Raises:
        KeyError, ValueError: if something is missing or not what `metadata` writes
    """
    values: dict[str, Any] = {key: json.loads(text) for key, text in data.items()}
    return Header(
        name=values["name"],
        robot=files[ROBOT_FILE],
        scenario=files[SCENARIO_FILE],
        actuator_names=tuple(values["actuator_names"]),
        rate_limits=np.array(values["rate_limits"], dtype=np.float64).reshape(-1, 2),
        margin=values["margin"],
        dt=values["dt"],
        seed=values["seed"],
        versions=values["versions"],
        zone_triangles=triangles,
        zone_parts=parts,
        radii=np.array(values["radii"], dtype=np.float64),
        disk_indices=np.array(values["disk_indices"], dtype=np.int64),
        tubes=np.array(values["tubes"], dtype=np.int64).reshape(-1, 2),
        signals=tuple(values["signals"]),
        tick=values["tick"],
    )
