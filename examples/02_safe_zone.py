"""A safe zone says how much room every point has, and which triangle limits it."""

from pathlib import Path

import numpy as np

import sinuous as sn

mesh = Path(__file__).parent / "meshes" / "winding_tube.stl"
print(sn.check_mesh(mesh, unit="mm"))

# The robot comes in through the end at the origin: that end is open.
zone = sn.SafeZone.load(mesh, unit="mm", entrance=[0.0, 0.0, 0.0])
places = np.array([[0.0, 0.0, 0.03], [0.0, 0.012, 0.03], [0.0, 0.03, 0.03], [0.0, 0.0, -0.02]])
found = zone.nearest(places)
for place, clearance, triangle in zip(places, found.clearance, found.triangle, strict=True):
    where = zone.describe_triangle(int(triangle)).replace(str(mesh), mesh.name)
    print(f"{place * 1e3} mm: clearance {clearance * 1e3:6.2f} mm, nearest is {where}")

# A post that the robot has to stay away from.
post = sn.shapes.capsule([0.0, -0.02, 0.03], [0.0, 0.02, 0.03], 0.003)
narrower = zone.minus(post, name="post")
print(f"with a post in the way: {narrower.clearance(places[0]) * 1e3:.2f} mm")
