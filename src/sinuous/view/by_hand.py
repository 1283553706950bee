"""What passed between an operator's hand and the robot: positions, forces and energy over time."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.recording import Recording
from sinuous.view.style import BLACK, BLUE, GREEN, ORANGE, SKY, TIME_LABEL, VERMILION
from sinuous.view.units import MM_PER_M

POSITIONS = {
    "sent_m": ("hand", SKY),
    "desired_m": ("desired, arrived", BLUE),
    "tip_m": ("tip", VERMILION),
}
FORCES = {"virtual_n": ("at the robot", BLUE), "felt_n": ("felt by the hand", VERMILION)}
ENERGIES = {"channel_j": ("channel", GREEN), "follower_j": ("robot and walls", ORANGE)}

MOST_POINTS = 20_000  # of a curve; more are not seen


def by_hand_height(recording: Recording) -> float:
    """Height of the figure [inch]."""
    return 2.4 * (len(axis_names(recording)) + 1) + 0.6


def axis_names(recording: Recording) -> list[str]:
    """Names of the axes that the hand moves the tip along."""
    stem = "tip_m_"
    return [name.removeprefix(stem) for name in recording.header.signals if name.startswith(stem)]


def draw_by_hand(figure: Figure, recording: Recording) -> None:
    """A row of positions and forces for every axis, and the energies below."""
    names = axis_names(recording)
    every = max(1, len(recording.signals) // MOST_POINTS)
    ticks = np.arange(1, len(recording.signals) + 1, dtype=np.float64)[::every]
    time = recording.header.tick * ticks
    panels = figure.subplots(len(names) + 1, 2, sharex=True)
    for row, axis in zip(panels, names, strict=False):
        for stem, (label, color) in POSITIONS.items():
            row[0].plot(
                time,
                recording.signal(f"{stem}_{axis}")[::every] * MM_PER_M,
                color=color,
                label=label,
            )
        row[0].set_ylabel(f"{axis} [mm]")
        for stem, (label, color) in FORCES.items():
            row[1].plot(time, recording.signal(f"{stem}_{axis}")[::every], color=color, label=label)
        row[1].set_ylabel(f"force along {axis} [N]")
    panels[0, 0].set_title("Positions on the robot's side")
    panels[0, 1].set_title("Virtual force, and what is felt of it")
    _error(panels[-1, 0], time, recording, every)
    for stem, (label, color) in ENERGIES.items():
        panels[-1, 1].plot(time, recording.signal(stem)[::every], color=color, label=label)
    panels[-1, 1].axhline(0.0, color=BLACK, linewidth=0.8)
    panels[-1, 1].set_ylabel("energy taken in [J]")
    for axes in panels[-1]:
        axes.set_xlabel(TIME_LABEL)
    for axes in (panels[0, 0], panels[0, 1], panels[-1, 1]):
        axes.legend(loc="best", ncols=3)


def _error(axes: Axes, time: Array, recording: Recording, every: int) -> None:
    error = recording.signal("desired_m") - recording.signal("tip_m")
    axes.plot(time, np.linalg.norm(error, axis=1)[::every] * MM_PER_M, color=VERMILION)
    axes.set_ylabel("tip to desired [mm]")
    axes.set_ylim(bottom=0.0)
