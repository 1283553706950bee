"""Makes the meshes of the example scenarios: python examples/meshes/make.py.

They are in millimetres, as most meshes that people have; everything in `sinuous` is in metres.
"""

from pathlib import Path

import numpy as np
import trimesh

from sinuous import shapes

HERE = Path(__file__).parent
MM_PER_M = 1e3


def route(*pieces: tuple[float, float, float], step: float = 0.004) -> np.ndarray:
    """Stations (K, 3) [m] of a smooth route from the origin along z.

    Arguments:
        pieces: length [m], bend [deg] and direction of the bend about z [deg] of each arc
        step: between stations [m]
    """
    stations, T = [np.zeros(3)], np.eye(4)
    for length, bend, direction in pieces:
        angle, turn = np.deg2rad(bend), np.deg2rad(direction)
        across = np.array([np.cos(turn), np.sin(turn), 0.0])
        s = np.linspace(0.0, 1.0, max(2, round(length / step)) + 1)[1:]
        if angle == 0.0:
            arc = length * s[:, None] * np.array([0.0, 0.0, 1.0])
        else:
            side = (1.0 - np.cos(angle * s))[:, None] * across
            arc = length / angle * (side + np.sin(angle * s)[:, None] * np.array([0.0, 0.0, 1.0]))
        stations += list(arc @ T[:3, :3].T + T[:3, 3])
        # The bend is about the axis that lies across its direction; it does not twist.
        axis = np.array([-across[1], across[0], 0.0])
        move = trimesh.transformations.rotation_matrix(angle, axis)
        move[:3, 3] = arc[-1]
        T = T @ move
    return np.array(stations)


def plate(
    height: float, *, radius: float, thickness: float, hole: np.ndarray, hole_radius: float
) -> trimesh.Trimesh:
    """A round plate across z with a round hole, in metres.

    Arguments:
        height: of its middle
        radius, thickness: of the plate
        hole: middle of the hole in x and y (2,)
        hole_radius: of the hole
    """
    sections = 32
    angle = 2.0 * np.pi * np.arange(sections) / sections
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(sections)], axis=1)
    outside = radius * circle + [0.0, 0.0, height]
    inside = hole_radius * circle + [*hole, height]
    up = np.array([0.0, 0.0, thickness / 2.0])
    vertices = np.concatenate([inside - up, outside - up, outside + up, inside + up])
    here = np.arange(sections)
    ahead = (here + 1) % sections
    faces = list[np.ndarray]()
    for loop in range(4):
        a, b = loop * sections, (loop + 1) % 4 * sections
        faces.append(np.stack([a + here, a + ahead, b + ahead], axis=1))
        faces.append(np.stack([a + here, b + ahead, b + here], axis=1))
    mesh = trimesh.Trimesh(vertices, np.concatenate(faces), process=False)
    if mesh.volume < 0.0:
        mesh.invert()
    return mesh


def save(mesh: trimesh.Trimesh, name: str) -> None:
    """Write a mesh in metres as a binary STL in millimetres."""
    mesh.apply_scale(MM_PER_M)
    mesh.export(HERE / name)
    print(f"{name}: {len(mesh.faces)} triangles")


WINDING = route((0.045, 0, 0), (0.075, 85, 0), (0.105, -120, 25))
INVERTED_U = route((0.045, 0, 0), (0.15, 180, 0), (0.03, 0, 0))
HOLE = np.array([0.012, 0.008])
# A vessel along y with a port to look in by: radius at every station.
VESSEL = np.column_stack(
    [
        np.concatenate([np.linspace(-0.04, 0.19, 12), np.linspace(0.21, 0.33, 9)]),
        np.concatenate([np.full(12, 0.058), np.linspace(0.085, 0.3, 9)]),
    ]
)
VESSEL_END = np.array([[0.45, 0.3], [0.58, 0.3], [0.71, 0.3]])
BEAM = np.array([[-0.35, 0.43, 0.11], [0.35, 0.43, 0.11]])
POST = np.array([[0.012, -0.05, 0.142], [0.012, 0.05, 0.142]])


def main() -> None:
    """Make all meshes."""
    save(shapes.tube(WINDING, 0.018, sections=24), "winding_tube.stl")
    save(shapes.tube(INVERTED_U, 0.018, sections=24), "inverted_u.stl")
    chamber = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.2]])
    save(shapes.tube(chamber, 0.055, sections=32), "chamber.stl")
    across = plate(0.1, radius=0.056, thickness=0.006, hole=HOLE, hole_radius=0.013)
    save(across, "plate.stl")
    save(shapes.capsule(*POST, 0.007, sections=16), "post.stl")
    along, radius = np.concatenate([VESSEL, VESSEL_END]).T
    axis = np.outer(along, [0.0, 1.0, 0.0])
    save(shapes.tube(axis, radius, sections=40), "vessel.stl")
    save(shapes.capsule(*BEAM, 0.025, sections=16), "beam.stl")


if __name__ == "__main__":
    main()
