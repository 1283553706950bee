"""A robot that differs from its model, seen by a tracker at its tip: feedback makes up for it."""

import numpy as np

import sinuous as sn

robot = sn.load_robot("hachen2025")
mpc = sn.ShapeConstrainedMPC(robot, sn.SafeZone.unbounded(), margin=0.0, dt=1 / 30, horizon=2)
target = np.array([0.05, 0.0, 0.16])

# 40 Hz, late by 30 ms, noisy, on a coil 10 mm beyond the tip.
tracker = sn.TipTracker(
    timing=sn.Timing(rate=40.0, delay=0.03),
    accuracy=sn.Accuracy(noise=0.0002),
    coil=(0.0, 0.0, 0.01),
)
controllers = {
    "plan alone": sn.HierarchicalController(
        mpc, local=None, offset_free=sn.OffsetFree(when=sn.When.NEVER)
    ),
    "with local controller": sn.HierarchicalController(
        mpc, offset_free=sn.OffsetFree(when=sn.When.NEVER)
    ),
    "offset-free as well": sn.HierarchicalController(mpc),
    "damped least squares": sn.DampedLeastSquares(robot, mpc.zone, margin=0.0, dt=mpc.dt),
}
for name, controller in controllers.items():
    real = sn.MismatchedPlant(robot, seed=1, mismatch=sn.Mismatch.representative())
    plant = tracker.on(real, seed=1)
    state, measured, errors = controller.init(robot.home), None, []
    for _ in range(240):
        state, command = controller.step(state, target, measured)
        measured = plant.step(command.rates, controller.dt)
        errors.append(np.linalg.norm(real.truth.points[-1] - target))
    print(f"{name}: the real tip is {np.mean(errors[-60:]) * 1e3:.2f} mm from its target")
