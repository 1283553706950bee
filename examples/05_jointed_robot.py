"""A robot of rigid modules on universal joints: cables, and inverse kinematics in closed form."""

import numpy as np

import sinuous as sn

np.set_printoptions(precision=3, suppress=True)

robot = sn.load_robot("qin2020")
ik = sn.GeometricIK(robot)

# Joint angles, and back from the lengths of the cables; an encoder that is wrong stands out.
c = np.random.default_rng(0).uniform(-0.2, 0.2, len(robot.home))
lengths = robot.lengths(c)
print(
    f"from lengths to angles and back: {np.max(np.abs(robot.configuration(lengths) - c)):.0e} rad"
)
lengths[4] += 0.001
print(f"one cable 1 mm wrong, residual of each module: {robot.consistency(lengths) * 1e3} mm")

# The tip moves in a plane across the robot; joint 1's bend chi in the reference pose fixes which.
chi = np.deg2rad(19.5)
targets = ik.on_plane([[0.0, 0.15], [0.1, 0.05], [0.0, 0.0], [-0.2, 0.1]], chi)
for target in targets:
    found = ik.solve_one(target)
    error = np.linalg.norm(robot.tip(found.c) - found.target)
    print(
        f"{target * 1e3} mm: {found.status.name.lower()}, joints {found.first_joint} to "
        f"{robot.joints} move, largest bend {np.rad2deg(found.bend):.1f} deg, tip off {error:.0e} m"
    )
