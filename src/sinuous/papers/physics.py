"""Whether what runs on physics can run here."""

from sinuous.errors import InputError
from sinuous.papers.claims import Found, Verdict
from sinuous.papers.experiment import Data
from sinuous.plants.physics.engine import require_mujoco


def why_not() -> str:
    """What is missing for physics, in words; empty if nothing is."""
    try:
        require_mujoco()
    except InputError as error:
        return str(error)
    return ""


def nothing(reason: str) -> Data:
    """What an experiment on physics finds where there is none."""
    return {"missing": reason, "rows": []}


def is_missing(data: Data) -> bool:
    """Whether an experiment found no physics."""
    return bool(data["missing"])


def unknown(found: Found, name: str) -> Verdict | None:
    """The verdict on an experiment that found no physics, None if it did."""
    missing = found[name]["missing"]
    return Verdict(measured="", holds=None, reason=missing) if missing else None
