"""A robot's model made whole: with pull-only cables, payload and walls, ready to be compiled."""

from typing import Any

from sinuous.errors import InputError
from sinuous.plants.physics.body import PhysicalBody
from sinuous.plants.physics.engine import Engine, require_mujoco
from sinuous.plants.physics.walls import Walls
from sinuous.robots.mechanics import CableMechanics

TICK = 0.002  # [s]
GRAVITY = (0.0, 0.0, -9.81)  # [m/s^2]
PAYLOAD_RADIUS = 0.005  # of the ball that a payload is [m]


def assembled(
    body: PhysicalBody,
    *,
    gravity: tuple[float, float, float] = GRAVITY,
    payload: float = 0.0,
    walls: Walls | None = None,
    tick: float = TICK,
) -> Any:
    """The model (MjSpec) of a robot in its surroundings.

    Arguments:
        gravity: in the world [m/s^2]
        payload: mass at the tip [kg]
        walls: what it may touch
        tick: of the engine [s]
    """
    spec = body.spec.copy()
    Engine.prepare(spec, tick=tick, gravity=gravity)
    for name in body.tendons:
        _add_cable(spec, name, body.mechanics)
    _add_payload(spec.body(body.tip_body), payload)
    if walls is not None:
        walls.add_to(spec)
    return spec


def _add_cable(spec: Any, name: str, cable: CableMechanics) -> None:
    """A spring and a damper between motor and robot that cannot push: f <= 0 in MuJoCo's sign."""
    mujoco = require_mujoco()
    actuator = spec.add_actuator(
        name=name, target=name, trntype=mujoco.mjtTrn.mjTRN_TENDON, forcelimited=True
    )
    actuator.set_to_position(kp=cable.stiffness, kv=cable.damping)
    actuator.forcerange = (-mujoco.mjMAXVAL, 0.0)


def _add_payload(tip: Any, mass: float) -> None:
    """A ball about the tip; without mass it still says where a tip force acts."""
    tip.explicitinertial = True
    tip.mass, tip.ipos = mass, (0.0, 0.0, 0.0)
    tip.inertia = [0.4 * mass * PAYLOAD_RADIUS**2] * 3


def compiled(spec: Any) -> Any:
    """The compiled model (MjModel).

    Raises:
        InputError: with MuJoCo's words, if it cannot hold the model
    """
    try:
        return spec.compile()
    except ValueError as error:
        raise InputError(
            file=spec.modelname,
            expected="a robot that MuJoCo can hold",
            found=" ".join(str(error).removeprefix("Error:").split()),
            remedy="Look at the masses and sizes in the robot's file.",
        ) from error
