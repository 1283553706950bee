"""Pieces of a mesh: which contains which, and which way is out."""

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import kernel
from sinuous.geometry.bvh import ZoneArrays, nearest
from sinuous.geometry.draft import Draft, Step, fatal, repaired
from sinuous.geometry.report import Finding, Severity, places
from sinuous.geometry.surface import Surface, zone_arrays
from sinuous.geometry.topology import components

MOST = 64  # pieces; more than these are debris, not a passage with obstacles
TOUCH = 1e-9  # depth, as a share of the mesh's size, up to which pieces only touch


def volumes(vertices: Array, faces: IntArray, label: IntArray) -> Array:
    """Signed volume [m^3] of every closed piece, positive if it is wound outward."""
    corners = vertices[faces] - vertices[faces].mean(axis=(0, 1))
    parts = np.sum(corners[:, 0] * np.cross(corners[:, 1], corners[:, 2]), axis=1) / 6.0
    return np.bincount(label, parts).astype(np.float64)


def _zone_of(draft: Draft, label: IntArray, piece: int) -> ZoneArrays:
    """One outward-wound piece as a zone: its inside is free."""
    chosen = draft.keep(label == piece)
    surface = Surface(
        name="",
        vertices=chosen.vertices,
        faces=chosen.faces,
        is_open=np.zeros(len(chosen.faces), dtype=np.bool_),
        part=chosen.part,
        source=chosen.source,
    )
    return zone_arrays((surface,))


@kernel
def _sides(zone: ZoneArrays, points: Array, touch: float) -> tuple[BoolArray, bool]:
    """Which points (N, 3) are deeper in a zone than `touch` [m], and whether any is as far outside.

    Around a point at depth d all within d are on the same side of the wall; where the points come
    in some order that settles most of them.
    """
    within, outside = np.zeros(len(points), np.bool_), False
    depth, gradient, triangle = np.empty(1), np.empty((1, 3)), np.empty(1, np.int64)
    last, settled = 0, -1.0
    for i in range(len(points)):
        x, y, z = points[i] - points[last]
        if np.sqrt(x * x + y * y + z * z) >= settled:
            nearest(zone, points[i : i + 1], depth, gradient, triangle)
            last, settled = i, abs(depth[0]) - 2.0 * touch
        within[i] = depth[0] > touch
        outside |= depth[0] < -touch
    return within, outside


def _samples(vertices: Array, faces: IntArray) -> Array:
    """Corners, middles of edges, and centres of triangles."""
    corners = vertices[faces]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2.0
    return np.concatenate(
        [vertices[np.unique(faces)], middles.reshape(-1, 3), corners.mean(axis=1)]
    )


def _nesting(draft: Draft, label: IntArray) -> tuple[IntArray, list[Finding]]:
    """How many other pieces contain each piece (P,); crossing pieces are fatal.

    Crossing is judged at corners, edges' middles and centres; a finer crossing goes unnoticed.
    """
    count = int(label.max()) + 1
    depth = np.zeros(count, dtype=np.int64)
    ends = [_samples(draft.vertices, draft.faces[label == k]) for k in range(count)]
    lower, upper = [e.min(axis=0) for e in ends], [e.max(axis=0) for e in ends]
    zones: list[ZoneArrays | None] = [None] * count
    for i in range(count):
        for j in range(count):
            if i == j or np.any(lower[i] > upper[j]) or np.any(lower[j] > upper[i]):
                continue
            zone = zones[j] = zones[j] or _zone_of(draft, label, j)
            within, outside = _sides(zone, ends[i], TOUCH * draft.size)
            if within.any() and outside:
                return depth, [
                    fatal(
                        "pieces that cross each other",
                        "pieces that are apart or inside one another",
                        "Unite them in a mesh editor.",
                        places(ends[i][within]),
                    )
                ]
            depth[i] += int(within.any())
    return depth, []


def check_count(draft: Draft) -> list[Finding]:
    """Find more pieces than a passage with obstacles has."""
    count = int(components(draft.faces).max()) + 1
    if count <= MOST:
        return []
    what, remedy = f"{count} separate pieces", "Remove debris in a mesh editor."
    return [fatal(what, f"one piece, or at most {MOST}", remedy)]


def _middles(draft: Draft, label: IntArray, chosen: IntArray) -> str:
    """The means of the triangles' centres of some pieces, as text."""
    centres = draft.centres
    return places([centres[label == k].mean(axis=0) for k in chosen])


def orient(draft: Draft) -> Step:
    """Wind outer pieces outward; a piece inside another is an obstacle and is wound inward."""
    if findings := check_count(draft):
        return draft, findings
    label = components(draft.faces)
    count = int(label.max()) + 1
    volume = volumes(draft.vertices, draft.faces, label)
    hollow = np.abs(volume) <= 1e-12 * draft.size**3
    if hollow.any():
        what, remedy = "a piece without volume", "Remove it in a mesh editor."
        where = _middles(draft, label, np.flatnonzero(hollow))
        return draft, [fatal(what, "a mesh that encloses a volume", remedy, where)]
    outward = draft.flip(volume[label] < 0.0)
    depth = np.zeros(count, dtype=np.int64)
    if count > 1:
        depth, findings = _nesting(outward, label)
        inner = int(np.sum(depth % 2))
        findings.append(
            Finding(
                severity=Severity.NOTE,
                what=f"{count} separate pieces, {inner} of them inside another",
                where=_middles(draft, label, np.arange(count)),
                expected="one piece",
                remedy="Inner pieces count as obstacles; nothing leads from one outer piece to "
                "another.",
            )
        )
    inverted = (volume < 0.0) != (depth % 2 == 1)
    if inverted.any():
        what = "an inverted mesh" if count == 1 else f"{int(inverted.sum())} inverted pieces"
        findings.append(repaired(what, "All its triangles were turned round."))
    return outward.flip(depth[label] % 2 == 1), findings
