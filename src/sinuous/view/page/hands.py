"""The hands that a page can choose from."""

from sinuous.leaders import Gizmo
from sinuous.leaders.leader import Leader
from sinuous.live import PathHand
from sinuous.live.processes import LeaderMaker
from sinuous.scenario import Scenario

DRAGGED, SCRIPTED = "dragged on this page", "follows the scenario's path"


def gizmo_hand(scenario: Scenario) -> Leader:
    """The hand that is dragged on the page."""
    return Gizmo()


def hands_of(name: str, given: LeaderMaker) -> dict[str, LeaderMaker]:
    """Makers of devices by what they are called, the given one first.

    Arguments:
        name: of the given one
        given: makes it
    """
    known: dict[str, LeaderMaker] = {DRAGGED: gizmo_hand, SCRIPTED: PathHand}
    first = next((called for called, make in known.items() if make is given), name)
    return {first: given} | known
