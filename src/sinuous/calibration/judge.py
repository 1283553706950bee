"""How far predicted tips are from measured ones, in all and by movement."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array, IntArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Judgement:
    """Errors of predicted tips.

    Arguments:
        errors: predicted minus measured (T, 3) [m]
        patterns: movement of each row (T,), numbers into `names`
        names: of the movements
        remove_mean: whether the mean error is taken away before: where the tracker's frame
            and the marker are is not what is judged
    """

    errors: Array
    patterns: IntArray
    names: tuple[str, ...]
    remove_mean: bool = True

    @property
    def offset(self) -> Array:
        """Mean error (3,) [m]."""
        return np.mean(self.errors, axis=0)

    @property
    def _left(self) -> Array:
        return np.linalg.norm(self.errors - (self.offset if self.remove_mean else 0.0), axis=1)

    @property
    def rmse(self) -> float:
        """Root mean square of the distances [m]."""
        return float(np.sqrt(np.mean(self._left**2)))

    @property
    def mean(self) -> float:
        """Mean of the distances [m]."""
        return float(np.mean(self._left))

    @property
    def worst(self) -> float:
        """Largest of the distances [m]."""
        return float(np.max(self._left))

    @property
    def by_pattern(self) -> dict[str, float]:
        """Root mean square of the distances [m] of every movement."""
        return {
            self.names[number]: float(np.sqrt(np.mean(self._left[self.patterns == number] ** 2)))
            for number in dict.fromkeys(self.patterns.tolist())
        }

    def as_json(self) -> dict[str, object]:
        """What goes into the JSON file."""
        return {
            "tip_rmse_m": self.rmse,
            "tip_mean_m": self.mean,
            "tip_worst_m": self.worst,
            "mean_offset_m": self.offset.tolist(),
            "mean_offset_removed": self.remove_mean,
            "rows": len(self.errors),
            "patterns": self.by_pattern,
        }
