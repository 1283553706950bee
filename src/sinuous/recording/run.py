"""What is known about a run: its header, one control step, and all steps stacked."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Self

import numpy as np

from sinuous.arrays import Array, ArrayLike, IntArray
from sinuous.control.report import Status


class ZonePart(IntEnum):
    """What a triangle of the zone stands for."""

    WALL = 0  # of the passage
    GUIDE = 1  # of the passage's straight continuation before an entrance
    KEEP_OUT = 2  # of an obstacle in the passage


def status_name(status: Status) -> str:
    """How a sample writes a status: tracking, at_target, blocked, recovering or holding."""
    return status.name.lower()


@dataclass(frozen=True, kw_only=True, eq=False)
class Header:
    """Everything about a run that does not change while it runs."""

    name: str
    robot: str  # the robot file, TOML text
    scenario: str  # the scenario file, TOML text
    actuator_names: tuple[str, ...]  # (P,)
    rate_limits: Array  # (P, 2) slowest and fastest rate of each actuator [m/s]
    margin: float  # required body clearance [m]
    dt: float  # control period [s]
    seed: int
    versions: dict[str, str]  # package name -> version
    zone_triangles: Array  # (T, 3, 3) corners in the mesh's frame [m]; T = 0 in free space
    zone_parts: IntArray  # (T,) the `ZonePart` of each triangle
    radii: Array  # (S,) body radius at each of the body points [m]
    disk_indices: IntArray  # (D,) which of the body points are disk centres
    # (T, 2) first and last body point of every rigid tube
    tubes: IntArray = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    signals: tuple[str, ...] = ()  # (C,) what is recorded at every tick, each with its unit
    tick: float = 0.0  # time between ticks [s]


@dataclass(frozen=True, kw_only=True, eq=False)
class Sample:
    """One control step, or a few of a fast controller. Positions are in the mesh's frame."""

    time: float  # simulated time [s], zero or later
    target: Array  # (3,) [m]

    configuration: Array  # (n,) nominal, robot coordinates
    lengths: Array  # (P,) nominal actuator lengths [m]
    rates: Array  # (P,) commanded actuator rates [m/s]
    nominal_points: Array  # (S, 3) body points of the model [m]
    nominal_tip: Array  # (3,) [m]
    nominal_clearance: float  # least clearance of the body surface [m], inf in free space

    local_rates: Array  # (P,) part of the rates that a local controller added [m/s]
    clipped: float  # share of the rates asked for that limits took, 0 to 1
    offset: Array  # (3,) of the tip, as the controller learned it [m]

    measured_points: Array  # (S, 3) body points as sensors see them [m]; (0, 3) if they do not
    measured_tip: Array  # (3,) the tip, or the coil beyond it, as sensors see it [m]
    measured_lengths: Array  # (P,) [m]
    actual_points: Array  # (S, 3) body points of the plant [m]
    actual_tip: Array  # (3,) [m]
    actual_clearance: float  # as nominal_clearance, of the plant's body [m]

    status: str  # as `status_name` writes it
    solve_time: float  # wall-clock time the controller took [s]
    iterations: int
    planes: int  # triangle planes in the problem
    step_fraction: float  # how much of the planned step the safety filter let through, 0 to 1
    active: tuple[str, ...]  # what limits the robot right now, for people

    tensions: Array = field(default_factory=lambda: np.zeros(0))  # (C,) of the plant's cables [N]
    # deepest penetration of walls [m], largest and total force [N] since the last sample
    contacts: Array = field(default_factory=lambda: np.zeros(3))
    pushed: int = 0  # body point of the model that walls push the most
    # (3,) on it by the constraints, for a tip on the spring of the virtual walls [N]
    body_force: Array = field(default_factory=lambda: np.zeros(3))
    signals: Array = field(default_factory=lambda: np.zeros((0, 0)))  # (k, C) of the ticks


