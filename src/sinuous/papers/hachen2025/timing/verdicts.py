"""What the data of III-F say beside the printed times."""

from typing import Any

from sinuous.papers.experiment import Data

OURS = "sinuous"
INSTALLED = "CasADi IPOPT, as installed"
COMPILED = "CasADi IPOPT, compiled"

PRINTED_MEAN, PRINTED_HORIZON = 0.030, 2  # with shape constraints [s]
PRINTED_BOUND = 0.100  # on the mean [s] ...
BELOW_BOUND = {False: 6, True: 4}  # ... of shorter horizons, without and with constraints


def of(data: Data, controller: str, constrained: bool) -> dict[int, dict[str, Any]]:
    """Rows of a controller that ran, by horizon."""
    return {
        row["horizon"]: row
        for row in data["rows"]
        if row["controller"] == controller
        and row["constrained"] == constrained
        and row["mean_s"] is not None
    }


def speed_up(data: Data) -> float:
    """The printed mean time by ours, N = 2 with shape constraints; machines differ."""
    return PRINTED_MEAN / of(data, OURS, True)[PRINTED_HORIZON]["mean_s"]


def bridge(data: Data) -> float | None:
    """The printed mean time by IPOPT's here, N = 2 with shape constraints.

    How much less time than printed the same kind of solver takes here: the part of `speed_up`
    that machine and tuning are worth. None if IPOPT did not run.
    """
    row = of(data, INSTALLED, True).get(PRINTED_HORIZON)
    return None if row is None else PRINTED_MEAN / row["mean_s"]


def ratios(data: Data, controller: str, constrained: bool) -> dict[int, float]:
    """Mean time of another controller by ours over the same steps, by horizon."""
    rows = of(data, controller, constrained)
    return {N: row["mean_s"] / row["ours_mean_s"] for N, row in rows.items()}


def longest_below(data: Data, constrained: bool, bound: float = PRINTED_BOUND) -> int:
    """The longest horizon up to which all of our means stay below a bound [s]; 0 for none."""
    longest = 0
    for N, row in sorted(of(data, OURS, constrained).items()):
        if row["mean_s"] >= bound:
            break
        longest = N
    return longest
