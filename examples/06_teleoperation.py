"""By hand over a delay of 0.2 s: waves, cables and a boundary that is felt, as in paper A."""

import numpy as np

import sinuous as sn

ik = sn.GeometricIK(sn.load_robot("qin2020"))
chi = np.deg2rad(19.5)  # of all bends of joint 1 up to this no target asks too much of a joint
place = ik.on_plane([0.0, 0.1], chi)  # where the tip starts


def goal(time: float) -> list[float]:
    """The hand pushes the tip to 170 mm along z, beyond the boundary, and comes back [m]."""
    far, scale = (0.17 if 1.0 < time < 6.0 else 0.1), 2.25
    return [0.0, far / scale]


hand = sn.Bilateral.connect(
    operator=sn.ImpedanceOperator(goal),
    mapping=sn.Mapping.plane(scale=2.25, y0=ik.plane(chi)),
    force=sn.Together((sn.ErrorForce(), sn.BoxForce(low=[-0.15] * 2, high=[0.15] * 2))),
    scheme=sn.ModifiedWaves.c2(),
    delay=0.2,
)
loop = sn.CableLoop(ik)  # inverse kinematics and a PID for every cable, at 1 kHz
plant = sn.KinematicPlant(ik.robot, seed=0, start=ik.solve_one(place).c, encoder_step=1e-6)
ledger = sn.Ledger(hand.dt)

state, follower = hand.init(place), loop.init(ik.solve_one(place).c)
tip, measured = place, None
for tick in range(10_000):
    state, signals = hand.step(state, tip)
    follower, command = loop.step(follower, signals.follower.target_w, measured)
    measured = plant.step(command.rates, loop.dt)
    tip = measured.tip
    ledger.observe(signals)
    if tick % 1000 == 999:
        print(
            f"{signals.time:4.1f} s: hand {signals.leader.X[1] * 1e3:5.1f} mm, "
            f"tip {signals.follower.X_s[1] * 1e3:5.1f} mm, "
            f"felt {signals.leader.F_m[1]:5.2f} N"
        )
print(f"energy made by the channel: {max(0.0, -ledger.least.channel):.3f} J")
