"""A scenario as a value: everything a session needs, built and in SI."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.control.controller import Controller
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.kinematic import Disturbance, KinematicPlant
from sinuous.plants.mismatched import Mismatch, MismatchedPlant
from sinuous.plants.plant import Plant
from sinuous.robots.robot import Robot
from sinuous.scenario.path import Leg
from sinuous.scenario.teleop import Teleoperation


@dataclass(frozen=True, kw_only=True, eq=False)
class Scenario:
    """One task for one robot.

    Arguments:
        name: what to call it
        mpc: the shape-constrained controller; robot, zone, margin and time step are its own
        law: makes the controller that runs from it, None for the mpc itself
        path: where the tip shall go, leg by leg
        start: configuration (n,), by default the robot's home
        seed: of everything random
        recover: whether the start may be closer to a wall than the margin, or beyond it
        disturbance: of the plant, None for an exact one
        mismatch: of the plant, None for one whose shapes are the model's
        encoder_step: what the encoders resolve [m]; above zero nothing else is measured
        plant: makes the plant that stands in for the robot, None for a `KinematicPlant`
        sensor: wraps a plant, given the seed; None if everything is measured exactly
        teleop: the operator whose hand follows the path, None if the controller follows it
        file: where the scenario comes from, for messages and to run it again
        text: the scenario as TOML, every path in it absolute; empty if it comes from Python
        robot_text: the robot file's TOML; empty if the robot comes from Python

    Raises:
        ValueError: if there is no leg, or the start does not fit the robot
    """

    name: str
    mpc: ShapeConstrainedMPC
    path: tuple[Leg, ...]
    law: Callable[[ShapeConstrainedMPC], Controller[Any]] | None = None
    start: Array | None = None
    seed: int = 0
    recover: bool = False
    disturbance: Disturbance | None = None
    mismatch: Mismatch | None = None
    encoder_step: float = 0.0
    plant: Callable[[], Plant] | None = None
    sensor: Callable[[Plant, int], Plant] | None = None
    teleop: Teleoperation | None = None
    file: str = "scenario"
    text: str = ""
    robot_text: str = ""

    def __post_init__(self) -> None:
        if not self.path:
            raise ValueError("a scenario needs a path of one leg or more")
        start = self.first_configuration
        if start.shape != self.robot.home.shape or not np.all(np.isfinite(start)):
            raise ValueError(f"start must be {len(self.robot.home)} finite numbers")

    @cached_property
    def controller(self) -> Controller[Any]:
        """The controller that runs."""
        return self.mpc if self.law is None else self.law(self.mpc)

    @property
    def robot(self) -> Robot:
        """The robot, its base where it stands."""
        return self.mpc.robot

    @property
    def zone(self) -> SafeZone:
        """The room the robot may use."""
        return self.mpc.zone

    @property
    def first_configuration(self) -> Array:
        """Configuration (n,) to start from."""
        return self.robot.home if self.start is None else np.asarray(self.start, dtype=np.float64)

    def new_plant(self) -> Plant:
        """A plant at the start with its sensors, their random numbers from the seed."""
        plant = self._bare_plant()
        return plant if self.sensor is None else self.sensor(plant, self.seed)

    def _bare_plant(self) -> Plant:
        if self.plant is not None:
            return self.plant()
        if self.mismatch is not None:
            return MismatchedPlant(
                self.robot,
                seed=self.seed,
                mismatch=self.mismatch,
                start=self.first_configuration,
            )
        return KinematicPlant(
            self.robot,
            seed=self.seed,
            disturbance=self.disturbance,
            start=self.first_configuration,
            encoder_step=self.encoder_step,
        )
