"""Stiff springs and cables over long ticks, at the cost of one factorisation.

MuJoCo's integrator "discrete" takes the stiffness K of springs and cables at the end of a tick h:

    (M + h D + h^2 K) a = f(q, v) - h K v.

It solves that by iterations, for a chain of links a dozen or more, each as expensive as the
mass matrix is large. "implicitfast" solves (M + h D') a = f(q) - D' v directly, and with
D' = D + h K that is the same equation. It differs in contacts alone, whose forces it computes as if
nothing but the masses resisted, and which it does not survive; with walls, "discrete" it must be.
With D', the force that the engine tells of a cable is that at the end of the tick.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.plants.physics.engine import require_mujoco


@dataclass(frozen=True, kw_only=True, eq=False)
class ImplicitSprings:
    """Makes a model's springs implicit.

    Arguments:
        damping: of its hinges (n,) [N m s/rad]
        cable_damping: of its cables [N s/m]
    """

    damping: Array
    cable_damping: float

    def take(self, model: Any, *, walls: bool) -> None:
        """Set integrator and damping for the next tick.

        Arguments:
            model: compiled; every joint is a hinge, every actuator a cable
            walls: whether there is anything to touch
        """
        kinds = require_mujoco().mjtIntegrator
        h = 0.0 if walls else float(model.opt.timestep)
        model.opt.integrator = kinds.mjINT_DISCRETE if walls else kinds.mjINT_IMPLICITFAST
        model.dof_damping[:] = self.damping + h * model.jnt_stiffness
        model.actuator_biasprm[:, 2] = np.negative(
            self.cable_damping + h * model.actuator_gainprm[:, 0]
        )
