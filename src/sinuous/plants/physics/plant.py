"""A robot in a physics engine, wound by motors that follow what they are told."""

from math import ceil

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.measurement import NO_TENSIONS, Measurement
from sinuous.plants.physics.assembly import GRAVITY, TICK, assembled, compiled
from sinuous.plants.physics.build import physical_body
from sinuous.plants.physics.engine import Engine, PhysicsFault
from sinuous.plants.physics.implicit_springs import ImplicitSprings
from sinuous.plants.physics.walls import Walls
from sinuous.plants.plant import Truth
from sinuous.robots.robot import Robot

SETTLING = 1.0  # for how long the robot comes to rest in its start [s]
# Walls closer than that, and this many times as far as the body moved in the last step, count [m].
NEAR, FASTER = 1e-3, 3.0
FLIP = 0.5  # cables that change by more than that up and down from tick to tick [N] are calmed
CALMING, FINE = 2.0, 1e-3  # for so long, by such ticks [s]
ROUNDING = 1e-9  # by which a period may exceed a whole number of ticks


class PhysicsPlant:
    """Winds the cables of a physical robot and lets physics do the rest.

    A motor moves as it is told, within its speed limits. Between motor and robot the cable has
    play, stretches, and cannot push; what is measured of it is the motor's side, as an encoder
    does. Cables start in the middle of their play and the robot at rest, so that it hangs at the
    start as its weight makes it.

    After every step `tensions` (C,) [N] are those at the start of its last tick, `slack` (C,) tells
    which cables had none at any of its ticks, `contacts` is the worst of its ticks and
    `worst_contacts` that of the whole run. `fault` is what ended the run, if anything did.

    Arguments:
        robot: with its mechanics, which say what it is made of
        gravity: in the world [m/s^2]
        walls: what the robot collides with
        payload: mass at the tip [kg]
        tip_force: on the tip, in the world [N]
        start: configuration (n,) that the actuators start from, by default the robot's home
        tick: longest of the engine's ticks [s]; a step is a whole number of equal ones, shorter
            while cables flip from tick to tick
        tension_sensors: whether tensions are measured

    Raises:
        ValueError: if a number makes no sense
        InputError: if MuJoCo is not installed, or cannot hold the robot
        PhysicsFault: if the robot cannot even come to rest
    """

    def __init__(
        self,
        robot: Robot,
        *,
        gravity: tuple[float, float, float] = GRAVITY,
        walls: Walls | None = None,
        payload: float = 0.0,
        tip_force: tuple[float, float, float] = (0.0, 0.0, 0.0),
        start: ArrayLike | None = None,
        tick: float = TICK,
        tension_sensors: bool = True,
    ) -> None:
        if not 0.0 < tick < np.inf or not 0.0 <= payload < np.inf:
            raise ValueError(f"a tick is positive, a payload zero or more, not {tick}, {payload}")
        if not np.all(np.isfinite([*gravity, *tip_force])):
            raise ValueError("gravity and tip force must be finite")
        self.robot, self.tick = robot, min(tick, TICK)  # to settle
        self._tension_sensors = tension_sensors
        self.fault: PhysicsFault | None = None
        self._body = body = physical_body(robot)
        self._cable = body.mechanics
        self._rough, self._pulls = 0.0, np.zeros((0, len(body.cables)))
        self._slowest, self._fastest = robot.rate_limits.T
        spec = assembled(body, gravity=gravity, payload=payload, walls=walls, tick=tick)
        self._engine = Engine(compiled(spec))
        self._walls, self._winding = walls, np.zeros(len(body.cables))
        self._springs = ImplicitSprings(
            damping=self._engine.model.dof_damping.copy(), cable_damping=self._cable.damping
        )
        self._engine.push(body.tip_body, np.array(tip_force, dtype=float))
        c = robot.home if start is None else np.asarray(start, dtype=float)
        self._lengths = robot.lengths(c)
        self._wound = body.cable_lengths(self._lengths)  # the cables behind their play
        body.pose(self._engine.model, self._engine.data, c)
        self._run(np.zeros(len(self._lengths)), SETTLING, near=walls is not None)
        self.tick, self.worst_contacts = tick, self.contacts
        self.truth = self._look()
        self._before = self.truth.points

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure.

        Raises:
            PhysicsFault: if the engine failed, now or before
        """
        possible = np.minimum(np.maximum(rates, self._slowest), self._fastest)
        self._run(possible, dt, near=self._near_walls())
        self.worst_contacts = self.worst_contacts.worst(self.contacts)
        self.truth = t = self._look()
        return Measurement(
            points=t.points,
            tip=t.points[-1],
            lengths=t.lengths,
            tensions=t.tensions if self._tension_sensors else NO_TENSIONS,
        )

    def _run(self, rates: Array, dt: float, *, near: bool) -> None:
        if self.fault is not None:
            raise self.fault
        longest = min(self.tick, FINE) if self._rough > 0.0 else self.tick
        ticks = ceil(dt / longest - ROUNDING)
        h = dt / ticks
        motors = self._lengths + np.arange(1, ticks + 1)[:, None] * (h * rates)
        before = self._wound, self._winding
        wound, winding = self._wind(motors, h)
        model, data, body, cable = self._engine.model, self._engine.data, self._body, self._cable
        model.opt.timestep = h
        self._springs.take(model, walls=near)
        # The engine's actuator is damped by the robot's side alone: lead by what the motor's does.
        controls = wound - cable.pretension + cable.damping / cable.stiffness * winding
        try:
            done = self._engine.run(controls, h, lambda k: body.place(model, data, motors[k]))
        except PhysicsFault as fault:
            self.fault = fault
            raise
        self._lengths, self.contacts = motors[-1], done.contacts
        # Robot and motors at the start of every tick.
        wound, winding = (
            np.concatenate([a[None], b[:-1]]) for a, b in zip(before, (wound, winding), strict=True)
        )
        stretch = done.lengths - wound + cable.pretension
        pull = cable.stiffness * stretch + cable.damping * (done.speeds - winding)
        self._watch(pull, dt)
        self.tensions = np.maximum(pull[-1], 0.0)
        self.slack = np.asarray(np.any(pull <= 0.0, axis=0))

    def _wind(self, motors: Array, h: float) -> tuple[Array, Array]:
        """Lengths (T, C) [m] to which cables are wound, and how fast that grows [m/s].

        A motor moves one way within a step, so that the play of each tick can be taken from the
        step's start.

        Arguments:
            motors: lengths (T, P) [m] at the end of every tick
            h: tick [s]
        """
        wanted, half = self._body.cable_lengths(motors), 0.5 * self._cable.play
        wound = np.minimum(np.maximum(self._wound, wanted - half), wanted + half)
        before = np.concatenate([self._wound[None], wound[:-1]])
        winding = (wound - before) / h
        self._wound, self._winding = wound[-1], winding[-1]
        return wound, winding

    def _watch(self, pull: Array, dt: float) -> None:
        """Take short ticks for a while where cables pull in every other tick.

        A long robot of many links does that in some postures with ticks of 3 ms and more: no cable
        can, and the engine does not notice.
        """
        self._rough = max(self._rough - dt, 0.0)
        self._pulls = np.concatenate([self._pulls, pull])[-4:]
        change = np.diff(self._pulls, axis=0)
        if len(change) == 3 and np.any(np.all(change[1:] * change[:-1] < -(FLIP**2), axis=0)):
            self._rough, self._pulls = CALMING, self._pulls[:0]

    def _near_walls(self) -> bool:
        """Whether the robot may touch a wall during the next step: the engine is slower then."""
        if self._walls is None:
            return False
        points = self.truth.points
        moved = float(np.max(np.linalg.norm(points - self._before, axis=1)))
        self._before = points
        room = np.min(self._walls.zone.clearance(points) - self.robot.radii)
        return bool(room < NEAR + FASTER * moved)

    def _look(self) -> Truth:
        points, T_w_t = self._body.shape(self._engine.data)
        return Truth(
            points=points,
            T_w_t=T_w_t,
            lengths=self._lengths,
            tensions=self.tensions,
            contacts=self.contacts,
        )
