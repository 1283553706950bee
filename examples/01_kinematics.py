"""A robot turns a configuration into points of its body and lengths of its actuators."""

import numpy as np

import sinuous as sn

robot = sn.load_robot("hachen2025")

# Three segments; each has a bend vector [rad] and a length [m]. This one bends as an S.
c = robot.home.copy()
c[0:3] = 0.8, 0.0, 0.07
c[3:6] = -0.8, 0.3, 0.06
c[6:9] = 0.2, 0.4, 0.08

points = robot.points(c)
print(f"{robot.name}: {len(robot.coordinate_names)} coordinates, {len(points)} body points")
print("tip [mm]:", np.round(robot.tip(c) * 1e3, 2))
for name, length in zip(robot.actuator_names, robot.lengths(c), strict=True):
    print(f"  {name:20} {length * 1e3:7.2f} mm")

# Back again: the lengths of the actuators tell the configuration.
error = np.max(np.abs(robot.configuration(robot.lengths(c)) - c))
print(f"configuration from lengths: off by {error:.1e}")

# The analytic Jacobian of the tip against central differences.
h = 1e-6
differences = np.stack(
    [(robot.tip(c + h * e) - robot.tip(c - h * e)) / (2.0 * h) for e in np.eye(len(c))], axis=1
)
error = np.max(np.abs(robot.points_jacobian(c)[-1] - differences))
print(f"Jacobian of the tip: off central differences by {error:.1e}")
