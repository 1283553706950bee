"""Figures of 2.2: the arm, the disc, paths through it, and times."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.axes3d import Axes3D

from sinuous.arrays import Array
from sinuous.papers.experiment import Data
from sinuous.papers.qin2020.runs import BOUNDARY
from sinuous.view.curves import LIMIT_DASH, write_plainly
from sinuous.view.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREEN,
    GREY,
    LIMIT,
    ORANGE,
    PALE,
    PALER,
    PURPLE,
    TIME_LABEL,
    VERMILION,
    YELLOW,
    save,
)  # fmt: skip
from sinuous.view.units import MM_PER_M, PERCENT

BENDS = "viridis"  # colours of bends
JOINT_COLORS = (PALER, PALE, "#BCC5CE")
"""Of the regions of the disc, the largest first."""


def draw(data: Data, folder: Path) -> list[Path]:
    """The arm, the planes, the way of joints and cables, the times."""
    return [
        save(folder / "fig5_poses.png", (11.0, 5.4), lambda f: _poses(f, data)),
        save(folder / "planes.png", (13.0, 4.6), lambda f: _planes(f, data)),
        save(folder / "paths.png", (13.0, 4.4), lambda f: _paths(f, data)),
        save(folder / "times.png", (8.0, 3.8), lambda f: _times(f, data["times"])),
    ]


def _poses(figure: Figure, data: Data) -> None:
    grid = figure.add_gridspec(1, 2, width_ratios=(1.25, 1.0))
    space = Axes3D(figure, grid[0], azim=-52, elev=18, proj_type="ortho")
    figure.add_axes(space)
    flat = figure.add_subplot(grid[1])
    radius, depth = data["disc"]["radius_m"] * MM_PER_M, data["disc"]["plane_m"] * MM_PER_M
    angle = np.linspace(0.0, 2.0 * np.pi, 181)
    rim = radius * np.stack([np.cos(angle), np.sin(angle)])
    space.plot(rim[0], np.full(len(angle), depth), rim[1], color=GREY, linewidth=1.0)
    for pose, color in zip(data["poses"], (BLACK, *CYCLE), strict=False):
        x, y, z = MM_PER_M * np.array(pose["joints_m"]).T
        reference = color == BLACK
        style: dict[str, Any] = {"color": color, "zorder": 3 if reference else 4}
        style |= {"linestyle": LIMIT_DASH} if reference else {}
        name = "reference pose" if reference else None
        space.plot(x, y, z, marker="o", markersize=4.0, linewidth=2.2, **style)
        flat.plot(x[-1], z[-1], marker="o", linestyle="none", color=color, label=name)
    span = BOUNDARY * MM_PER_M
    space.set(xlim=(-span, span), ylim=(0.0, depth), zlim=(-span, span))
    space.set(xlabel="x [mm]", ylabel="y [mm]", zlabel="z [mm]")
    space.set_box_aspect((2.0 * span, depth, 2.0 * span))
    spatial: tuple[Any, ...] = (space.xaxis, space.zaxis)
    for axis in spatial:
        axis.set_major_locator(MaxNLocator(3))
    space.set_title("The arm, and the disc its tip can reach", pad=0)
    _first_joint(flat, data["disc"])
    _square(flat)
    flat.set_title("First joint k that moves")
    figure.legend(loc="outside lower center", ncols=2)


def _first_joint(axes: Axes, disc: Data) -> None:
    """Regions of (11): discs, one inside the other, that touch at the reference point."""
    radius, regions = disc["radius_m"] * MM_PER_M, len(disc["share_by_k"])
    for k, color in zip(range(1, regions + 1), JOINT_COLORS, strict=False):
        inner = radius * (regions + 2 - k) / (regions + 1)
        axes.add_patch(Circle((0.0, radius - inner), inner, facecolor=color, zorder=0.5))
        axes.text(0.0, radius - 1.9 * inner, f"k = {k}", ha="center")
    axes.set_aspect("equal")
    axes.set(xlabel="x [mm]", ylabel="z [mm]")


def _square(axes: Axes) -> None:
    side = BOUNDARY * MM_PER_M
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]) * side
    axes.plot(*corners.T, color=LIMIT, linewidth=1.2, linestyle=LIMIT_DASH, label="boundary")
    axes.set(xlim=(-1.12 * side, 1.12 * side), ylim=(-1.12 * side, 1.12 * side))


def _planes(figure: Figure, data: Data) -> None:
    first, second, shares = figure.subplots(1, 3)
    limit = float(np.degrees(data["disc"]["bend_limit_rad"]))
    top = max(float(np.nanmax(_bend(one))) for one in data["maps"])
    norm = Normalize(15.0, top)
    for axes, field in zip((first, second), data["maps"], strict=True):
        side = MM_PER_M * np.array(field["side_m"])
        axes.pcolormesh(side, side, _bend(field), cmap=BENDS, norm=norm)
        axes.contour(side, side, _bend(field), levels=[limit], colors=[VERMILION], linewidths=1.6)
        _square(axes)
        axes.set_aspect("equal")
        axes.set(xlabel="x [mm]", ylabel="z [mm]")
        axes.set_title(f"χ = {np.degrees(field['chi_rad']):.1f}°")
    bar = figure.colorbar(ScalarMappable(norm, BENDS), ax=[first, second], shrink=0.9, aspect=30)
    bar.set_label("largest bend of a joint [deg]; the line is the limit")
    chi = np.degrees([row["chi_rad"] for row in data["by_chi"]])
    for key, label, color in (
        ("within_limit_share", "of the disc", BLUE),
        ("square_share", "of the square ±180 mm", VERMILION),
    ):
        share = PERCENT * np.array([row[key] for row in data["by_chi"]])
        shares.plot(chi, share, color=color, label=label)
    shares.axvline(float(np.degrees(data["disc"]["chi_rad"])), color=GREY, linewidth=1.0)
    shares.set(xlabel="χ [deg]", ylabel="reached within joint limits [%]", ylim=(0.0, 103.0))
    shares.legend(loc="lower left")
    shares.set_title("Other planes")


def _bend(field: Data) -> Array:
    return np.degrees(np.array(field["bend_rad"], dtype=np.float64))


def _paths(figure: Figure, data: Data) -> None:
    dots, rates, lag = figure.subplots(1, 3)
    found, step = data["continuity"], np.array(data["continuity"]["step_m"])
    dots.plot(step * MM_PER_M, found["change_rad"], linestyle="none", marker=".", color=BLUE,
              label=f"{found['paths']} straight paths")  # fmt: skip
    ends = np.array([step.min(), step.max()])
    bound = found["constant_rad_by_root_m"] * np.sqrt(ends)
    dots.plot(ends * MM_PER_M, bound, color=LIMIT, linestyle=LIMIT_DASH, label="C √step")
    dots.set(xscale="log", yscale="log", xlabel="step of the target [mm]")
    dots.set(ylabel="largest change of an angle [rad]", title="Continuous, not smooth")
    dots.legend(loc="upper left")
    moving = data["rates"]
    time = moving["period_s"] * np.arange(len(moving["fastest_cable_m_s"]))
    fastest = MM_PER_M * np.array(moving["fastest_cable_m_s"])
    rates.plot(time, fastest, color=BLUE, label="exactly on the path")
    for row, color in zip(moving["limited"], (GREEN, ORANGE), strict=True):
        speed = MM_PER_M * row["cable_speed_m_s"]
        rates.axhline(speed, color=color, linestyle=LIMIT_DASH, label=f"limit {speed:.0f} mm/s")
        error = MM_PER_M * np.array(row["tip_error_m"])
        lag.plot(moving["period_s"] * np.arange(len(error)), error, color=color)
    rates.set(xlabel=TIME_LABEL, ylabel="fastest cable [mm/s]", ylim=(0.0, None))
    rates.set_title(f"Tip at {MM_PER_M * moving['speed_m_s']:.0f} mm/s")
    rates.legend(loc="upper left")
    lag.set(xlabel=TIME_LABEL, ylabel="tip error [mm]", ylim=(0.0, None))
    lag.set_title("What the limits cost")


def _times(figure: Figure, data: Data) -> None:
    rows: Sequence[dict[str, Any]] = data["solvers"]
    axes = figure.subplots()
    place = np.arange(len(rows))[::-1]
    for key, color, marker, label in (
        ("median_us", BLUE, "o", "median"),
        ("p99_us", PURPLE, "d", "99 of 100"),
        ("max_us", YELLOW, "s", "longest"),
    ):
        style: dict[str, Any] = {"markeredgecolor": BLACK, "markeredgewidth": 0.5}
        axes.plot([row[key] for row in rows], place, linestyle="none", marker=marker, color=color,
                  label=label, **style)  # fmt: skip
    axes.axvline(1000.0, color=LIMIT, linestyle=LIMIT_DASH, label="a tick of 1 kHz")
    axes.set_yticks(place, [row["solver"] for row in rows])
    axes.set(xscale="log", xlabel="time of a target [µs]")
    write_plainly(axes.xaxis)
    axes.set_title("Inverse kinematics, all compiled the same way")
    figure.legend(loc="outside right center")
