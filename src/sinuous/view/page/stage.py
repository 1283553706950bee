"""The scene of a page: the passage once, and the robot in it from moment to moment."""

from typing import Any

import numpy as np
import viser

from sinuous.arrays import Array, IntArray
from sinuous.recording import Header, ZonePart
from sinuous.robots.robot import Robot
from sinuous.view.page.arrow import Arrow
from sinuous.view.page.cables import Cables
from sinuous.view.page.moment import Moment
from sinuous.view.page.scale import PER_METRE, byte_color, units
from sinuous.view.page.solid import Cylinders, cylinder
from sinuous.view.page.tension import TensionColours
from sinuous.view.page.thinned import thinned
from sinuous.view.style import BLUE, GREEN, GREY, ORANGE, PALE, SKY, SLATE, VERMILION, rgb

ROOT = "/stage"
LOOKS = {  # colour and opacity; keep-outs are solid
    ZonePart.WALL: (SKY, 0.16),
    ZonePart.GUIDE: (GREY, 0.08),
    ZonePart.KEEP_OUT: (SLATE, None),
}
DIFFERENT = 5e-4  # distance [m] from which the model's shape is drawn beside the plant's
NEAR = 3.0  # clearances of that many margins and more are comfortable
UPRIGHT = 0.3  # sine of the angle to the vertical below which a robot stands upright
SPREAD = 1.25  # distance of the camera, as a multiple of the scene's size


