"""Planar caps that close the open ends of a mesh."""

from dataclasses import replace

import mapbox_earcut
import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.geometry.draft import Draft, Step, fatal, repaired
from sinuous.geometry.normals import unit
from sinuous.geometry.outline import PLANAR, nested, outlines_of
from sinuous.geometry.report import Finding, places
from sinuous.geometry.surface import Part
from sinuous.geometry.topology import edges_of, half_edges, loops


def boundary_loops(draft: Draft) -> list[IntArray]:
    """Vertices along every open end, in the direction that a cap winds outward."""
    edges, count = edges_of(draft.faces)
    return loops(half_edges(draft.faces)[count[edges] == 1][:, ::-1])


def open_findings(draft: Draft, keep_out: bool = False) -> list[Finding]:
    """Say how many open ends a mesh has and where; those of a keep-out are never capped."""
    ends = boundary_loops(draft)
    if not ends:
        return []
    outlines = outlines_of(draft.vertices, ends)
    sizes = ", ".join(f"{1e3 * size:.3g}" for size in outlines.size[:3])
    if keep_out:
        remedy = "Close it in a mesh editor: a keep-out has to enclose what it blocks."
    elif np.all(outlines.off <= PLANAR * outlines.size):
        remedy = "Set cap = true to close the open ends by planar caps."
    else:
        remedy = "Close it in a mesh editor; caps are only made for planar ends."
    count = "one open end" if len(ends) == 1 else f"{len(ends)} open ends"
    what = f"an open mesh: {count}, {sizes} mm across"
    return [fatal(what, "a closed mesh", remedy, places(outlines.centre))]


def _fill(flat: Array) -> list[tuple[int, int, int]]:
    """Triangulate a polygon (N, 2), using every vertex although earcut skips those on a line."""
    n = len(flat)
    cut = mapbox_earcut.triangulate_float64(flat, np.array([n], dtype=np.uint32))
    todo = [(int(a), int(b), int(c)) for a, b, c in cut.reshape(-1, 3)]
    directed = {e for a, b, c in todo for e in ((a, b), (b, c), (c, a))}
    if todo and sum((b - a) % n == 1 for a, b in directed) < sum(
        (a - b) % n == 1 for a, b in directed
    ):
        todo = [(a, c, b) for a, b, c in todo]
        directed = {(b, a) for a, b in directed}
    done: list[tuple[int, int, int]] = []
    while todo:
        triangle = todo.pop()
        for k in range(3):
            a, b, c = triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]
            if (b - a) % n != 1 and (b, a) not in directed:  # an outline edge with skipped vertices
                middle = (a + 1) % n
                todo += [(a, middle, c), (middle, b, c)]
                directed |= {(middle, b), (c, middle), (middle, c)}
                break
        else:
            done.append(triangle)
    return done


def add_caps(draft: Draft) -> Step:
    """Close every planar open end; the mesh must be wound consistently."""
    faces: list[IntArray] = []
    ends = boundary_loops(draft)
    findings: list[Finding] = []
    outlines = outlines_of(draft.vertices, ends)
    if (inner := nested(outlines)) >= 0:
        # One lies in another: a cap on each would overlap.
        what, remedy = "a ring-shaped open end", "Close it in a mesh editor."
        where = places([outlines.centre[inner]])
        return draft, [fatal(what, "open ends with one outline each", remedy, where)]
    for loop, centre, normal, off, size in zip(ends, *outlines, strict=True):
        outline = draft.vertices[loop]
        if off > PLANAR * size:
            what = f"an open end that is {1e3 * off:.3g} mm from planar"
            remedy = "Cut the end by a plane in a mesh editor, then cap it."
            return draft, [fatal(what, "a planar open end", remedy, places([centre]))]
        across: Array = outline[np.argmax(np.linalg.norm(outline - centre, axis=1))] - centre
        u = unit(across - (across @ normal) * normal)
        flat = (outline - centre) @ np.stack([u, np.cross(normal, u)], axis=1)
        faces.append(loop[np.array(_fill(flat), dtype=np.int64).reshape(-1, 3)])
        what = f"an open end {1e3 * size:.3g} mm across"
        findings.append(repaired(what, "It was closed by a planar cap.", places([centre])))
    count = sum(len(f) for f in faces)
    capped = replace(
        draft,
        faces=np.concatenate([draft.faces, *faces]),
        part=np.concatenate([draft.part, np.full(count, int(Part.CAP))]),
        source=np.concatenate([draft.source, np.arange(count)]),
    )
    if not capped.closed:
        what, remedy = "open ends with crossing outlines", "Close them in a mesh editor."
        return draft, [fatal(what, "open ends with simple outlines", remedy)]
    return capped, findings
