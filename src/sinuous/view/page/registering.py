"""Where the base stands, from landmarks that are known both on the mesh and by the robot."""

from collections.abc import Callable

import numpy as np
import viser

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.geometry.registration import register
from sinuous.view.page.paths import point_in
from sinuous.view.page.scale import PER_METRE
from sinuous.view.units import MM_PER_M

NOBODY = "nothing"
LANDMARKS = ("landmark 1", "landmark 2", "landmark 3", "landmark 4")
RADIUS = 0.003  # of the sphere at a landmark [m]
COLOR = (213, 94, 0)  # vermilion of Okabe and Ito


def hit(origin: Array, direction: Array, triangles: Array) -> Array | None:
    """Where a ray first meets one of the triangles (T, 3, 3), if it does (Moeller and Trumbore).

    Arguments:
        origin: of the ray (3,) [m]
        direction: of the ray (3,)
        triangles: (T, 3, 3) [m]
    """
    corner, one, other = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    e1, e2 = one - corner, other - corner
    across = np.cross(direction, e2)
    volume = np.sum(e1 * across, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):  # of triangles seen from their edge
        since = origin - corner
        u = np.sum(since * across, axis=1) / volume
        beside = np.cross(since, e1)
        v = beside @ direction / volume
        far = np.sum(e2 * beside, axis=1) / volume
        meets = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (far > 0.0)
    if not np.any(meets):
        return None
    return origin + float(np.min(far[meets])) * direction


class Registering:
    """Rows of landmarks, each on the mesh and as the robot knows it.

    Arguments:
        server: of the page; the fields are added where it is just adding some
        found: called with the pose of the base (4, 4)
    """

    def __init__(self, server: viser.ViserServer, found: Callable[[Array], None]) -> None:
        self._scene, self._found = server.scene, found
        self.triangles = np.empty((0, 3, 3))
        self.tip: Array | None = None  # as the robot knows it (3,) [m]
        gui = server.gui
        self._clicked = gui.add_dropdown(
            "a click on the mesh sets", (NOBODY, *LANDMARKS), hint="and so does the tip"
        )
        self._places = list[viser.GuiInputHandle[str]]()
        self._known = list[viser.GuiInputHandle[str]]()
        for name in LANDMARKS:
            with gui.add_folder(name):
                self._places.append(gui.add_text("on the mesh x, y, z [mm]", ""))
                self._known.append(gui.add_text("in the robot's base frame [mm]", ""))
        take = gui.add_button("Take the tip for the landmark", hint="in the robot's base frame")
        clear = gui.add_button("Clear the landmark")
        compute = gui.add_button("Compute the base", hint="three landmarks or more")
        self._answer = gui.add_markdown("")
        take.on_click(lambda _: self._take())
        clear.on_click(lambda _: self._clear())
        compute.on_click(lambda _: self.compute())
        self._clicked.on_update(lambda _: self._listen())
        for place in self._places:
            place.on_update(lambda _: self._mark())

    @property
    def _chosen(self) -> int | None:
        name = str(self._clicked.value)
        return None if name == NOBODY else LANDMARKS.index(name)

    def _listen(self) -> None:
        """Clicks mean something while a landmark is chosen, and only then."""
        self._scene.remove_click_callback()
        if self._chosen is not None:
            self._scene.on_click()(self._click)

    def _click(self, event: viser.SceneClickEvent) -> None:
        origin = np.asarray(event.ray_origin, dtype=np.float64) / PER_METRE
        place = hit(origin, np.asarray(event.ray_direction, dtype=np.float64), self.triangles)
        if self._chosen is not None and place is not None:
            self._places[self._chosen].value = _text(place)
            self._mark()

    def _take(self) -> None:
        if self._chosen is not None and self.tip is not None:
            self._known[self._chosen].value = _text(self.tip)

    def _clear(self) -> None:
        if self._chosen is not None:
            self._places[self._chosen].value = self._known[self._chosen].value = ""
            self._mark()

    def _mark(self) -> None:
        """A numbered sphere at each landmark on the mesh."""
        for number, field in enumerate(self._places, 1):
            try:
                place = np.array(point_in(field.value)) / MM_PER_M
            except InputError:  # not there, or not yet
                self._scene.remove_by_name(f"/setup/landmark{number}")
                continue
            at = PER_METRE * place
            name = f"/setup/landmark{number}"
            self._scene.add_icosphere(name, RADIUS * PER_METRE, COLOR, position=at)
            self._scene.add_label(f"{name}/number", str(number))

    def compute(self) -> None:
        """The pose from all landmarks that are known on both sides; what is wrong is said."""
        rows = [
            (place.value, known.value)
            for place, known in zip(self._places, self._known, strict=True)
            if place.value.strip() or known.value.strip()
        ]
        try:
            mesh = np.array([point_in(place) for place, _ in rows]).reshape(-1, 3) / MM_PER_M
            robot = np.array([point_in(known) for _, known in rows]).reshape(-1, 3) / MM_PER_M
            registration = register(robot, mesh)
        except (InputError, ValueError) as error:
            self._answer.content = str(error)
            return
        each = ", ".join(f"{MM_PER_M * one:.1f}" for one in registration.residuals)
        warning = f" **Careful: {registration.warning}.**" if registration.warning else ""
        self._answer.content = (
            f"residuals {each} mm, root mean square {MM_PER_M * registration.rms:.1f} mm.{warning}"
        )
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = registration.rotation, registration.translation
        self._found(pose)


def _text(place: Array) -> str:
    return ", ".join(f"{MM_PER_M * value:.2f}" for value in place)
