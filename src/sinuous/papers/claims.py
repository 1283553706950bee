"""What a paper says that can be checked, and what was found."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from sinuous.papers.experiment import Data

Found = Mapping[str, Data]
"""What the experiments found, by their names."""


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """What the data say about a claim.

    Arguments:
        measured: the numbers behind it, in words
        holds: None if it cannot be judged
        reason: why not, or what one has to know beside the numbers
    """

    measured: str
    holds: bool | None
    reason: str = ""


@dataclass(frozen=True, kw_only=True)
class Claim:
    """One statement of a paper.

    Arguments:
        name: of the claim, short
        section: of the paper
        printed: what stands there, in our words, with its numbers
        needs: experiments whose data the verdict is computed from
        judge: computes the verdict from all data
    """

    name: str
    section: str
    printed: str
    needs: tuple[str, ...]
    judge: Callable[[Found], Verdict]

    def verdict(self, found: Found) -> Verdict:
        """The verdict, or why there is none."""
        missing = [name for name in self.needs if name not in found]
        if missing:
            return Verdict(
                measured="", holds=None, reason=f"{', '.join(missing)} did not run this time"
            )
        return self.judge(found)


def rows(claims: tuple[Claim, ...], found: Found) -> list[dict[str, object]]:
    """All claims with their verdicts, as `claims.json` holds them."""
    table = list[dict[str, object]]()
    for claim in claims:
        verdict = claim.verdict(found)
        table.append(
            {
                "id": claim.name,
                "section": claim.section,
                "printed": claim.printed,
                "measured": verdict.measured,
                "holds": verdict.holds,
                "reason": verdict.reason,
                "data": [f"data/{name}.json" for name in claim.needs],
                "verdict": f"{claim.judge.__module__}.{claim.judge.__name__}",
            }
        )
    return table
