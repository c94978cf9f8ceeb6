"""Bounds on the relative motion of disks since the pairs were listed.

Waves move neighbours together, often by many times the gap up to which pairs are listed. The disks are therefore
sorted into cells, and only disks in the same cell or in two that touch are compared, by the boxes that contain
the displacements of each cell. Disks in other cells are so far apart that they cannot meet before one has moved by
`cells.reach`.
"""

import numpy as np
from numba import njit, types

from dembound.kernels.apart import apart, in_chunks
from dembound.kernels.common import CHUNKS, FAST, MAKES, largest

ACROSS = ((0, 0), (1, 0), (-1, 1), (0, 1), (1, 1))
"""Steps from a cell to itself and to half of the cells that touch it."""


@njit(**FAST)
def _span(a, b):
    """Largest distance between a point in box a and one in box b; boxes are (4,) smallest and largest x and y."""
    return np.hypot(max(a[1] - b[0], b[1] - a[0]), max(a[3] - b[2], b[3] - a[2]))


@in_chunks
@njit(**FAST)
def _boxes(first_chunk, last_chunk, u, begin, origin, cells, boxes):
    """Fill boxes (c, 4) with smallest and largest displacement along x and y in every cell since the origin (2, n)."""
    n = len(boxes)
    for c in range(first_chunk * n // CHUNKS, last_chunk * n // CHUNKS):
        box = boxes[c]
        box[0] = box[2] = np.inf
        box[1] = box[3] = -np.inf
        for m in range(cells.start[c], cells.start[c + 1]):
            i = cells.member[m]
            x, y = u[0, begin + i] - origin[0, i], u[1, begin + i] - origin[1, i]
            box[0], box[1] = min(box[0], x), max(box[1], x)
            box[2], box[3] = min(box[2], y), max(box[3], y)


@njit(**FAST)
def _farthest_of(c, cells, boxes):
    """Largest relative displacement of a disk in cell c and one in a cell that touches it."""
    columns, rows = cells.divisions[0], cells.divisions[1]
    column, row = c % columns, c // columns
    far = 0.0
    for right, up in ACROSS:
        x, y = column + right, row + up
        if cells.wraps[0]:
            x %= columns
        if cells.wraps[1]:
            y %= rows
        if 0 <= x < columns and 0 <= y < rows:
            other = y * columns + x
            if cells.start[other + 1] > cells.start[other]:
                far = max(far, _span(boxes[c], boxes[other]))
    return far


@njit(**MAKES)
def moved(u, begin, origin):
    """Largest displacement (m) of the n particles from `begin` on since the displacements origin (2, n)."""
    squares = np.empty(CHUNKS)
    _largest_squares(u, begin, origin, squares)
    return np.sqrt(largest(squares))


@in_chunks
@njit(**FAST)
def _largest_squares(first_chunk, last_chunk, u, begin, origin, squares):
    """Fill squares (chunks,) with the largest squared displacements of the particles of each chunk, see `moved`."""
    n = origin.shape[1]
    for chunk in range(first_chunk, last_chunk):
        square = 0.0
        for i in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            x, y = u[0, begin + i] - origin[0, i], u[1, begin + i] - origin[1, i]
            square = max(square, x**2 + y**2)
        squares[chunk] = square


@apart(types.float64)
@njit(**MAKES)
def approach(u, begin, origin, cells):
    """Upper bound (m) of the relative displacement since the origin (2, n) of two disks that may meet.

    u : (3, …) displacements; the n disks are those from `begin` on; cells : tables.Cells.
    """
    alone = moved(u, begin, origin)
    if alone > cells.reach:
        return 2.0 * alone
    count = cells.start.size - 1
    boxes = np.empty((count, 4))
    _boxes(u, begin, origin, cells, boxes)
    far = np.empty(CHUNKS)
    _farthest(cells, boxes, far)
    return min(2.0 * alone, largest(far))


@in_chunks
@njit(**FAST)
def _farthest(first_chunk, last_chunk, cells, boxes, far):
    """Fill far (chunks,) with the largest relative displacement of disks in each chunk of cells and neighbours."""
    count = cells.start.size - 1
    for chunk in range(first_chunk, last_chunk):
        most = 0.0
        for c in range(chunk * count // CHUNKS, (chunk + 1) * count // CHUNKS):
            if cells.start[c + 1] > cells.start[c]:
                most = max(most, _farthest_of(c, cells, boxes))
        far[chunk] = most
