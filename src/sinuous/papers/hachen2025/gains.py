"""Gains of the reference controller, as changes of a scenario."""

from sinuous.papers.hachen2025.undisturbed import BEST, PRINTED, Gains


def _changes(gains: Gains) -> tuple[str, ...]:
    return ("control.law=dls", *(f"control.dls.{k}={v}" for k, v in gains.plain().items()))


DLS_PRINTED = _changes(PRINTED)
DLS_BEST = _changes(BEST)