class Stage:
    """Draws a run.

    Arguments:
        scene: of the page
        header: of the run
        robot: of the run, with as many body points as the header has
    """

    def __init__(self, scene: viser.SceneApi, header: Header, robot: Robot) -> None:
        home = robot.points(robot.home)
        self._margin, self._cables = header.margin, Cables.of(robot)
        self._cylinders = Cylinders.of(header, home)
        everything = np.vstack([home, header.zone_triangles.reshape(-1, 3)])
        self._low, self._high = everything.min(axis=0), everything.max(axis=0)
        self.size = float(np.linalg.norm(self._high - self._low))
        """Diagonal of passage and robot [m]."""
        self.tensions = TensionColours()
        self._handles: list[viser.SceneNodeHandle] = []
        self._spots, self._home = everything, home
        self._draw_walls(scene, header)
        self._draw_robot(scene, home)
        self._draw_signs(scene, home)

    @property
    def metres_per_newton(self) -> float:
        """Length of the arrow of a newton."""
        return self._tip_force.metres_per_newton

    def home_camera(self) -> tuple[Array, Array]:
        """From where, and where to look to see it all: two places (3,), in units of the page."""
        centre = 0.5 * (self._low + self._high)
        along = self._home[-1] - self._home[0]
        along /= float(np.linalg.norm(along))
        if np.hypot(along[0], along[1]) > UPRIGHT:
            side = np.array([-along[1], along[0], 0.0])  # the robot from its side
        else:
            _, _, axes = np.linalg.svd(self._spots - centre, full_matrices=False)
            side = axes[-1] * (1.0, 1.0, 0.0)  # the flat side of the whole
        size = float(np.linalg.norm(side))
        side = side / size if size > 0.2 else np.array([0.0, -1.0, 0.0])
        side = side * (-1.0 if side[1] > 0.0 else 1.0)
        turned = np.array([side[0] - 0.35 * side[1], side[1] + 0.35 * side[0], 0.4])
        away = turned / float(np.linalg.norm(turned))
        span = 0.62 * self.size * SPREAD
        return PER_METRE * (centre + span * away), PER_METRE * centre

    def show(self, moment: Moment) -> None:
        """Show a moment; what has not changed since the last is not sent again."""
        along = self._cables.frames.directions(moment.actual)
        placed = self._cylinders.placed(moment.actual, along)
        self._body.batched_positions = units(placed.centres)
        self._body.batched_wxyzs = placed.turns.astype(np.float32)
        self._body.batched_scales = units(placed.sizes)
        self._show_cables(moment, along)
        self._show_nominal(moment)
        self._show_wall(moment)
        self._target.position = PER_METRE * moment.target
        self._tip_force.show(moment.actual[-1], moment.tip_force)
        self._body_force.show(moment.nominal[moment.pushed], moment.body_force)

    def remove(self) -> None:
        """Take everything away."""
        for handle in reversed(self._handles):
            handle.remove()
        self._handles.clear()

    def _draw_walls(self, scene: viser.SceneApi, header: Header) -> None:
        for part, (color, opacity) in LOOKS.items():
            triangles = header.zone_triangles[header.zone_parts == part]
            if not len(triangles):
                continue
            vertices, faces = thinned(triangles)
            self._keep(
                scene.add_mesh_simple(
                    f"{ROOT}/{part.name.lower()}",
                    units(vertices),
                    faces.astype(np.uint32),
                    color=byte_color(color),
                    opacity=opacity,
                    side="double",
                    cast_shadow=False,
                    receive_shadow=False,
                )
            )

    def _draw_robot(self, scene: viser.SceneApi, home: Array) -> None:
        vertices, faces = cylinder()
        parts, rigid = self._cylinders, self._cylinders.rigid
        count = len(parts.slim) + len(parts.disks)
        colors = np.tile(np.array(byte_color(PALE), dtype=np.uint8), (count, 1))
        colors[: len(rigid)][~rigid] = byte_color(SLATE)
        self._body = scene.add_batched_meshes_simple(
            f"{ROOT}/body",
            vertices.astype(np.float32),
            faces.astype(np.uint32),
            batched_wxyzs=np.tile((1.0, 0.0, 0.0, 0.0), (count, 1)),
            batched_positions=np.tile(PER_METRE * home[0], (count, 1)),
            batched_scales=np.full((count, 3), 1e-3),
            batched_colors=colors,
            lod="off",
            cast_shadow=False,
            receive_shadow=False,
        )
        stretches = max(len(self._cables.cable), 1)
        self._lines = _line(scene, "cables", stretches, color=GREY, width=3.0)
        self._nominal = _line(scene, "nominal", len(home) - 1, color=BLUE, width=2.5)
        for handle in (self._body, self._lines, self._nominal):
            self._keep(handle)

    def _draw_signs(self, scene: viser.SceneApi, home: Array) -> None:
        radius = 0.008 * self.size * PER_METRE
        self._thread = _line(scene, "thread", 1, color=GREEN, width=3.0)
        self._spot = scene.add_icosphere(
            f"{ROOT}/wall_point", 0.6 * radius, color=byte_color(GREEN), visible=False
        )
        self._target = scene.add_icosphere(f"{ROOT}/target", radius, color=byte_color(GREEN))
        self._tip_force = Arrow(scene, f"{ROOT}/tip_force", color=VERMILION, size=self.size)
        self._body_force = Arrow(scene, f"{ROOT}/body_force", color=ORANGE, size=self.size)
        axes = scene.add_frame(
            f"{ROOT}/axes",
            axes_length=0.1 * self.size * PER_METRE,
            axes_radius=0.003 * self.size * PER_METRE,
            position=PER_METRE * self._low,
        )
        for handle in (
            self._thread, self._spot, self._target, axes,
            self._tip_force.handle, self._body_force.handle,
        ):  # fmt: skip
            self._keep(handle)

    def _keep(self, handle: viser.SceneNodeHandle) -> None:
        self._handles.append(handle)

    def _show_cables(self, moment: Moment, along: Array) -> None:
        if len(self._cables.cable):
            self._lines.points = units(self._cables.stretches(moment.actual, along))
            self._lines.visible = True
            self._lines.colors = _both(self.tensions.of(moment.tensions), self._cables.cable)

    def _show_nominal(self, moment: Moment) -> None:
        apart = float(np.max(np.abs(moment.nominal - moment.actual)))
        self._nominal.visible = apart > DIFFERENT
        if apart > DIFFERENT:
            pairs = np.stack([moment.nominal[:-1], moment.nominal[1:]], axis=1)
            self._nominal.points = units(pairs)

    def _show_wall(self, moment: Moment) -> None:
        seen = bool(np.isfinite(moment.clearance))
        self._thread.visible = self._spot.visible = seen
        if not seen:
            return
        color = byte_color(nearness(moment.clearance, self._margin))
        ends = np.stack([moment.actual[moment.nearest], moment.wall])
        self._thread.points = units(ends[None])
        self._thread.colors = np.tile(np.array(color, dtype=np.uint8), (1, 2, 1))
        self._spot.position = PER_METRE * moment.wall
        self._spot.color = color


def nearness(clearance: float, margin: float) -> str:
    """Colour of a clearance [m]: at the margin, near it, or comfortable."""
    if clearance < 1.1 * margin:
        return VERMILION
    return ORANGE if clearance < NEAR * margin else GREEN


def _both(colors: Array, cable: IntArray) -> Any:
    """Colours (N, 2, 3) of both ends of every stretch; grey without any tension."""
    if not len(colors):
        colors = np.tile(rgb(GREY), (int(cable.max()) + 1, 1))
    rows = np.round(255.0 * colors[cable]).astype(np.uint8)
    return np.repeat(rows[:, None], 2, axis=1)


def _line(
    scene: viser.SceneApi, name: str, count: int, *, color: str, width: float
) -> "viser.LineSegmentsHandle":
    """Segments that are not there yet."""
    return scene.add_line_segments(
        f"{ROOT}/{name}",
        np.zeros((count, 2, 3), dtype=np.float32),
        np.tile(np.array(byte_color(color), dtype=np.uint8), (count, 2, 1)),
        thickness=width,
        thickness_units="screen",
        visible=False,
    )
