"""Another scenario, another robot, another mesh, and where the base stands in it."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import viser

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.live import Recipe
from sinuous.live.act import checked
from sinuous.live.orders import Order, Reset
from sinuous.live.snapshot import Snapshot
from sinuous.scenario import Scenario
from sinuous.view.page.base_handle import BaseHandle, Ghost, angles_of, pose_of
from sinuous.view.page.paths import (
    ROBOTS,
    UNITS,
    Vector,
    Wanted,
    assignments_for,
    live_scenarios,
    refusal,
    table_of,
)
from sinuous.view.page.registering import Registering
from sinuous.view.style import BLUE, VERMILION
from sinuous.view.units import MM_PER_M

MESHES = ".stl,.obj,.ply"


class Setup:
    """The tab for all that a new start can change about robot and room.

    What cannot be used is said in the tab, and nothing is asked of the session then.

    Arguments:
        server: of the page
        order: asks the session for something
        say: shows a line to whoever is there
        tab: where it belongs
    """

    def __init__(
        self,
        server: viser.ViserServer,
        order: Callable[[Order], None],
        say: Callable[[str], None],
        *,
        tab: viser.GuiTabHandle,
    ) -> None:
        self._order, self._say = order, say
        self._folder = TemporaryDirectory(prefix="sinuous-")
        self._scenario: Scenario | None = None
        self._ghost: Ghost | None = None
        self._busy = False
        self._files = dict[str, str]()
        with tab:
            self._add_scenario(server.gui)
            self._add_parts(server.gui)
            self._add_base(server.gui)
            with server.gui.add_folder("Registration by landmarks", expand_by_default=False):
                self._registering = Registering(server, self._registered)
            self._apply = server.gui.add_button("Check and begin again with these")
            self._answer = server.gui.add_markdown("")
        self._apply.on_click(lambda _: self._ask())
        self._handle = BaseHandle(server.scene, self._dragged)

    def _add_scenario(self, gui: viser.GuiApi) -> None:
        with gui.add_folder("Scenario"):
            self._shipped = gui.add_dropdown("scenario", _files(""))
            self._own = gui.add_text("or a path of your own", "")
            change = gui.add_button("Change to it")
        change.on_click(lambda _: self._change())

    def _add_parts(self, gui: viser.GuiApi) -> None:
        with gui.add_folder("Robot and room"):
            self._robot = gui.add_text("robot", "", hint=f"a path, or one of {', '.join(ROBOTS)}")
            robot = gui.add_upload_button("Upload a robot (TOML)", mime_type=".toml")
            self._mesh = gui.add_text("mesh", "", hint="STL, OBJ or PLY; empty for no change")
            mesh = gui.add_upload_button("Upload a mesh (STL, OBJ, PLY)", mime_type=MESHES)
            self._unit = gui.add_dropdown("unit of the mesh", UNITS)
            self._entrance = gui.add_text("entrance x, y, z [mm]", "", hint="empty for no change")
            self._keep_out = gui.add_text("keep out of", "", hint="meshes, commas between them")
            self._margin = gui.add_number("margin [mm]", 3.0, min=0.0, step=0.5)
        robot.on_upload(lambda _: self._keep(robot.value, self._robot))
        mesh.on_upload(lambda _: self._keep(mesh.value, self._mesh))

    def _add_base(self, gui: viser.GuiApi) -> None:
        with gui.add_folder("Base"):
            self._moving = gui.add_checkbox("move base", False)
            self._position = gui.add_vector3("position [mm]", (0.0, 0.0, 0.0), step=1.0)
            self._rotation = gui.add_vector3(
                "rotation [deg]", (0.0, 0.0, 0.0), step=1.0, hint="about fixed x, then y, then z"
            )
            self._clearance = gui.add_html("")
        for field in (self._moving, self._position, self._rotation):
            field.on_update(lambda event: self._typed(by_hand=event.client_id is not None))

    def scenario_changed(self, scenario: Scenario, file: str) -> None:
        """Show what a scenario has that has just begun."""
        self._scenario, self._ghost = scenario, Ghost(scenario)
        table = table_of(scenario.text, file)
        beside = live_scenarios(Path(file).parent)
        self._files = {path.stem: str(path) for path in beside} | {Path(file).stem: file}
        self._shipped.options = tuple(self._files)
        self._shipped.value = Path(file).stem
        self._robot.value = table.robot.file
        self._mesh.value = "" if table.zone is None else table.zone.mesh
        if table.zone is not None:
            self._unit.value = table.zone.unit if table.zone.unit in UNITS else UNITS[0]
            self._keep_out.value = ", ".join(table.zone.keep_out)
        self._entrance.value = ""
        self._margin.value = round(MM_PER_M * table.mpc.margin, 6)
        self._answer.content = ""
        self._registering.triangles = scenario.zone.triangles
        self._put(scenario.robot.T_w_b)
        self._show()

    def show(self, snapshot: Snapshot) -> None:
        """Note where the tip is."""
        if self._scenario is not None:
            base = self._scenario.robot.T_w_b
            self._registering.tip = (snapshot.actual[-1] - base[:3, 3]) @ base[:3, :3]

    def close(self) -> None:
        """Remove what was uploaded."""
        self._folder.cleanup()

    def _pose(self) -> Array:
        position = np.asarray(self._position.value, dtype=np.float64) / MM_PER_M
        return pose_of(position, np.deg2rad(np.asarray(self._rotation.value, dtype=np.float64)))

    def _put(self, pose: Array) -> None:
        """Write a pose (4, 4) into the fields."""
        self._position.value = _vector(np.round(MM_PER_M * pose[:3, 3], 3))
        self._rotation.value = _vector(np.round(np.rad2deg(angles_of(pose[:3, :3])), 3))

    def _dragged(self, pose: Array) -> None:
        self._put(pose)
        if self._ghost is not None:
            self._handle.follow(self._ghost, pose, visible=bool(self._moving.value))
            self._tell_clearance(pose)

    def _registered(self, pose: Array) -> None:
        self._moving.value = True
        self._put(pose)
        self._show()

    def _typed(self, *, by_hand: bool) -> None:
        if by_hand:  # not by what was dragged
            self._show()

    def _show(self) -> None:
        if self._ghost is not None:
            self._handle.show(self._ghost, self._pose(), visible=bool(self._moving.value))
            self._tell_clearance(self._pose())

    def _tell_clearance(self, pose: Array) -> None:
        assert self._ghost is not None
        clearance = MM_PER_M * self._ghost.clearance(pose)
        if clearance == np.inf:
            self._clearance.content = "no walls here"
            return
        good = clearance >= float(self._margin.value)
        word = "clear of walls by" if clearance >= 0.0 else "beyond a wall by"
        rest = "" if good or clearance < 0.0 else ", less than the margin"
        self._clearance.content = (
            f'<div style="padding:0 1em;color:{BLUE if good else VERMILION}">'
            f"{word} {abs(clearance):.1f} mm{rest}</div>"
        )

    def _change(self) -> None:
        own = self._own.value.strip()
        if not own and not self._files:
            return
        file = str(Path(own).expanduser()) if own else self._files[str(self._shipped.value)]
        try:
            checked(Recipe(file))
        except InputError as error:
            self._tell(str(error))
            return
        self._tell("")
        self._order(Reset(scenario=file))

    def _wanted(self) -> Wanted:
        return Wanted(
            robot=self._robot.value.strip(),
            mesh=self._mesh.value,
            unit=str(self._unit.value),
            entrance=self._entrance.value,
            keep_out=self._keep_out.value,
            margin=float(self._margin.value),
            position=_vector(self._position.value),
            rotation=_vector(self._rotation.value),
        )

    def _ask(self) -> None:
        """Check what is wanted, and order it; callbacks of the page have threads of their own."""
        scenario = self._scenario
        if scenario is None or self._busy:
            return
        self._busy = True
        self._tell("Checking ...")
        try:
            fields = assignments_for(self._wanted(), table_of(scenario.text, scenario.file))
            why = refusal(scenario.text, scenario.file, fields, Path(self._folder.name))
        except InputError as error:
            fields, why = (), str(error)
        finally:
            self._busy = False
        self._tell(why)
        if not why:
            self._order(Reset(set=fields))

    def _keep(self, file: viser.UploadedFile, field: "viser.GuiInputHandle[str]") -> None:
        """Store what was uploaded and write its path into a field."""
        path = Path(self._folder.name) / Path(file.name).name
        path.write_bytes(file.content)
        field.value = str(path)

    def _tell(self, text: str) -> None:
        self._answer.content = text
        if text:
            self._say(text)


def _vector(values: object) -> Vector:
    x, y, z = (float(value) for value in np.asarray(values, dtype=np.float64))
    return x, y, z


def _files(*names: str) -> tuple[str, ...]:
    return names
