"""What the paper says, section by section, and the functions that judge it from data."""

from sinuous.papers.qin2020.claims.channel import CHANNEL
from sinuous.papers.qin2020.claims.experiment import EXPERIMENT
from sinuous.papers.qin2020.claims.forces import FORCES
from sinuous.papers.qin2020.claims.kinematics import KINEMATICS
from sinuous.papers.qin2020.claims.transparency import TRANSPARENCY

CLAIMS = (*KINEMATICS, *CHANNEL, *FORCES, *TRANSPARENCY, *EXPERIMENT)
