"""What limits a robot, in few words."""

SHOWN = 2  # of all that limit it; the strongest come first


def few(limits: tuple[str, ...]) -> str:
    """The first of them, and how many more there are; "nothing" if there are none."""
    more = len(limits) - SHOWN
    return "; ".join(limits[:SHOWN]) + (f" and {more} more" if more > 0 else "") or "nothing"
