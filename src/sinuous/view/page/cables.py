"""Cables from hole to hole, wherever the body is."""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.robots.cables import cable_rows
from sinuous.robots.chain_kernels import ARC
from sinuous.robots.robot import Robot
from sinuous.view.page.frames import Frames


class _Hole(NamedTuple):
    """A place on a cable: `offset` (3,) [m] from a point, in the frame of a point."""

    point: int
    frame: int
    offset: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Cables:
    """All holes of a robot's cables.

    Arguments:
        frames: along the body
        stations: points whose frames are needed (F,), ascending
        point: next to which each hole is (V,)
        frame: number of the station in whose frame it is (V,)
        offset: in that frame (V, 3) [m]
        ends: holes that each straight stretch joins (N, 2)
        cable: to which the stretch belongs (N,)
    """

    frames: Frames
    stations: IntArray
    point: IntArray
    frame: IntArray
    offset: Array
    ends: IntArray
    cable: IntArray

    @classmethod
    def of(cls, robot: Robot) -> Self:
        """Those of a robot, in the order of its actuators."""
        frames = Frames.of(robot)
        paths = [_on_arcs(robot, k) + _on_joints(robot, frames, k) for k in cable_rows(robot)]
        holes = [hole for path in paths for hole in path]
        first = np.cumsum([0, *(len(path) for path in paths)])
        stretches = [
            (first[k] + i, k) for k, path in enumerate(paths) for i in range(len(path) - 1)
        ]
        start = np.array([i for i, _ in stretches], dtype=np.int64)
        stations = np.unique(np.array([hole.frame for hole in holes], dtype=np.int64))
        return cls(
            frames=frames,
            stations=stations,
            point=np.array([hole.point for hole in holes], dtype=np.int64),
            frame=np.searchsorted(stations, [hole.frame for hole in holes]).astype(np.int64),
            offset=np.array([hole.offset for hole in holes]).reshape(-1, 3),
            ends=np.stack([start, start + 1], axis=1),
            cable=np.array([k for _, k in stretches], dtype=np.int64),
        )

    def stretches(self, points: Array, along: Array) -> Array:
        """Both ends (N, 2, 3) [m] of all stretches, given body points and directions (S, 3)."""
        R = self.frames.at(along, self.stations)[self.frame]
        places = points[self.point] + np.einsum("vij,vj->vi", R, self.offset)
        return places[self.ends]


def _on_arcs(robot: Robot, k: int) -> list[_Hole]:
    """The holes of actuator k in the disks of bending segments.

    A bend shortens a cable by its distance from the backbone in the plane of the bend, so the
    slope of the length gives the hole.  Before its own segment it runs as it does there.
    """
    chain, A = robot.chain, robot.routing.A
    arcs = np.flatnonzero(chain.turns == ARC)
    levers = {int(m): -A[k, chain.theta_column[m] : chain.theta_column[m] + 2] for m in arcs}
    passed = [m for m, lever in levers.items() if np.any(lever != 0.0)]
    if not passed:
        return []
    own = max(passed)
    on = np.flatnonzero((chain.turns[chain.section] == ARC) & (chain.section <= own))
    places = {int(max(on[0] - (chain.section[on[0]] != chain.section[0]), 0)), int(on[-1])}
    places |= {int(s) for s in np.intersect1d(on, robot.disk_indices)}
    holes = list[_Hole]()
    for s in sorted(places):
        lever = levers.get(int(chain.section[s]), levers[own])
        lever = lever if np.any(lever != 0.0) else levers[own]
        holes.append(_Hole(s, s, np.append(lever, 0.0)))
    return holes


def _on_joints(robot: Robot, frames: Frames, k: int) -> list[_Hole]:
    """The holes of actuator k in the plates before and after every joint, and where it ends."""
    routing, holes, rest = robot.routing, list[_Hole](), float(robot.routing.b[k])
    crossings = range(routing.first[k], routing.first[k + 1])
    for x in crossings:
        after = frames.joint_columns[int(routing.column[x])]
        if holes:
            apart = robot.points(robot.home)[[holes[-1].point, after - 1]]
            along = frames.joints[after].after @ (holes[-1].offset + routing.before[x])
            rest -= float(np.linalg.norm(apart[1] - apart[0])) - float(along)
        holes.append(_Hole(after - 1, after - 1, -routing.before[x]))
        holes.append(_Hole(after - 1, after, routing.after[x]))
    if holes:
        last = holes[-1]
        holes.append(last._replace(offset=last.offset + rest * frames.joints[last.frame].after))
    return holes
