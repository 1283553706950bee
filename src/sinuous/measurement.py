"""What a controller gets to see of a robot."""

from dataclasses import dataclass, field

import numpy as np

from sinuous.arrays import Array

# What a measurement says nothing about, shared by all of them.
NOWHERE, NO_COVARIANCE, AT_THE_TIP = np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(3)
NO_TENSIONS = np.zeros(0)
for _constant in (NOWHERE, NO_COVARIANCE, AT_THE_TIP, NO_TENSIONS):
    _constant.setflags(write=False)


@dataclass(frozen=True, kw_only=True, eq=False)
class Measurement:
    """What sensors say about the robot. Positions are in the world frame.

    Arguments:
        tip: position (3,) of the tip, or of a coil beyond it [m]
        lengths: actuator lengths (P,) by the encoders [m], always of this moment
        points: guarded body points (S, 3) [m]; (0, 3) if only the tip is measured
        covariance: of each of the points (S, 3, 3) [m^2]; (0, 3, 3) if it is not known
        coil: where `tip` is measured, in the frame of the tip (3,) [m]
        age: time since `tip` and `points` were taken [s]
        tensions: of the cables (C,) [N], in the order of the actuators; (0,) if not measured
    """

    tip: Array
    lengths: Array
    points: Array = field(default_factory=lambda: NOWHERE)
    covariance: Array = field(default_factory=lambda: NO_COVARIANCE)
    coil: Array = field(default_factory=lambda: AT_THE_TIP)
    age: float = 0.0
    tensions: Array = field(default_factory=lambda: NO_TENSIONS)

    @property
    def has_shape(self) -> bool:
        """Whether the whole body was measured."""
        return len(self.points) > 0
