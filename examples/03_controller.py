"""Robot, zone, controller, plant: the whole loop in fifteen lines."""

import sinuous as sn

robot = sn.load_robot("hachen2025")
tube = sn.shapes.tube([[0.0, 0.0, -0.05], [0.0, 0.0, 0.32]], 0.03)
zone = sn.SafeZone.from_mesh(tube, name="tube")
mpc = sn.ShapeConstrainedMPC(robot, zone, margin=0.0055, dt=1 / 30, horizon=5)
plant = sn.KinematicPlant(robot, seed=0)

state = mpc.init(robot.home)
for step in range(120):
    state, command = mpc.step(state, target=[0.013, 0.0, 0.21])
    measured = plant.step(command.rates, mpc.dt)
    if step % 20 == 19:
        clearance = f"clearance {command.report.clearance * 1e3:.2f} mm"
        print(
            f"{step + 1:3}: tip {measured.tip * 1e3} mm, {clearance}, {command.report.status.value}"
        )
