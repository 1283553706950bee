"""Paper A: what `sinuous reproduce qin2020` runs."""

from sinuous.papers.qin2020.channel import CHANNEL
from sinuous.papers.qin2020.claims import CLAIMS
from sinuous.papers.qin2020.drift import DRIFT
from sinuous.papers.qin2020.kinematics.experiment import KINEMATICS
from sinuous.papers.qin2020.physics.experiment import SETS_ON_PHYSICS
from sinuous.papers.qin2020.physics.verdicts import VERDICTS as ON_PHYSICS
from sinuous.papers.qin2020.scattering import SCATTERING
from sinuous.papers.qin2020.sets.experiment import THE_SETS
from sinuous.papers.qin2020.signs.experiment import SIGNS
from sinuous.papers.qin2020.transparency import TRANSPARENCY
from sinuous.papers.reproduce import Paper

QIN2020 = Paper(
    name="qin2020",
    title="L. Qin, F. Huang, Z. Chen, W. Song, S. Zhu: Teleoperation Control Design with Virtual "
    "Force Feedback for the Cable-Driven Hyper-Redundant Continuum Manipulator (2020)",
    experiments=(
        KINEMATICS,  # first, while the other processes have nothing to do
        SCATTERING,
        CHANNEL,
        THE_SETS,
        SETS_ON_PHYSICS,
        SIGNS,
        TRANSPARENCY,
        DRIFT,
    ),
    claims=(*CLAIMS, *ON_PHYSICS),
)
