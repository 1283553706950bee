"""What to do: a robot, a zone, a controller, a path and a plant, from a file or from Python."""

from sinuous.scenario.load import load_scenario
from sinuous.scenario.scenario import Scenario

__all__ = ["Scenario", "load_scenario"]
