"""2.2: kinematics of the disc, along paths, as printed, and how long they take."""

import numpy as np

from sinuous.control.geometric_ik import CHI
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.qin2020.kinematics import disc, paths, printed, timing
from sinuous.papers.qin2020.kinematics.figures import draw
from sinuous.papers.workers import Workers

TARGETS, QUICK_TARGETS = 100_000, 2_000
PATHS, QUICK_PATHS = 1000, 50
POSES, QUICK_POSES = 2000, 200  # with which misprints are judged
PEERS, QUICK_PEERS = 300, 5  # targets of solvers that iterate
SET2_CHI = float(np.radians(22.5))  # of the plane in which Set 2 runs


def run(workers: Workers, quick: bool) -> Data:
    """All of it in this process: it takes seconds."""
    targets, ways, poses, peers = (
        (QUICK_TARGETS, QUICK_PATHS, QUICK_POSES, QUICK_PEERS)
        if quick
        else (TARGETS, PATHS, POSES, PEERS)
    )
    workers.observe("kinematics", 0, 1)
    return {
        "disc": disc.whole_disc(targets, CHI),
        "by_chi": disc.by_chi(min(targets, disc.PLANE_TARGETS)),
        "maps": [disc.maps(chi) for chi in (CHI, SET2_CHI)],
        "poses": disc.poses(CHI),
        "continuity": paths.continuity(ways),
        "rates": paths.cable_rates(),
        "holes": printed.hole_angles(poses),
        "links": printed.link_directions(poses),
        "plane": printed.plane(poses),
        "times": timing.times(targets, peers),
    }


KINEMATICS = Experiment(
    name="kinematics",
    title="Forward and inverse kinematics (Fig. 5)",
    section="2.2",
    run=run,
    draw=draw,
)
