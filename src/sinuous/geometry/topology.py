"""Which triangles share which edges."""

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import kernel


def half_edges(faces: IntArray) -> IntArray:
    """Directed edges (F, 3, 2): from corner k to corner k + 1."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2)


@kernel
def _number_edges(faces: IntArray, size: int) -> tuple[IntArray, IntArray, IntArray]:
    """Edge of every half-edge (3 F,), half-edges per edge (E,), and the first two of them (E, 2).

    Half-edges are sorted into buckets by their lower vertex; a bucket holds a handful.
    """
    flat = faces.ravel()
    n = flat.shape[0]
    start = np.zeros(size + 1, np.int64)
    low, high = np.empty(n, np.int64), np.empty(n, np.int64)
    for h in range(n):
        a, b = flat[h], flat[h + 1 if h % 3 < 2 else h - 2]
        low[h], high[h] = min(a, b), max(a, b)
        start[low[h] + 1] += 1
    start = np.cumsum(start)
    fill = start.copy()
    bucket = np.empty(n, np.int64)
    number, count, members = (
        np.empty(n, np.int64),
        np.zeros(n, np.int64),
        np.empty((n, 2), np.int64),
    )
    edges = 0
    for h in range(n):
        first = -1
        for i in range(start[low[h]], fill[low[h]]):
            if high[bucket[i]] == high[h]:
                first = bucket[i]
                break
        if first < 0:
            bucket[fill[low[h]]] = h
            fill[low[h]] += 1
            number[h], members[edges, 0] = edges, h
            edges += 1
        else:
            number[h] = number[first]
            if count[number[h]] == 1:
                members[number[h], 1] = h
        count[number[h]] += 1
    return number, count[:edges].copy(), members[:edges].copy()


def edges_of(faces: IntArray) -> tuple[IntArray, IntArray]:
    """Number the undirected edges.

    Returns:
        the edge from corner k to k + 1 of every triangle (F, 3), and triangles per edge (E,)
    """
    number, count, _ = _number_edges(np.ascontiguousarray(faces), int(faces.max(initial=-1)) + 1)
    return number.reshape(-1, 3), count


def paired(faces: IntArray) -> IntArray:
    """The two half-edges (N, 2), as 3 times the triangle plus the corner, of all edges that have
    just two."""
    _, count, members = _number_edges(np.ascontiguousarray(faces), int(faces.max(initial=-1)) + 1)
    return members[count == 2]


def neighbours(faces: IntArray) -> tuple[IntArray, BoolArray]:
    """Pairs of triangles that share an edge between just the two of them.

    Returns:
        pairs (N, 2), and whether the two run along the edge in opposite directions, as consistent
        winding wants (N,)
    """
    half = paired(faces)
    start = faces.ravel()[half]
    return half // 3, start[:, 0] != start[:, 1]


@kernel
def linked(a: IntArray, b: IntArray, count: int) -> IntArray:
    """Number (count,) of the connected piece of every node of a graph with edges a[i], b[i].

    Pieces are numbered in the order of their first nodes.
    """
    above = np.arange(count)  # every piece is a tree whose root is its first node
    for i in range(a.shape[0]):
        x, y = a[i], b[i]
        while above[x] != x:
            above[x] = above[above[x]]
            x = above[x]
        while above[y] != y:
            above[y] = above[above[y]]
            y = above[y]
        above[max(x, y)] = min(x, y)
    label = np.empty(count, np.int64)
    found = 0
    for x in range(count):
        if above[x] == x:
            label[x] = found
            found += 1
        else:
            label[x] = label[above[x]]
    return label


def components(faces: IntArray) -> IntArray:
    """Number (F,) of the piece, connected through edges of two triangles, of every triangle."""
    a, b = np.ascontiguousarray(neighbours(faces)[0].T)
    return linked(a, b, len(faces))


@kernel
def same_places(points: Array) -> IntArray:
    """Number (N,) points (N, 3) so that equal ones share a number, in order of appearance.

    A hash table on the exact coordinates, which must not contain -0.0.
    """
    n = points.shape[0]
    size = 1
    while size < 2 * n:
        size *= 2
    table, label = np.full(size, -1, np.int64), np.empty(n, np.int64)
    bits = points.view(np.uint64)
    found = 0
    for i in range(n):
        key = np.uint64(0)
        for d in range(3):
            key = (key ^ bits[i, d]) * np.uint64(0x9E3779B97F4A7C15)
            key ^= key >> np.uint64(29)
        at = np.int64(key & np.uint64(size - 1))
        while table[at] >= 0:
            j = table[at]
            if (
                points[j, 0] == points[i, 0]
                and points[j, 1] == points[i, 1]
                and points[j, 2] == points[i, 2]
            ):
                break
            at = (at + 1) & (size - 1)
        if table[at] < 0:
            table[at] = i
            label[i] = found
            found += 1
        else:
            label[i] = label[table[at]]
    return label


def loops(directed: IntArray) -> list[IntArray]:
    """Chain directed edges (N, 2) into closed loops of vertices, each in the edges' direction.

    Where loops touch in a vertex they are split there. A chain that does not close is returned as
    far as it goes; on the boundary of a consistently wound mesh that does not happen.
    """
    ahead: dict[int, list[int]] = {}
    for a, b in directed.tolist():
        ahead.setdefault(a, []).append(b)
    found: list[IntArray] = []
    for first in list(ahead):
        while first in ahead:
            _walk(ahead, first, found)
    return found


def _walk(ahead: dict[int, list[int]], first: int, found: list[IntArray]) -> None:
    """Follow edges from a vertex until there are none, and take what was walked out of `ahead`."""
    path, position = [first], {first: 0}
    while path[-1] in ahead:
        here = path[-1]
        step = ahead[here].pop()
        if not ahead[here]:
            del ahead[here]
        if step in position:
            cut = position[step]
            found.append(np.array(path[cut:], dtype=np.int64))
            for v in path[cut + 1 :]:
                del position[v]
            path = path[: cut + 1]
        else:
            position[step] = len(path)
            path.append(step)
    if len(path) > 1:
        found.append(np.array(path, dtype=np.int64))
