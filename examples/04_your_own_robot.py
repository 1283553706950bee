"""Your own robot is a TOML file; here it has an insertion stage, fixed segments and a tool."""

from pathlib import Path

import numpy as np

import sinuous as sn

here = Path(__file__).parent
robot = sn.load_robot(here / "robots" / "endoscope.toml")
print(f"{robot.name}: coordinates {', '.join(robot.coordinate_names)}")

# It stands before the tube and pushes itself in, bending as the tube does.
zone = sn.SafeZone.load(here / "meshes" / "winding_tube.stl", unit="mm", entrance=[0, 0, 0])
T_w_b = np.eye(4)
T_w_b[2, 3] = -0.09
mpc = sn.ShapeConstrainedMPC(robot.at(T_w_b), zone, margin=0.003)

# The plant's cables and the sensors on its body are noisy; the seed makes the noise repeat.
noise = sn.Disturbance(length_std=2e-5, length_max=1e-4, point_std=5e-5, point_max=2e-4)
path = sn.waypoints([[0.0, 0.0, 0.05], [0.0188, 0.0, 0.0843], [0.06, -0.001, 0.1]])
run = sn.run(sn.Scenario(name="endoscope", mpc=mpc, path=path, seed=1, disturbance=noise))

record = run.recording
print(f"{len(record)} steps of {mpc.dt * 1e3:.1f} ms, {run.end.value}")
for name, tips in (("model", record.nominal_tip), ("plant", record.actual_tip)):
    error = np.linalg.norm(tips[-1] - record.target[-1])
    print(f"tip of the {name}: {error * 1e3:.3f} mm from the last way-point")
for key in ("min_clearance_nominal_m", "min_clearance_actual_m"):
    print(f"{key}: {run.summary[key]:.6f}")
print(f"margin violations: {run.summary['margin_violations']}")
