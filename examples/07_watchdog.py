"""The controller as a watchdog: the hand pushes through the wall, the whole robot stays inside."""

from pathlib import Path

import numpy as np

import sinuous as sn

scenarios = Path(__file__).parent / "scenarios"
for name in ("watchdog", "jointed_teleop"):
    scenario = sn.load_scenario(scenarios / f"{name}.toml")
    run = sn.run(scenario).recording
    hand = scenario.teleop.mapping.origin + run.signal("sent_m") @ scenario.teleop.mapping.axes.T
    margin = scenario.mpc.margin
    still = np.linalg.norm(run.signal("sent_m_s"), axis=1) < 0.01
    felt = np.linalg.norm(run.signal("felt_n")[still], axis=1)
    print(f"{scenario.robot.name}, delay {scenario.teleop.table.delay:g} s each way:")
    print(f"  hand: as far as {-scenario.zone.clearance(hand).min() * 1e3:.1f} mm beyond a wall")
    print(f"  body: at least {run.nominal_clearance.min() * 1e3:.2f} mm from every wall, ", end="")
    print(f"{margin * 1e3:g} mm asked for")
    print(f"  felt while the hand hardly moves: up to {felt.max():.2f} N")
