"""Gains of the reference controller, as changes of a scenario."""

DLS_PRINTED = ("control.law=dls",)
"""k_j = 0.05 and c_w = 1, III-A."""

DLS_BEST = ("control.law=dls", "control.dls.gain=0.2", "control.dls.damping=1")
"""The best that the search of `stability` found."""
