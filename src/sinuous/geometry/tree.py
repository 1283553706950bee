"""A tree of boxes over triangles, built by median splits."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import kernel

LEAF = 8  # triangles in a leaf; halving or doubling it is slower or no faster


class Tree(NamedTuple):
    """Boxes over the triangles of one surface.

    Arguments:
        order: triangles in leaf order (L,)
        lower, upper: corners of the boxes [m] (B, 3)
        child: left child (the right one follows it), or the first leaf slot (B,)
        leaf: triangles in a leaf, 0 for an inner box (B,)
    """

    order: IntArray
    lower: Array
    upper: Array
    child: IntArray
    leaf: IntArray


@kernel
def _split(key: Array, order: IntArray, first: int, last: int, middle: int) -> None:
    """Reorder order[first:last + 1] until order[middle] is the one a sort by key puts there."""
    while first < last:
        pivot = key[order[(first + last) // 2]]
        i, j = first, last
        while i <= j:
            while key[order[i]] < pivot:
                i += 1
            while key[order[j]] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if middle <= j:
            last = j
        elif middle >= i:
            first = i
        else:
            return


@kernel
def _fit(corners: Array, order: IntArray, begin: int, end: int, lower: Array, upper: Array) -> int:
    """Fit a box around triangles order[begin:end]; returns the axis their centres spread most."""
    axis, spread = 0, -1.0
    for d in range(3):
        low, high, centre_low, centre_high = np.inf, -np.inf, np.inf, -np.inf
        for s in range(begin, end):
            c = corners[order[s]]
            low = min(low, c[0, d], c[1, d], c[2, d])
            high = max(high, c[0, d], c[1, d], c[2, d])
            centre = c[0, d] + c[1, d] + c[2, d]
            centre_low, centre_high = min(centre_low, centre), max(centre_high, centre)
        lower[d], upper[d] = low, high
        if centre_high - centre_low > spread:
            axis, spread = d, centre_high - centre_low
    return axis


@kernel
def build(corners: Array) -> Tree:
    """Build the tree by median splits along the axis of largest spread.

    Arguments:
        corners: triangles [m] (L, 3, 3), at least one
    """
    n = corners.shape[0]
    order = np.arange(n)
    lower, upper = np.empty((2 * n, 3)), np.empty((2 * n, 3))
    child, leaf = np.zeros(2 * n, np.int64), np.zeros(2 * n, np.int64)
    span = np.empty((2 * n, 2), np.int64)
    span[0, 0], span[0, 1] = 0, n
    key = np.empty(n)
    boxes, node = 1, 0
    while node < boxes:
        begin, end = span[node, 0], span[node, 1]
        axis = _fit(corners, order, begin, end, lower[node], upper[node])
        if end - begin <= LEAF:
            child[node], leaf[node] = begin, end - begin
        else:
            for s in range(begin, end):
                c = corners[order[s]]
                key[order[s]] = c[0, axis] + c[1, axis] + c[2, axis]
            middle = (begin + end) // 2
            _split(key, order, begin, end - 1, middle)
            child[node] = boxes
            span[boxes, 0], span[boxes, 1] = begin, middle
            span[boxes + 1, 0], span[boxes + 1, 1] = middle, end
            boxes += 2
        node += 1
    return Tree(
        order,
        lower[:boxes].copy(),
        upper[:boxes].copy(),
        child[:boxes].copy(),
        leaf[:boxes].copy(),
    )
