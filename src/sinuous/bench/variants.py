"""The stress scene with another robot or another mesh, everything else as it was."""

from dataclasses import dataclass, replace

import numpy as np
import trimesh

from sinuous.bench import scene
from sinuous.bench.scene import Scene
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.parts import Segment
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_pcc

SOLID = 10  # disks of the preset's segment; more are thinner, so that it bends as far


@dataclass(frozen=True, kw_only=True)
class Variant:
    """A robot and a horizon.

    Arguments:
        disks: of all segments together
        segments: the preset's robot is cut into so many, each as much shorter
        spacing: largest arc between guarded points [m], None for the preset's
        horizon: N
    """

    disks: int = 30
    segments: int = 3
    spacing: float | None = None
    horizon: int = 2


def robot(variant: Variant) -> PccRobot:
    """The robot: as long, as fast at its tip and as bendable as the stress scene's."""
    preset = load_pcc("hachen2025")
    T_w_b = np.eye(4)
    T_w_b[2, 3] = scene.BASE
    share = len(preset.segments) / variant.segments
    disks = max(round(variant.disks / variant.segments), 1)
    speed = preset.speed
    return replace(
        preset,
        segments=(_segment(preset.segments[0], disks, share),) * variant.segments,
        speed=replace(speed, cable=share * speed.cable, backbone=share * speed.backbone),
        spacing=variant.spacing or preset.spacing,
        T_w_b=T_w_b,
    )


def _segment(segment: Segment, disks: int, share: float) -> Segment:
    """A share of the preset's segment, thin enough for the tube."""
    per_segment = SOLID * share
    (shortest, longest), (least, most) = segment.length, segment.cable_length
    return replace(
        segment,
        length=(share * shortest, share * longest),
        home_length=share * segment.home_length,
        cable_length=(share * least, share * most),
        disks=disks,
        disk_thickness=segment.disk_thickness * min(1.0, per_segment / disks),
        body_radius=scene.BODY_RADIUS,
    )


def tube(vertices: int) -> trimesh.Trimesh:
    """The scene's tube with at least so many vertices, as evenly laid as there."""
    around = round(np.sqrt((vertices - 2) * scene.SECTIONS / scene.STATIONS))
    along = int(np.ceil((vertices - 2) / around))
    axis = shapes.arc_path(scene.BEND, scene.ANGLE, stations=along)
    return shapes.tube(axis, scene.RADIUS, sections=around)


def scene_of(variant: Variant, zone: SafeZone, steps: int) -> Scene:
    """The stress scene for that robot."""
    body = robot(variant)
    length = scene.START_LENGTH * (3.0 / variant.segments)
    return Scene(
        robot=body,
        zone=zone,
        margin=scene.MARGIN,
        start=np.array([length / scene.BEND, 0.0, length] * variant.segments),
        targets=scene.targets(steps),
    )
