"""Pairs of disks with small gaps, found by a grid of cells.

The grid is a table with wrap-around: cells beyond its end are entered at its beginning. Disks that share a cell only by
that are told apart by their distance, so the table stays small when single disks are far away.
"""

import math

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, MAKES, U, largest

MARGIN = 1.0 + 1e-9  # of distances that only choose candidates, so that rounding misses no pair


@njit(**FAST)
def cell(value, low, width):
    """Number of the cell of a coordinate, before wrap-around."""
    return np.int64(math.floor((value - low) / width))


@njit(**MAKES)
def table_shape(extent, width, count):
    """Cells (2,) of the table along x and y, powers of two.

    At least four, as a disk looks into three different ones; enough for the extent (2,) m, as long as they are at most
    four for each of the `count` disks.
    """
    shape = np.array([4, 4])
    while shape[0] * shape[1] < 2 * count:
        axis = 0 if extent[0] * shape[1] > extent[1] * shape[0] else 1
        if extent[axis] < width * shape[axis]:
            break
        shape[axis] *= 2
    return shape


@njit(**FAST)
def count_or_place(positions, low, width, shape, start, order):
    """Enter each disk i in its column and row, and in the rows beyond the ends that repeat the first and the last row.

    The place of an entry is start[cell + 1], which is then raised; entries beyond the end of `order` are only counted.
    """
    rows = shape[1]
    for i in range(positions.shape[0]):
        column = cell(positions[i, 0], low[0], width) & (shape[0] - 1)
        row = cell(positions[i, 1], low[1], width) & (rows - 1)
        for turn in range(-1, 2):
            own = row + 1 + turn * rows
            if 0 <= own < rows + 2:
                at = U(column * (rows + 2) + own + 1)
                if start[at] < order.size:
                    order[U(start[at])] = i
                start[at] += 1


@njit(**MAKES)
def sort_into_cells(positions, low, width, shape):
    """Entries (e,) uint32 cell after cell, up along the columns, and the first entry of each cell, (cells + 1,).

    A column begins with a copy of its last row and ends with one of its first, so that the three rows around a disk
    are one range of entries.
    """
    cells = shape[0] * (shape[1] + 2)
    many = np.zeros(cells + 1, np.uint32)
    count_or_place(positions, low, width, shape, many, np.empty(0, np.uint32))
    start = np.zeros(cells + 1, np.uint32)
    for k in range(1, cells):
        start[k + 1] = start[k] + many[k]
    order = np.empty(start[cells] + many[cells], np.uint32)
    count_or_place(positions, low, width, shape, start, order)
    return order, start


@njit(**FAST)
def insert(pairs, images, begin, end, i, j, a, b):
    """Enter the pair i, j with image a, b into the entries begin:end, which are sorted by j, then by image."""
    k = end
    while k > begin and (
        pairs[k - 1, 1] > j
        or (pairs[k - 1, 1] == j and (images[k - 1, 0] > a or (images[k - 1, 0] == a and images[k - 1, 1] > b)))
    ):
        pairs[k, 1], images[k, 0], images[k, 1] = pairs[k - 1, 1], images[k - 1, 0], images[k - 1, 1]
        k -= 1
    pairs[end, 0] = i
    pairs[k, 1], images[k, 0], images[k, 1] = j, a, b


@njit(**FAST)
def is_near(positions, radii, gap, i, j, shift_x, shift_y):
    """Whether the gap between disk i and disk j, which is shifted, is at most `gap`; false for j before i."""
    dx = positions[j, 0] + shift_x - positions[i, 0]
    dy = positions[j, 1] + shift_y - positions[i, 1]
    reach = (radii[i] + radii[j] + gap) * MARGIN
    if j < i or dx * dx + dy * dy > reach * reach:
        return False
    return math.hypot(dx, dy) - radii[i] - radii[j] <= gap


@njit(**FAST)
def search(positions, radii, gap, periods, low, high, width, shape, order, start, pairs, images):
    """Fill pairs and images as far as there is room, and return the number of pairs, see `near_pairs`."""
    found = 0
    for i in range(positions.shape[0]):
        begin = found
        for way in range(9):
            a, b = way // 3 - 1, way % 3 - 1
            if (a != 0 and periods[0] == 0.0) or (b != 0 and periods[1] == 0.0):
                continue
            shift_x, shift_y = a * periods[0], b * periods[1]
            # the pair's first disk is shifted back, so that the table need not contain images
            x, y = positions[i, 0] - shift_x, positions[i, 1] - shift_y
            if x < low[0] - width or x > high[0] + width or y < low[1] - width or y > high[1] + width:
                continue
            column, row = cell(x, low[0], width), cell(y, low[1], width)
            for side in range(-1, 2):
                at = (column + side & (shape[0] - 1)) * (shape[1] + 2) + (row & (shape[1] - 1))
                for k in range(start[at], start[at + 3]):
                    j = np.int64(order[U(k)])
                    if not is_near(positions, radii, gap, i, j, shift_x, shift_y) or (j == i and way <= 4):
                        continue
                    if found < pairs.shape[0]:
                        insert(pairs, images, begin, found, i, j, a, b)
                    found += 1
    return found


@njit(**MAKES)
def near_pairs(positions, radii, gap, periods):
    """All pairs of disks whose gap is at most `gap` (m), also through periodic sides, each once.

    positions (n, 2), radii (n,) in m; periods (2,) m, 0.0 along an axis that is not periodic. Disks may be outside the
    period, but only images from −1 to 1 are found. Returns pairs (b, 2) int64 and images (b, 2) int64, sorted by first
    disk, second disk and image: the vector is x_j + images·periods − x_i, with i < j, or with i = j and the image after
    (0, 0).
    """
    count = positions.shape[0]
    room = 4 * count + 16
    pairs, images = np.empty((room, 2), np.int64), np.empty((room, 2), np.int64)
    if count == 0:
        return pairs[:0], images[:0]
    low, high = np.empty(2), np.empty(2)
    for axis in range(2):
        low[axis], high[axis] = positions[:, axis].min(), positions[:, axis].max()
    width = (2.0 * largest(radii) + gap) * MARGIN
    shape = table_shape(high - low, width, count)
    order, start = sort_into_cells(positions, low, width, shape)
    found = search(positions, radii, gap, periods, low, high, width, shape, order, start, pairs, images)
    if found > room:
        pairs, images = np.empty((found, 2), np.int64), np.empty((found, 2), np.int64)
        search(positions, radii, gap, periods, low, high, width, shape, order, start, pairs, images)
    return pairs[:found], images[:found]
