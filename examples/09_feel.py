"""Where the force comes from: tracking error, closeness to walls, or what the constraints hold.

Given the name of a picture, it is drawn too.
"""

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import sinuous as sn
from sinuous.arrays import Array
from sinuous.geometry import shapes
from sinuous.recording import Recording
from sinuous.scenario import Scenario
from sinuous.scenario.path import timed_path
from sinuous.view.style import BLUE, DPI, GREY, STYLE, VERMILION

SCENARIOS = Path(__file__).parent / "scenarios"
SOURCES = {  # a force of one source alone
    "error": {"gain": 3.0, "constraints": False},
    "clearance": {"constraints": False, "nearness": 0.005},
    "constraints": {},
}
DELAY = 0.2  # one way, of both scenarios [s]
DEPTH = 0.03  # of the hand beyond the wall [m]
FAST, REST, PUSH, HOLD, AWAY = 1.5, 2.3, 5.3, 6.1, 7.6  # ends of parts [s]
RATE, STEPS = (1000, 100) if len(sys.argv) > 1 else (200, 50)  # [Hz]: a table alone is faster
SET = (
    f"teleop.rate_hz={RATE}",
    f"mpc.rate_hz={STEPS}",
    "teleop.operator.kind='trajectory'",
    "teleop.force.stiffness_n_m=100",
)
Z = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, kw_only=True)
class Felt:
    """What a source is like: depths of hand and desired point [m], force far away and felt [N]."""

    time: Array
    hand: Array
    desired: Array
    far: Array
    felt: Array
    run: Recording

    def during(self, first: float, last: float, lag: float = 0.0) -> slice:
        """Ticks of a part of the scene, a lag later."""
        return slice(*np.searchsorted(self.time, [first + lag, last + lag]))

    def energy(self, name: str) -> float:
        """That a part has taken in at the end [mJ]."""
        return 1e3 * float(self.run.signal(name)[-1])


def room() -> tuple[Scenario, Array, Array]:
    """The tip crosses an empty room, and then the hand goes 30 mm beyond its flat wall."""
    scenario = sn.load_scenario(SCENARIOS / "live_watchdog.toml", set=SET)
    box = shapes.box((0.24, 0.24, 0.2), centre=(0.0, 0.0, 0.1))
    mpc = replace(scenario.mpc, zone=sn.SafeZone.from_mesh(box, entrance=[0.0, 0.0, 0.0]))
    scenario = replace(scenario, mpc=mpc)
    stop = 0.12 - mpc.robot.required_distance(mpc.margin)[-1]
    return scenario, np.array([stop, 0.0, 0.075]), np.array([1.0, 0.0, 0.0])


def vessel() -> tuple[Scenario, Array, Array]:
    """The tip goes to where the forearm meets the beam, and the hand 30 mm further."""
    scenario = sn.load_scenario(SCENARIOS / "live_jointed.toml", set=SET)
    return scenario, np.array([0.0, 0.56, 0.19]), Z


def felt(scene: tuple[Scenario, Array, Array], source: str) -> Felt:
    """Run a scene with one source of force."""
    scenario, stop, along = scene
    assert scenario.teleop is not None
    table = scenario.teleop.table
    teleop = replace(
        scenario.teleop,
        mpc=scenario.mpc,
        table=replace(table, force=replace(table.force, **SOURCES[source])),
    )
    start = scenario.robot.tip(scenario.first_configuration)
    before, beyond = stop - 0.005 * along, stop + DEPTH * along
    times, places = [0.0, FAST, REST, PUSH, HOLD, AWAY], [start, before, before, beyond, beyond]
    path = timed_path(times, [*places, start], max_steps=60)
    run = sn.run(replace(scenario, teleop=teleop, path=path)).recording
    depth = (
        (teleop.mapping.origin + run.signal(name) @ teleop.mapping.axes.T - stop) @ along
        for name in ("sent_m", "desired_m")
    )
    far, near = (np.linalg.norm(run.signal(name), axis=1) for name in ("virtual_n", "felt_n"))
    time: Array = np.arange(len(far)) * np.float64(teleop.dt)
    return Felt(time=time, hand=next(depth), desired=next(depth), far=far, felt=near, run=run)


def draw(results: dict[tuple[str, str], Felt], file: str) -> None:
    """Both scenes over time, and the force over depth."""
    plt.rcParams.update(STYLE)
    figure, axes = plt.subplots(2, 3, figsize=(13.0, 6.4), layout="constrained", sharey="col")
    for row, scene in enumerate(("room", "vessel")):
        for color, source in zip((GREY, BLUE, VERMILION), SOURCES, strict=True):
            one = results[scene, source]
            push = one.during(REST, PUSH, DELAY)
            axes[row, 0].plot(one.time, one.far, color=color, label=source)
            axes[row, 1].plot(one.time, one.felt, color=color, label=source)
            axes[row, 2].plot(1e3 * one.desired[push], one.far[push], color=color, label=source)
        for ax in axes[row, :2]:
            ax.axvspan(REST, PUSH, color="#EFF2F4", zorder=0)
            ax.set_xlabel("time [s]")
        axes[row, 2].set_xlabel("desired point beyond the contact [mm]")
        axes[row, 0].set_ylabel("force at the robot's end [N]")
        axes[row, 1].set_ylabel("force on the hand [N]")
        axes[row, 2].set_ylabel("force at the robot's end [N]")
    axes[0, 0].set_title("the tip meets a flat wall")
    axes[1, 0].set_title("the forearm meets a beam, the tip is free")
    axes[0, 0].legend()
    figure.savefig(file, dpi=DPI)
    plt.close(figure)


results = dict[tuple[str, str], Felt]()
for name, scene in (("room", room()), ("vessel", vessel())):
    scenario = scene[0]
    print(f"{name}: {scenario.robot.name}, margin {1e3 * scenario.mpc.margin:g} mm")
    print("  source       on the way  pushed  back   clearance  channel  follower  operator")
    print("               [N]         [N]     [N]    [mm]       [mJ]     [mJ]      [mJ]")
    for source in SOURCES:
        one = results[name, source] = felt(scene, source)
        push = one.far[one.during(REST, PUSH, DELAY)]
        back = max(0.0, float(-np.diff(push).min()))
        drag = one.far[one.during(0.0, FAST, DELAY)].max()
        clearance = 1e3 * one.run.nominal_clearance.min()
        print(f"  {source:12} {drag:<11.2f} {push.max():<7.2f} {back:<6.3f} ", end="")
        print(f"{clearance:<10.3f} ", end="")
        print(*(f"{one.energy(part + '_j'):<8.1f}" for part in ("channel", "follower", "operator")))
if len(sys.argv) > 1:
    draw(results, sys.argv[1])
