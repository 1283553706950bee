"""From a mesh file to a closed surface in metres, with a report of what is wrong with it."""

from collections.abc import Callable
from os import PathLike

import numpy as np

from sinuous.arrays import Array, ArrayLike, IntArray
from sinuous.geometry import draft as repair
from sinuous.geometry.caps import add_caps, open_findings
from sinuous.geometry.draft import Draft, Step, fatal
from sinuous.geometry.mesh_file import EXPORT_AGAIN, read_mesh
from sinuous.geometry.pieces import check_count, orient
from sinuous.geometry.report import Finding, MeshReport, Severity
from sinuous.geometry.surface import Part, Surface

SMALLEST, LARGEST = 5e-3, 10.0  # plausible sizes of a passage [m]


def _check_numbers(vertices: Array, faces: IntArray) -> list[Finding]:
    """Find what makes all further checks meaningless."""
    remedy = EXPORT_AGAIN
    if len(faces) == 0:
        return [fatal("no triangles", "a mesh of triangles", remedy)]
    bad = ~np.isfinite(vertices).all(axis=1)
    if bad.any():
        what = f"{int(bad.sum())} vertices that are not finite numbers"
        where = f"vertex {int(np.flatnonzero(bad)[0])}"
        return [fatal(what, "finite coordinates", remedy, where)]
    if faces.min() < 0 or faces.max() >= len(vertices):
        what = "a triangle that names a vertex which does not exist"
        return [fatal(what, f"vertex numbers from 0 to {len(vertices) - 1}", remedy)]
    return []


def _check_scale(draft: Draft, keep_out: bool) -> list[Finding]:
    """Find sizes that no passage has; a keep-out may be as small as it likes."""
    size = draft.size
    if size <= LARGEST and (keep_out or size >= SMALLEST):
        return []
    likely = "smaller" if size > LARGEST else "larger"
    return [
        fatal(
            f"an implausible size, {size:.3g} m ({1e3 * size:.3g} mm)",
            f"a largest extent of at most {LARGEST:g} m"
            if keep_out
            else f"a largest extent between {1e3 * SMALLEST:g} mm and {LARGEST:g} m",
            f"The unit is probably wrong: the numbers are likely in a {likely} one.",
        )
    ]


def _pipeline(cap: bool, keep_out: bool) -> list[Callable[[Draft], Step]]:
    """The checks and repairs in their order; each may rely on the ones before it."""

    def close(draft: Draft) -> Step:
        if not cap or draft.closed:
            return draft, open_findings(draft, keep_out)
        # Caps join no pieces; closing every bit of debris before saying so would take minutes.
        crumbs = check_count(draft)
        return (draft, crumbs) if crumbs else add_caps(draft)

    return [
        repair.drop_duplicates,
        repair.merge_near,
        repair.drop_flat,
        lambda d: (d, repair.check_manifold(d)),
        repair.wind_consistently,
        close,
        lambda d: (repair.split_fans(d), []),
        orient,
    ]


def _examine(
    vertices: Array, faces: IntArray, *, name: str, cap: bool, keep_out: bool
) -> tuple[Draft | None, MeshReport]:
    """Run all checks and repairs; without a draft the mesh is unusable."""

    def report(findings: list[Finding], draft: Draft | None) -> MeshReport:
        v, f = (vertices, faces) if draft is None else (draft.vertices, draft.faces)
        box = v if len(v) else np.full((1, 3), np.nan)
        return MeshReport(
            name=name,
            vertices=len(v),
            triangles=len(f),
            lower=tuple(float(x) for x in box.min(axis=0)),
            upper=tuple(float(x) for x in box.max(axis=0)),
            findings=tuple(findings),
        )

    findings = _check_numbers(vertices, faces)
    if findings:
        return None, report(findings, None)
    count = len(faces)
    source = np.arange(count)
    draft = repair.merge_identical(
        Draft(vertices=vertices, faces=faces, part=np.full(count, int(Part.FILE)), source=source)
    )
    findings = [] if len(draft.faces) else _check_numbers(vertices, draft.faces)
    findings = findings or _check_scale(draft, keep_out)
    for step in _pipeline(cap, keep_out):
        if any(f.severity is Severity.FATAL for f in findings):
            return None, report(findings, draft)
        draft, more = step(draft)
        findings += more
    usable = all(f.severity is not Severity.FATAL for f in findings)
    return (draft if usable else None), report(findings, draft)


def prepare(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    name: str,
    cap: bool = False,
    keep_out: bool = False,
) -> tuple[Surface, MeshReport]:
    """Check and repair a mesh in metres.

    Not checked: whether a single piece cuts itself; there the sign of the clearance is undefined.

    Arguments:
        vertices: [m] (V, 3)
        faces: (F, 3)
        name: of the mesh, for messages
        cap: close open ends by planar caps
        keep_out: whether the inside is blocked rather than free

    Raises:
        InputError: the first fatal finding
    """
    draft, report = _examine(
        np.array(vertices, dtype=np.float64),
        np.array(faces, dtype=np.int64),
        name=name,
        cap=cap,
        keep_out=keep_out,
    )
    report.raise_if_unusable()
    assert draft is not None
    surface = Surface(
        name=name,
        vertices=draft.vertices,
        faces=draft.faces,
        is_open=np.zeros(len(draft.faces), dtype=np.bool_),
        part=draft.part,
        source=draft.source,
        keep_out=keep_out,
    )
    return surface, report


def load_surface(
    path: str | PathLike[str], *, unit: str, cap: bool = False, keep_out: bool = False
) -> tuple[Surface, MeshReport]:
    """Load, check and repair a mesh file; arguments and errors as in `prepare`.

    Arguments:
        unit: of the numbers in the file: "m", "cm" or "mm"
    """
    vertices, faces = read_mesh(path, unit=unit)
    return prepare(vertices, faces, name=str(path), cap=cap, keep_out=keep_out)


def check_mesh(path: str | PathLike[str], *, unit: str, cap: bool = False) -> MeshReport:
    """Report everything that is found in a mesh file.

    Raises:
        InputError: if there is no mesh to speak of: no such file, another format, broken
    """
    vertices, faces = read_mesh(path, unit=unit)
    return _examine(vertices, faces, name=str(path), cap=cap, keep_out=False)[1]
