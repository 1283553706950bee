"""A mesh on its way to being usable, and the repairs that cannot change its shape."""

from dataclasses import dataclass, replace

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.geometry.report import Finding, Severity, places
from sinuous.geometry.topology import edges_of, half_edges, linked, neighbours, paired, same_places

FLAT = 1e-12  # height of a triangle, as a share of the mesh's size, that counts as no area


@dataclass(frozen=True, kw_only=True, eq=False)
class Draft:
    """Vertices [m] (V, 3), faces (F, 3), and part and source per face (F,) as in `Surface`."""

    vertices: Array
    faces: IntArray
    part: IntArray
    source: IntArray

    @property
    def size(self) -> float:
        """Largest extent of the box of all vertices [m]."""
        return float(np.ptp(self.vertices, axis=0).max())

    @property
    def centres(self) -> Array:
        """Centre of every face [m] (F, 3)."""
        return self.vertices[self.faces].mean(axis=1)

    @property
    def closed(self) -> bool:
        """Whether every edge joins exactly two faces."""
        return bool(np.all(edges_of(self.faces)[1] == 2))

    def keep(self, chosen: BoolArray) -> "Draft":
        """Only the chosen faces (F,)."""
        return replace(
            self, faces=self.faces[chosen], part=self.part[chosen], source=self.source[chosen]
        )

    def flip(self, chosen: BoolArray) -> "Draft":
        """The winding of the chosen faces (F,) reversed."""
        return replace(self, faces=np.where(chosen[:, None], self.faces[:, ::-1], self.faces))


Step = tuple[Draft, list[Finding]]


def repaired(what: str, remedy: str, where: str = "") -> Finding:
    """A finding that was repaired; what would have been good is its absence."""
    return Finding(
        severity=Severity.REPAIRED, what=what, where=where, expected="none", remedy=remedy
    )


def fatal(what: str, expected: str, remedy: str, where: str = "") -> Finding:
    """A finding that makes the mesh unusable."""
    return Finding(
        severity=Severity.FATAL, what=what, where=where, expected=expected, remedy=remedy
    )


