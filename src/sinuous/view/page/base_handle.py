"""The robot's base, dragged: its handle, a ghost of the body, and how close it is to a wall."""

from collections.abc import Callable

import numpy as np
import viser
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.scenario import Scenario
from sinuous.view.page.scale import PER_METRE

HANDLE, GHOST = "/setup/base", "/setup/ghost"
SIZE = 0.04  # of the handle [m]
GHOST_COLOR = (230, 159, 0)  # orange of Okabe and Ito
THICKNESS = 0.004  # of the ghost [m]


class Ghost:
    """The body of a scenario's start, its base anywhere."""

    def __init__(self, scenario: Scenario) -> None:
        robot = scenario.robot
        self._zone, self._radii = scenario.zone, robot.radii
        base = robot.T_w_b
        self.points = (robot.points(scenario.first_configuration) - base[:3, 3]) @ base[:3, :3]

    def at(self, pose: Array) -> Array:
        """Points of the body (S, 3) [m] with the base at a pose (4, 4)."""
        return self.points @ pose[:3, :3].T + pose[:3, 3]

    def clearance(self, pose: Array) -> float:
        """The least distance of the body to a wall [m]; negative beyond one."""
        return float(np.min(self._zone.clearance(self.at(pose)) - self._radii))


def pose_of(position: Array, rotation: Array) -> Array:
    """Pose (4, 4) of a position (3,) [m] and angles about fixed x, then y, then z (3,) [rad]."""
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_euler("xyz", rotation).as_matrix()
    pose[:3, 3] = position
    return pose


def angles_of(matrix: Array) -> Array:
    """Angles about fixed x, then y, then z (3,) [rad] of a rotation (3, 3)."""
    return Rotation.from_matrix(matrix).as_euler("xyz", suppress_warnings=True)


class BaseHandle:
    """A handle at the base, and the ghost that goes with it.

    Arguments:
        scene: of the page
        moved: called with the pose (4, 4) that the handle was dragged to
    """

    def __init__(self, scene: viser.SceneApi, moved: Callable[[Array], None]) -> None:
        self._scene = scene
        self._handle = scene.add_transform_controls(
            HANDLE, scale=SIZE * PER_METRE, line_width=3.0, depth_test=False, visible=False
        )
        self._moved = moved
        self._handle.on_update(self._dragged)

    def show(self, ghost: Ghost, pose: Array, *, visible: bool) -> None:
        """Put handle and ghost at a pose (4, 4)."""
        x, y, z, w = Rotation.from_matrix(pose[:3, :3]).as_quat()
        self._handle.visible = visible
        self._handle.position = PER_METRE * pose[:3, 3]
        self._handle.wxyz = (w, x, y, z)
        self.follow(ghost, pose, visible=visible)

    def follow(self, ghost: Ghost, pose: Array, *, visible: bool) -> None:
        """Put only the ghost there: the handle is already."""
        self._scene.add_spline_catmull_rom(
            GHOST,
            PER_METRE * ghost.at(pose),
            thickness=THICKNESS * PER_METRE,
            color=GHOST_COLOR,
            visible=visible,
        )

    def _dragged(self, event: viser.TransformControlsEvent) -> None:
        w, x, y, z = np.asarray(self._handle.wxyz, dtype=np.float64)
        pose = np.eye(4)
        pose[:3, :3] = Rotation.from_quat([x, y, z, w]).as_matrix()
        pose[:3, 3] = np.asarray(self._handle.position, dtype=np.float64) / PER_METRE
        self._moved(pose)