@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """All steps of a run; each field of `Sample`, stacked along a first axis of K steps."""

    header: Header
    complete: bool  # False if the file was cut off; all steps up to the cut are here

    time: Array  # (K,) [s]
    target: Array  # (K, 3) [m]

    configuration: Array  # (K, n)
    lengths: Array  # (K, P) [m]
    rates: Array  # (K, P) [m/s]
    nominal_points: Array  # (K, S, 3) [m]
    nominal_tip: Array  # (K, 3) [m]
    nominal_clearance: Array  # (K,) [m]

    local_rates: Array  # (K, P) [m/s]
    clipped: Array  # (K,)
    offset: Array  # (K, 3) [m]

    measured_points: Array  # (K, S, 3) [m]
    measured_tip: Array  # (K, 3) [m]
    measured_lengths: Array  # (K, P) [m]
    actual_points: Array  # (K, S, 3) [m]
    actual_tip: Array  # (K, 3) [m]
    actual_clearance: Array  # (K,) [m]

    status: tuple[str, ...]  # (K,)
    solve_time: Array  # (K,) [s]
    iterations: IntArray  # (K,)
    planes: IntArray  # (K,)
    step_fraction: Array  # (K,)
    active: tuple[tuple[str, ...], ...]  # (K,)

    tensions: Array  # (K, C) [N]; (K, 0) of plants that do not know them
    contacts: Array  # (K, 3) penetration [m], largest and total force [N]

    signals: Array  # (T, C) of all ticks

    pushed: IntArray = field(default_factory=lambda: np.zeros(0, dtype=np.int64))  # (K,)
    body_force: Array = field(default_factory=lambda: np.zeros((0, 3)))  # (K, 3) [N]

    def signal(self, name: str) -> Array:
        """One signal at all ticks (T,), or all with that stem (T, A): "leader_m_x", "leader_m"."""
        names = self.header.signals
        if name in names:
            return self.signals[:, names.index(name)]
        columns = [k for k, one in enumerate(names) if one.rpartition("_")[0] == name]
        if not columns:
            raise KeyError(f"no signal {name}; there are {', '.join(names)}")
        return self.signals[:, columns]

    def __len__(self) -> int:
        return len(self.time)

    @classmethod
    def from_samples(
        cls, header: Header, samples: Sequence[Sample], *, complete: bool = True
    ) -> Self:
        """Stack samples, of a file or straight from a session."""
        p = len(header.actuator_names)
        return cls(
            header=header,
            complete=complete,
            time=_stack([s.time for s in samples], ()),
            target=_stack([s.target for s in samples], (3,)),
            configuration=_stack([s.configuration for s in samples], (0,)),
            lengths=_stack([s.lengths for s in samples], (p,)),
            rates=_stack([s.rates for s in samples], (p,)),
            nominal_points=_stack([s.nominal_points for s in samples], (0, 3)),
            nominal_tip=_stack([s.nominal_tip for s in samples], (3,)),
            nominal_clearance=_stack([s.nominal_clearance for s in samples], ()),
            local_rates=_stack([s.local_rates for s in samples], (p,)),
            clipped=_stack([s.clipped for s in samples], ()),
            offset=_stack([s.offset for s in samples], (3,)),
            measured_points=_stack([s.measured_points for s in samples], (0, 3)),
            measured_tip=_stack([s.measured_tip for s in samples], (3,)),
            measured_lengths=_stack([s.measured_lengths for s in samples], (p,)),
            actual_points=_stack([s.actual_points for s in samples], (0, 3)),
            actual_tip=_stack([s.actual_tip for s in samples], (3,)),
            actual_clearance=_stack([s.actual_clearance for s in samples], ()),
            status=tuple(s.status for s in samples),
            solve_time=_stack([s.solve_time for s in samples], ()),
            iterations=np.array([s.iterations for s in samples], dtype=np.int64),
            planes=np.array([s.planes for s in samples], dtype=np.int64),
            step_fraction=_stack([s.step_fraction for s in samples], ()),
            active=tuple(s.active for s in samples),
            tensions=_stack([s.tensions for s in samples], (0,)),
            contacts=_stack([s.contacts for s in samples], (3,)),
            pushed=np.array([s.pushed for s in samples], dtype=np.int64),
            body_force=_stack([s.body_force for s in samples], (3,)),
            signals=_join([s.signals for s in samples if s.signals.size], len(header.signals)),
        )


def _join(blocks: Sequence[Array], columns: int) -> Array:
    """Put blocks of rows one below the other."""
    return np.concatenate([np.zeros((0, columns)), *blocks])


def _stack(rows: Sequence[ArrayLike], shape: tuple[int, ...]) -> Array:
    """Stack rows; without any, an empty array whose rows would have that shape."""
    if not rows:
        return np.empty((0, *shape))
    return np.array(rows, dtype=np.float64)