def _merge(draft: Draft, places_of: Array) -> Draft:
    """Merge vertices whose rows of `places_of` (V, 3) agree; drop faces that lose a corner."""
    label = same_places(places_of)
    first = np.zeros(int(label.max(initial=-1)) + 1, dtype=np.int64)
    first[label[::-1]] = np.arange(len(label))[::-1]
    faces = label[draft.faces]
    moved = replace(draft, vertices=draft.vertices[first], faces=faces)
    return moved.keep(
        (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    )


def merge_identical(draft: Draft) -> Draft:
    """Merge vertices with the same coordinates (an STL file repeats them) and drop unused ones."""
    used = np.zeros(len(draft.vertices), dtype=np.bool_)
    used[draft.faces] = True
    number = np.cumsum(used) - 1
    cleared = draft.vertices[used] + 0.0  # -0.0 and 0.0 are the same place
    return _merge(replace(draft, vertices=cleared, faces=number[draft.faces]), cleared)


def merge_near(draft: Draft, share: float = 1e-6) -> Step:
    """Close hairline cracks: merge vertices on a grid, if that makes an open mesh closed."""
    if draft.closed:
        return draft, []
    step = share * draft.size
    for shift in (0.0, 0.5):  # a pair on two sides of a grid line meets on the shifted grid
        merged = _merge(draft, np.floor(draft.vertices / step + shift) + 0.0)
        if len(merged.faces) == len(draft.faces) and merged.closed:
            count = len(draft.vertices) - len(merged.vertices)
            what = f"cracks between {count} pairs of vertices closer than {1e3 * step:.2g} mm"
            return merged, [repaired(what, "They were merged.")]
    return draft, []


def drop_duplicates(draft: Draft) -> Step:
    """Drop triangles that occur twice, and pairs that lie back to back."""
    edges = np.sort(edges_of(draft.faces)[0], axis=1)
    pair = np.sort(edges[:, 0] * 3 * len(edges) + edges[:, 1])  # two edges name a triangle
    if np.all(pair[1:] != pair[:-1]):
        return draft, []
    low = draft.faces.argmin(axis=1)[:, None]
    turned = np.take_along_axis(draft.faces, (np.arange(3)[None, :] + low) % 3, axis=1)
    forward = turned[:, 1] < turned[:, 2]
    key = np.sort(draft.faces, axis=1)
    _, group = np.unique(key, axis=0, return_inverse=True)
    group = group.ravel()
    net = np.bincount(group, np.where(forward, 1.0, -1.0))
    wanted = (net[group] > 0) == forward
    wanted &= net[group] != 0
    keep = np.zeros(len(group), dtype=np.bool_)
    keep[np.unique(np.where(wanted, group, -1), return_index=True)[1]] = True
    keep &= wanted
    what = f"{int((~keep).sum())} duplicate triangles"
    where = places(draft.centres[~keep])
    return draft.keep(keep), [repaired(what, "They were dropped.", where)]


def drop_flat(draft: Draft) -> Step:
    """Drop triangles without area if the mesh stays closed without them."""
    corners = draft.vertices[draft.faces]
    sides = np.roll(corners, -1, axis=1) - corners
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    area = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    flat = area <= FLAT * draft.size * longest
    if not flat.any():
        return draft, []
    what, where = f"{int(flat.sum())} triangles without area", places(draft.centres[flat])
    slim = draft.keep(~flat)
    if len(slim.faces) > 0 and slim.closed:
        return slim, [repaired(what, "They were dropped.", where)]
    remedy = "Remesh it, or collapse these triangles, in a mesh editor."
    return draft, [fatal(what, "triangles with an area", remedy, where)]


def check_manifold(draft: Draft) -> list[Finding]:
    """Find edges with more than two triangles."""
    edges, count = edges_of(draft.faces)
    bad = count[edges] > 2
    if not bad.any():
        return []
    ends = draft.vertices[half_edges(draft.faces)[bad]].mean(axis=1)
    _, first = np.unique(edges[bad], return_index=True)
    return [
        fatal(
            f"not a manifold: {len(first)} edges with more than two triangles",
            "edges that join two triangles each",
            "Remove inner walls and unite parts that touch, in a mesh editor.",
            places(ends[np.sort(first)]),
        )
    ]


def split_fans(draft: Draft) -> Draft:
    """Give every fan of triangles its own copy of a vertex in which several fans touch.

    A pseudonormal belongs to one fan; a vertex shared by two would have a meaningless one.
    """
    faces = draft.faces
    one, two = paired(faces).T
    links: list[tuple[IntArray, IntArray]] = []
    for end in (0, 1):  # both ends of the shared edge, in whichever direction the other face has it
        a = one // 3 * 3 + (one + end) % 3
        behind = two // 3 * 3 + (two + 1) % 3
        links.append((a, np.where(faces.ravel()[a] == faces.ravel()[two], two, behind)))
    a, b = (np.concatenate(side) for side in zip(*links, strict=True))
    label = linked(a, b, faces.size)
    if int(label.max()) + 1 == len(draft.vertices):
        return draft
    _, first = np.unique(label, return_index=True)
    return replace(draft, vertices=draft.vertices[faces.ravel()[first]], faces=label.reshape(-1, 3))


def wind_consistently(draft: Draft) -> Step:
    """Flip triangles so that neighbours agree on which side is out.

    Every face gets two nodes, as it is and flipped; neighbours link the nodes that agree. The
    pieces of this graph are the two ways to wind a component, or one if it has a single side.
    """
    pairs, agree = neighbours(draft.faces)
    n = len(draft.faces)
    if agree.all():
        return draft, []
    a, b = pairs.T
    ends = np.concatenate([b + np.where(agree, 0, n), b + np.where(agree, n, 0)])
    label = linked(np.concatenate([a, a + n]), ends, 2 * n)
    one_sided = label[:n] == label[n:]
    if one_sided.any():
        what = "a surface with a single side, like a Moebius strip"
        remedy = "Rebuild it in a mesh editor."
        return draft, [fatal(what, "an inside and an outside", remedy)]
    piece = np.minimum(label[:n], label[n:])
    flipped = label[:n] != piece
    mostly = np.bincount(piece, np.where(flipped, 1.0, -1.0), minlength=2 * n)[piece] > 0
    flipped = np.where(mostly, ~flipped, flipped)
    what = f"inconsistent winding: {int(flipped.sum())} triangles face the wrong way"
    where = places(draft.centres[flipped])
    return draft.flip(flipped), [repaired(what, "They were turned round.", where)]
