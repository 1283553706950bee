"""How old a reading is, by the time of the session."""


class Freshness:
    """Notes when something new was first seen."""

    def __init__(self) -> None:
        self._number = -1
        self._since = 0.0

    def age(self, number: int, time: float) -> float:
        """Time [s] since the number was another one."""
        if number != self._number:
            self._number, self._since = number, time
        return time - self._since
