"""What is right and wrong with a mesh, in words."""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from sinuous.arrays import ArrayLike
from sinuous.errors import InputError


class Severity(Enum):
    """How much a finding matters."""

    NOTE = "note"  # worth knowing, nothing was changed
    REPAIRED = "repaired"
    FATAL = "fatal"  # the mesh cannot be used


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing found in a mesh.

    Arguments:
        severity: whether it matters
        what: what was found
        where: where in the mesh, empty if everywhere
        expected: what would have been good
        remedy: what was done about it or what the user can do
    """

    severity: Severity
    what: str
    where: str = ""
    expected: str
    remedy: str

    def __str__(self) -> str:
        where = f" at {self.where}" if self.where else ""
        return f"{self.severity.value}: {self.what}{where}. {self.remedy}"


@dataclass(frozen=True, kw_only=True)
class MeshReport:
    """Everything found in a mesh.

    Arguments:
        name: of the mesh
        vertices, triangles: how many of them
        lower, upper: corners of the mesh's box [m] (3,), nan without vertices
        findings: in the order in which they were found
    """

    name: str
    vertices: int
    triangles: int
    lower: tuple[float, ...]
    upper: tuple[float, ...]
    findings: tuple[Finding, ...]

    @property
    def extents(self) -> tuple[float, ...]:
        """Size of the mesh's box [m] (3,)."""
        return tuple(b - a for a, b in zip(self.lower, self.upper, strict=True))

    @property
    def usable(self) -> bool:
        """Whether the mesh, repaired as reported, can be used."""
        return all(f.severity is not Severity.FATAL for f in self.findings)

    def raise_if_unusable(self) -> None:
        """Raise the first fatal finding, if there is one, as an `InputError`."""
        for f in self.findings:
            if f.severity is Severity.FATAL:
                found = f"{f.what} at {f.where}" if f.where else f.what
                raise InputError(file=self.name, expected=f.expected, found=found, remedy=f.remedy)

    def __str__(self) -> str:
        size = " x ".join(f"{1e3 * e:.4g}" for e in self.extents)
        head = f"{self.name}: {self.triangles} triangles, {self.vertices} vertices, {size} mm"
        return "\n".join([head, *(f"  {f}" for f in self.findings)])


def places(points: ArrayLike, most: int = 3) -> str:
    """The first few points [m] (N, 3) as text."""
    rows = np.atleast_2d(np.asarray(points, dtype=np.float64)).tolist()
    text = ", ".join(
        "(" + ", ".join(f"{round(x, 6) + 0.0:g}" for x in row) + ") m" for row in rows[:most]
    )
    return text + (f" and {len(rows) - most} more" if len(rows) > most else "")
