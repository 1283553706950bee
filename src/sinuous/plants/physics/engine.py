"""The physics engine: the one place that runs MuJoCo, and refuses to go on after a fault."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.plants.plant import NO_CONTACT, Contacts, PlantFault


def require_mujoco() -> Any:
    """MuJoCo, which comes with the extra `physics`.

    Raises:
        InputError: naming the extra, if it is not installed
    """
    try:
        import mujoco
    except ImportError as error:
        raise InputError(
            file="physics",
            expected="the package mujoco",
            found="that it is not installed",
            remedy="Install what physics needs: pip install sinuous[physics]",
        ) from error
    return mujoco


class PhysicsFault(PlantFault):
    """The engine met something that is no physics: the run has failed."""


class Ticks(NamedTuple):
    """What happened during some ticks.

    Arguments:
        lengths, speeds: of the tendons (T, C) at the start of every tick [m], [m/s]
        contacts: the worst of all ticks
    """

    lengths: Array
    speeds: Array
    contacts: Contacts


class Engine:
    """Steps a compiled model; every number it yields is one that the engine vouches for.

    MuJoCo answers a number that is not finite with a warning on the terminal and by going back
    to where it started. Its going back is turned off here (`prepare`), and any warning is a fault.

    Arguments:
        model: compiled, its options as `prepare` makes them
    """

    def __init__(self, model: Any) -> None:
        self._mujoco = require_mujoco()
        self.model, self.data = model, self._mujoco.MjData(model)
        self._warned = self.data.warning
        self._force = np.zeros(6)

    @staticmethod
    def prepare(spec: Any, *, tick: float, gravity: tuple[float, float, float]) -> None:
        """Set the options of a model (MjSpec) before it is compiled.

        The integrator "discrete" takes stiff cables and contacts implicitly, so that long
        ticks stay stable.
        """
        mujoco = require_mujoco()
        spec.option.timestep = tick
        spec.option.gravity = gravity
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
        # With a few contacts on a long chain Newton's method is five times slower.
        spec.option.solver = mujoco.mjtSolver.mjSOL_CG
        spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET

    def push(self, body: str, force: Array) -> None:
        """Let a force (3,) [N] in the world act on a body from now on, at its centre of mass."""
        self.data.body(body).xfrc_applied[:3] = force

    def run(self, controls: Array, tick: float, place: Callable[[int], None]) -> Ticks:
        """Make T ticks of `tick` [s] each.

        Arguments:
            controls: inputs of the actuators (T, C) [m]
            place: called before every tick with its number

        Raises:
            PhysicsFault: if the engine warned, or a position or velocity is not finite
        """
        data, mujoco, contacts = self.data, self._mujoco, NO_CONTACT
        lengths = np.empty((len(controls), len(data.ten_length)))
        speeds = np.empty_like(lengths)
        self.model.opt.timestep = tick
        # What MuJoCo warns of is kept, in place of its terminal and its log file.
        said, before = list[str](), mujoco.get_mju_user_warning()
        mujoco.set_mju_user_warning(said.append)
        try:
            for k, control in enumerate(controls):
                place(k)
                data.ctrl = control
                mujoco.mj_step(self.model, data)
                lengths[k], speeds[k] = data.ten_length, data.ten_velocity  # of the tick's start
                if data.ncon:
                    contacts = contacts.worst(self._contacts())
            mujoco.mj_kinematics(self.model, data)  # a step moves joints and leaves frames behind
        finally:
            mujoco.set_mju_user_warning(before)
        self._check(said)
        return Ticks(lengths, speeds, contacts)

    def _check(self, said: list[str]) -> None:
        if self._warned.number.any():
            raise PhysicsFault(f"the physics failed: MuJoCo warns {'; '.join(said)}")
        if not (np.isfinite(self.data.qpos).all() and np.isfinite(self.data.qvel).all()):
            raise PhysicsFault("the physics failed: a position or velocity is not a finite number")

    def _contacts(self) -> Contacts:
        """What touched during the last tick."""
        depth, largest, total = 0.0, 0.0, 0.0
        for i, distance in enumerate(self.data.contact.dist.tolist()):
            self._mujoco.mj_contactForce(self.model, self.data, i, self._force)
            normal = float(self._force[0])
            depth, largest, total = max(depth, -distance), max(largest, normal), total + normal
        return Contacts(depth, largest, total)
