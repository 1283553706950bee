"""Walls: they are where the zone says, and they hold what pushes against them."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.physics.assembly import assembled, compiled
from sinuous.plants.physics.build import physical_body
from sinuous.plants.physics.engine import NO_CONTACT, require_mujoco
from sinuous.plants.physics.plant import PhysicsPlant
from sinuous.plants.physics.walls import STICKS_OUT, THICKNESS, Walls
from sinuous.robots.robot_file import load_jointed, load_robot
from sinuous.scenario import load_scenario

EXAMPLES = Path(__file__).parents[3] / "examples"
MESHES = EXAMPLES / "meshes"
ROBOT = load_jointed("qin2020")
REACH = float(np.linalg.norm(ROBOT.tip(ROBOT.home)))
HALF = 0.06  # between axis and walls of passages around it [m]
DT = 0.01
ALLOWED = 1e-3  # deepest penetration at the speed of a hand, 0.2 m/s [m]


def passage(*, round: bool, edge: float = 2.0) -> SafeZone:
    """A closed passage along y around the jointed robot, its triangles no longer than `edge`."""
    if round:
        mesh = trimesh.creation.cylinder(radius=HALF, height=1.4, sections=32)
        mesh.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, (1, 0, 0)))
    else:
        mesh = trimesh.creation.box((2 * HALF, 1.4, 2 * HALF))
    mesh.apply_translation((0.0, 0.5, 0.0))
    mesh = mesh.subdivide_to_size(edge)
    mesh.merge_vertices()
    return SafeZone.from_mesh(mesh)


def keep_out(name: str) -> trimesh.Trimesh:
    mesh = trimesh.load_mesh(MESHES / name)
    return mesh.apply_scale(1e-3)


def zones() -> Iterator[tuple[str, SafeZone]]:
    tube = SafeZone.load(MESHES / "winding_tube.stl", unit="mm", entrance=(0, 0, 0), approach=0.1)
    yield "winding tube", tube
    yield "inverted U", SafeZone.load(MESHES / "inverted_u.stl", unit="mm")
    vessel = SafeZone.load(MESHES / "vessel.stl", unit="mm")
    yield "vessel", vessel.minus(keep_out("beam.stl"), name="beam")
    chamber = SafeZone.load(MESHES / "chamber.stl", unit="mm")
    chamber = chamber.minus(keep_out("plate.stl"), name="plate")
    yield "chamber", chamber.minus(keep_out("post.stl"), name="post")


ZONES = dict(zones())


@pytest.mark.parametrize("name", ZONES)
def test_plates_are_the_triangles_and_lie_outside_the_room(name: str) -> None:
    zone = ZONES[name]
    plates = Walls(zone=zone).plates
    wall = zone.triangles[~zone.is_open]
    assert len(plates) == len(wall)
    np.testing.assert_array_equal(np.sort(plates[:, :3], axis=1), np.sort(wall, axis=1))
    weights = np.random.default_rng(0).dirichlet(np.ones(6), (len(plates), 20))
    inside = np.einsum("tki,tij->tkj", weights, plates)
    assert np.max(zone.clearance(inside)) <= 2 * STICKS_OUT
    assert np.min(thicknesses(plates)) > THICKNESS / 2 - 1e-9


def thicknesses(plates: Array) -> Array:
    """How far the far side of every plate is from its triangle (T,) [m]."""
    inner = plates[:, :3]
    normal = np.cross(inner[:, 1] - inner[:, 0], inner[:, 2] - inner[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.abs(np.sum((plates[:, 3] - inner[:, 0]) * normal, axis=1))


def test_a_thin_partition_gets_thin_plates() -> None:
    """A wall of 3 mm between two sides of a room: 4 mm from one side would reach the other."""
    room = SafeZone.from_mesh(trimesh.creation.box((0.1, 0.1, 0.1)))
    sheet = trimesh.creation.box((0.003, 0.06, 0.06))
    walls = Walls(zone=room.minus(sheet, name="sheet"))
    broad = np.abs(np.ptp(walls.plates[:, :3, 0], axis=1)) < 1e-9
    broad &= np.abs(walls.plates[:, 0, 0]) < 0.002
    np.testing.assert_allclose(thicknesses(walls.plates[broad]), 0.002, rtol=0, atol=1e-12)


def test_an_entrance_is_open_and_slivers_are_left_out() -> None:
    zone = ZONES["winding tube"]
    assert np.any(zone.is_open)
    assert len(Walls(zone=zone).plates) == np.count_nonzero(~zone.is_open)
    box = trimesh.creation.box((0.1, 0.1, 0.1))
    a, b = box.vertices[box.faces[0, 0]], box.vertices[box.faces[0, 1]]
    middle = 0.5 * (a + b)
    sliver = SafeZone.from_mesh(box)
    surface = sliver.surfaces[0]
    vertices = np.concatenate([surface.vertices, [middle + 1e-7]])
    faces = np.concatenate([surface.faces, [[surface.faces[0, 0], surface.faces[0, 1], 8]]])
    added = replace(
        surface, vertices=vertices, faces=faces, is_open=np.append(surface.is_open, False)
    )
    thin = object.__new__(SafeZone)
    object.__setattr__(thin, "surfaces", (added,))
    assert len(Walls(zone=thin)._triangles) == 12  # pyright: ignore[reportPrivateUsage]


def test_a_thickness_must_be_one() -> None:
    with pytest.raises(ValueError, match="walls have a positive thickness, not 0"):
        Walls(zone=ZONES["chamber"], thickness=0.0)


@pytest.mark.parametrize("round", [True, False])
def test_in_the_middle_nothing_touches(round: bool) -> None:
    p = PhysicsPlant(ROBOT, walls=Walls(zone=passage(round=round)))
    for _ in range(10):
        p.step(np.zeros(15), 0.05)
    assert p.worst_contacts == NO_CONTACT


@pytest.mark.parametrize("name", ["winding_tube", "inverted_u"])
def test_a_rod_in_the_middle_of_a_tube_touches_nothing(name: str) -> None:
    scenario = load_scenario(EXAMPLES / "scenarios" / f"{name}.toml")
    robot, c = scenario.robot, scenario.first_configuration
    walls = Walls(zone=scenario.zone)
    p = PhysicsPlant(robot, walls=walls, start=c, tick=0.005)
    p.step(np.zeros(len(robot.actuator_names)), 0.1)
    assert p.worst_contacts == NO_CONTACT


@pytest.mark.parametrize(("name", "bent"), [("qin2020", 0.6), ("hachen2025", 1.5)])
def test_bodies_with_room_to_every_side_never_touch(name: str, bent: float) -> None:
    """Whatever the pose: contact only where the body clearance of the model is none.

    Lower than the clearance says it cannot be: between two guarded points the body stays within
    balls that are larger than its radius (notes B7).
    """
    robot = load_robot(name)
    body, mujoco = physical_body(robot), require_mujoco()
    reach = float(np.linalg.norm(robot.tip(robot.home)))
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.6 * reach)
    zone = SafeZone.from_mesh(ball.apply_translation(0.45 * robot.tip(robot.home)))
    model = compiled(assembled(body, walls=Walls(zone=zone)))
    data, rng = mujoco.MjData(model), np.random.default_rng(0)
    free, touching = 0, 0
    for _ in range(60):
        c = robot.home + rng.uniform(-bent, bent, len(robot.home)) * turns(robot.coordinate_names)
        body.pose(model, data, c)
        mujoco.mj_forward(model, data)
        room = np.min(zone.clearance(robot.points(c)) - robot.required_distance(0.0))
        touches = bool(np.any(data.contact.dist < 0.0))
        if room > 0.0:
            assert not touches
            free += 1
        touching += touches
    assert free > 5
    assert touching > 5


def turns(names: tuple[str, ...]) -> Array:
    """Which coordinates turn something."""
    return np.array([0.0 if "length" in name or "insertion" in name else 1.0 for name in names])


def push(p: PhysicsPlant, *, speed: float, beyond: float) -> Iterator[float]:
    """Turn the first joint so that the tip goes so far [m] beyond the wall at x, and hold.

    Yields the total force of the walls after every step [N].
    """
    end, last = (HALF - ROBOT.radius + beyond) / REACH, p.truth.lengths
    steps = int(np.ceil(end * REACH / speed / DT))
    for k in range(1, steps + 60):
        wanted = ROBOT.lengths(min(1.0, k / steps) * end * np.eye(10)[0])
        p.step((wanted - last) / DT, DT)
        last = wanted
        yield p.contacts.total


@pytest.mark.parametrize("edge", [2.0, 0.15])
@pytest.mark.parametrize("round", [True, False])
@pytest.mark.parametrize("tick", [0.002, 0.005])
def test_walls_hold_what_pushes_and_push_back(round: bool, edge: float, tick: float) -> None:
    """The tip at 0.2 m/s into the wall, told to go 50 mm beyond."""
    walls = Walls(zone=passage(round=round, edge=edge))
    p = PhysicsPlant(ROBOT, walls=walls, tick=tick)
    forces = np.array(list(push(p, speed=0.2, beyond=0.05)))
    assert p.worst_contacts.depth < ALLOWED
    assert p.contacts.depth < 0.2e-3
    assert forces[-1] == pytest.approx(STATIC, rel=SLANTED)
    assert np.max(forces) < 1.1 * STATIC  # nothing rattles
    pressing = np.flatnonzero(forces > 1.0)[0]
    quarters = forces[pressing :: (len(forces) - 60 - pressing) // 4][:5]
    assert np.all(np.diff(quarters) > 0.1 * STATIC)


STATIC = 55.0  # [N] for 50 mm; see `test_the_force_of_a_wall_is_what_virtual_work_says`
# Share of it by which forces may differ: some contacts are at a plate's slanted side, where they
# press against each other besides pressing inward.
SLANTED = 0.05


def test_the_force_of_a_wall_is_what_virtual_work_says() -> None:
    """J_l(q)' T = J_rim' f at rest, with the rim of the last plate at the flat wall."""
    zone = passage(round=False)
    p = PhysicsPlant(ROBOT, walls=Walls(zone=zone), gravity=(0.0, 0.0, 0.0))
    list(push(p, speed=0.2, beyond=0.05))
    q = np.zeros(10)
    for _ in range(8):
        J = ROBOT.points_jacobian(q).reshape(-1, 10)
        q = q + np.linalg.lstsq(J, (p.truth.points - ROBOT.points(q)).ravel())[0]
    moments = ROBOT.lengths_jacobian(q).T @ p.tensions
    h = 1e-6
    lever = (rim(q + h * np.eye(10)[0]) - rim(q - h * np.eye(10)[0])) / (2 * h)
    assert p.contacts.total == pytest.approx(abs(moments[0] / lever), rel=0.01)
    assert rim(q) == pytest.approx(-HALF, abs=0.2e-3)


def rim(q: Array) -> float:
    """Where along x the last plate reaches farthest to the side it is pushed to [m]."""
    T = ROBOT.module_poses(q)[-1]
    return float(T[0, 3] - ROBOT.radius * T[0, 0])


def test_contacts_end_when_the_robot_goes_away_and_the_worst_is_kept() -> None:
    p = PhysicsPlant(ROBOT, walls=Walls(zone=passage(round=True)))
    list(push(p, speed=0.2, beyond=0.01))
    worst = p.worst_contacts
    assert worst.total >= worst.largest > 1.0
    last = p.truth.lengths
    for k in range(1, 40):
        back = ROBOT.lengths((1 - k / 40) * 0.04 * np.eye(10)[0])
        p.step((back - last) / DT, DT)
        last = back
    assert p.contacts == NO_CONTACT
    assert p.worst_contacts == worst
