"""What is fitted: blocks of numbers, each with a prior that keeps it physical."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sinuous.arrays import Array
from sinuous.robots.pcc import PccRobot

# Cable stiffness that one starts from, as k r^2 L / EI of a mean segment: cables lose a tenth of
# their travel.  A factor of seven either way is a standard deviation.
STIFFNESS, STIFFNESS_SPREAD = 4.0, 2.0
# Friction that one starts from, as the bend that it holds in a segment without cables [rad].
FRICTION, FRICTION_SPREAD = 0.03, 1.5


@dataclass(frozen=True, kw_only=True)
class Block:
    """Numbers of one kind.

    Arguments:
        name: in reports
        size: how many
        start: what one starts from, and expects
        spread: standard deviation of the prior
        low, high: bounds
    """

    name: str
    size: int
    start: float = 0.0
    spread: float
    low: float = -np.inf
    high: float = np.inf


@dataclass(frozen=True, kw_only=True, eq=False)
class Parameters:
    """All blocks in a row, x (n,)."""

    blocks: tuple[Block, ...]

    @cached_property
    def _slices(self) -> dict[str, slice]:
        ends = np.cumsum([block.size for block in self.blocks])
        return {
            block.name: slice(int(end) - block.size, int(end))
            for block, end in zip(self.blocks, ends, strict=True)
        }

    def __len__(self) -> int:
        return sum(block.size for block in self.blocks)

    def place(self, name: str) -> slice:
        """Where a block stands in x; empty if it is not fitted."""
        return self._slices.get(name, slice(0, 0))

    def values(self, x: Array, name: str) -> Array:
        """Numbers of a block."""
        return x[self.place(name)]

    def _all(self, field: str) -> Array:
        return np.concatenate(
            [np.full(b.size, getattr(b, field), dtype=float) for b in self.blocks]
        )

    @property
    def start(self) -> Array:
        """Expected values (n,)."""
        return self._all("start")

    @property
    def spread(self) -> Array:
        """Standard deviations of the priors (n,)."""
        return self._all("spread")

    @property
    def bounds(self) -> tuple[Array, Array]:
        """Lowest and highest values (n,)."""
        return self._all("low"), self._all("high")


def parameters(robot: PccRobot, *, own_zeros: bool) -> Parameters:
    """What is fitted to a robot.

    Arguments:
        robot: as its file says
        own_zeros: whether there are single pulls, for which every cable was let go: it comes to
            lie anew on its spool, so they have zeros of their own
    """
    segments, cables = len(robot.segments), len(robot.actuator_names)
    pitch = float(np.mean(np.concatenate([segment.pitch_radii for segment in robot.segments])))
    zeros = (
        Block(name="pulls_slack", size=cables, spread=0.2 * pitch, low=-pitch, high=pitch)
        if own_zeros
        else None
    )
    blocks = (
        Block(name="base_rotation", size=3, spread=0.5),
        Block(name="base_position", size=3, spread=20e-3),
        Block(name="marker", size=3, spread=5e-3),
        Block(name="log_pitch", size=1, spread=0.1, low=-0.7, high=0.7),
        Block(name="log_spool", size=cables, spread=0.03, low=-0.3, high=0.3),
        Block(name="turn", size=segments - 1, spread=np.deg2rad(5.0), low=-0.5, high=0.5),
        Block(name="twist", size=segments - 1, spread=np.deg2rad(10.0), low=-1.0, high=1.0),
        Block(name="log_stiffness", size=1, start=np.log(STIFFNESS), spread=STIFFNESS_SPREAD),
        Block(name="slack", size=cables, spread=0.1 * pitch, low=-pitch, high=pitch),
        zeros,
        Block(name="rest_bend", size=2 * segments, spread=0.1, low=-1.0, high=1.0),
        Block(name="log_friction", size=1, start=np.log(FRICTION), spread=FRICTION_SPREAD),
        Block(name="play", size=1, spread=0.05 * pitch, low=0.0, high=pitch),
    )
    return Parameters(blocks=tuple(block for block in blocks if block and block.size))
