"""Pairs of disks with small gaps, found by a grid of cells, and the motion after which the list may be too short."""

import math

import numpy as np
from numba import njit, types

from dembound.kernels.common import CHUNKS, FAST, MAKES, U, largest
from dembound.kernels.compiler.separate import apart, in_chunks

ACROSS = ((0, 0), (1, 0), (-1, 1), (0, 1), (1, 1))
"""Steps from a cell to itself and to half of the cells that touch it."""


@in_chunks
@njit(**FAST)
def _motions(first_chunk, last_chunk, u, begin, origin, skins, cells, found):
    """Fill found (c, 9) with the motion of the disks of every cell since the origin, and what is left of their skins.

    Mean motion along x and y of the disks with the least skin, so that a fast disk does not change it; the least of the
    skins less the distance from that motion; the least skin; smallest and largest motion along x and y; the second
    least of what is left.
    """
    n = len(found)
    for c in range(first_chunk * n // CHUNKS, last_chunk * n // CHUNKS):
        least = np.inf
        for m in range(cells.start[c], cells.start[c + 1]):
            least = min(least, skins[cells.member[m]])
        x = 0.0
        y = 0.0
        count = 0
        own = found[c]
        own[4] = own[6] = np.inf
        own[5] = own[7] = -np.inf
        for m in range(cells.start[c], cells.start[c + 1]):
            i = cells.member[m]
            dx, dy = u[0, begin + i] - origin[0, i], u[1, begin + i] - origin[1, i]
            own[4], own[5] = min(own[4], dx), max(own[5], dx)
            own[6], own[7] = min(own[6], dy), max(own[7], dy)
            if skins[i] == least:
                x += dx
                y += dy
                count += 1
        x /= max(count, 1)
        y /= max(count, 1)
        left = np.inf
        second = np.inf
        for m in range(cells.start[c], cells.start[c + 1]):
            i = cells.member[m]
            dx, dy = u[0, begin + i] - origin[0, i] - x, u[1, begin + i] - origin[1, i] - y
            own_left = skins[i] - np.sqrt(dx * dx + dy * dy)
            second = min(second, max(left, own_left))
            left = min(left, own_left)
        own[0], own[1], own[2], own[3], own[8] = x, y, left, least, second


@njit(**FAST)
def _room_of(c, cells, found):
    """Least room between disks of cell c, and of a cell that touches it: the larger of two bounds for each."""
    columns, rows = cells.divisions[0], cells.divisions[1]
    column, row = c % columns, c // columns
    least = np.inf
    for right, up in ACROSS:
        x, y = column + right, row + up
        if cells.wraps[0]:
            x %= columns
        if cells.wraps[1]:
            y %= rows
        if 0 <= x < columns and 0 <= y < rows:
            other = y * columns + x
            if cells.start[other + 1] > cells.start[other]:
                one, two = found[c], found[other]
                span = np.hypot(max(one[5] - two[4], two[5] - one[4]), max(one[7] - two[6], two[7] - one[6]))
                left = one[2] + (one[8] if other == c else two[2]) - np.hypot(one[0] - two[0], one[1] - two[1])
                least = min(least, max(left, one[3] + two[3] - span))
    return least


@in_chunks
@njit(**FAST)
def _largest_squares(first_chunk, last_chunk, u, begin, origin, squares):
    """Fill squares (chunks,) with the largest squared displacements of the particles of each chunk since the origin."""
    n = origin.shape[1]
    for chunk in range(first_chunk, last_chunk):
        square = 0.0
        for i in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            x, y = u[0, begin + i] - origin[0, i], u[1, begin + i] - origin[1, i]
            square = max(square, x**2 + y**2)
        squares[chunk] = square


@apart(types.float64)
@njit(**MAKES)
def room(u, begin, origin, skins, cells):
    """Relative displacement (m) that two disks of no listed pair still need at least to touch; negative: they may.

    Pairs with gaps up to the sum of their skins (n,) m were listed at the displacements origin (2, n). u : (3, …)
    displacements; the n disks are those from `begin` on; cells : tables.Cells.
    """
    squares = np.empty(CHUNKS)
    _largest_squares(u, begin, origin, squares)
    if np.sqrt(largest(squares)) > cells.reach:
        return -1.0
    count = cells.start.size - 1
    found = np.empty((count, 9))
    _motions(u, begin, origin, skins, cells, found)
    rooms = np.empty(CHUNKS)
    _rooms(cells, found, rooms)
    return -largest(rooms)


@in_chunks
@njit(**FAST)
def _rooms(first_chunk, last_chunk, cells, found, rooms):
    """Fill rooms (chunks,) with the least room of disks in each chunk of cells and their neighbours, negative."""
    count = cells.start.size - 1
    for chunk in range(first_chunk, last_chunk):
        least = np.inf
        for c in range(chunk * count // CHUNKS, (chunk + 1) * count // CHUNKS):
            if cells.start[c + 1] > cells.start[c]:
                least = min(least, _room_of(c, cells, found))
        rooms[chunk] = -least


MARGIN = 1.0 + 1e-9  # of distances that only choose candidates, so that rounding misses no pair
BITS = 4  # of the image's number, which follows that of the second disk in one code


def near_pairs(positions, radii, gap, periods):
    """All pairs of disks whose gap is at most `gap` (m), also through periodic sides, each once.

    positions (n, 2), radii (n,) in m; periods (2,) m, 0.0 along an axis that is not periodic. Disks may be outside the
    period, but only images from −1 to 1 are found. Returns pairs (b, 2) int32 and images (b, 2) int8, sorted by first
    disk, second disk and image: the vector is x_j + images·periods − x_i, with i < j, or with i = j and the image after
    (0, 0).
    """
    count = len(radii)
    if count == 0:
        return np.empty((0, 2), np.int32), np.empty((0, 2), np.int8)
    # NumPy is slow along the first axis
    low = np.array([positions[:, 0].min(), positions[:, 1].min()])
    high = np.array([positions[:, 0].max(), positions[:, 1].max()])
    width = (2.0 * radii.max() + gap) * MARGIN
    shape = table_shape(high - low, width, count)
    order, start = sort_into_cells(positions, low, width, shape)
    found, room = 4 * count, -1
    while found > room:  # once, unless the disks are crowded
        room = found
        first, codes = np.empty(room, np.int64), np.empty(room, np.int64)
        found = search(positions, radii, gap, periods, low, high, width, shape, order, start, first, codes)
    pairs, images = np.empty((found, 2), np.int32), np.empty((found, 2), np.int8)
    unpack(first, codes, pairs, images)
    return pairs, images


def table_shape(extent, width, count):
    """Cells (2,) int64 of the table along x and y, powers of two.

    At least four, as a disk looks into three different ones; enough for the extent (2,) m, as long as they are at most
    four for each of the `count` disks.
    """
    shape = [4, 4]
    while shape[0] * shape[1] < 2 * count:
        axis = 0 if extent[0] * shape[1] > extent[1] * shape[0] else 1
        if extent[axis] < width * shape[axis]:
            break
        shape[axis] *= 2
    return np.array(shape)


def sort_into_cells(positions, low, width, shape):
    """Entries (e,) uint32 cell after cell, up along the columns, and the first entry of each cell, (cells + 1,) int64.

    A column begins with a copy of its last row and ends with one of its first, so that the three rows around a disk
    are one range of entries.
    """
    start = np.zeros(shape[0] * (shape[1] + 2) + 2, np.int64)
    enter(positions, low, width, shape, start[2:], np.empty(0, np.uint32))
    np.cumsum(start, out=start)
    order = np.empty(start[-1], np.uint32)
    enter(positions, low, width, shape, start[1:], order)
    return order, start[:-1]


@njit(**FAST)
def cell(value, low, width):
    """Number of the cell of a coordinate, before wrap-around."""
    return np.int64(math.floor((value - low) / width))


@njit(**FAST)
def enter(positions, low, width, shape, place, order):
    """Write each disk to the places of its cell in `order`, and raise place (cells,); without room they are counted.

    Disks of the first and the last row are also written to the rows beyond the ends that repeat them.
    """
    rows = shape[1]
    for i in range(positions.shape[0]):
        column = cell(positions[i, 0], low[0], width) & (shape[0] - 1)
        row = cell(positions[i, 1], low[1], width) & (rows - 1)
        for turn in range(-1, 2):
            own = row + 1 + turn * rows
            if 0 <= own < rows + 2:
                at = U(column * (rows + 2) + own)
                if order.size > 0:
                    order[U(place[at])] = i
                place[at] += 1


@njit(**FAST)
def insert(codes, begin, end, code):
    """Enter a code into codes[begin:end], which are sorted."""
    k = end
    while k > begin and codes[U(k - 1)] > code:
        codes[U(k)] = codes[U(k - 1)]
        k -= 1
    codes[U(k)] = code


@njit(**FAST)
def unpack(first, codes, pairs, images):
    """Fill pairs (b, 2) and images (b, 2) from first disks and codes."""
    for k in range(pairs.shape[0]):
        c = U(k)
        pairs[c, 0], pairs[c, 1] = first[c], codes[c] >> BITS
        image = codes[c] & ((1 << BITS) - 1)
        images[c, 0], images[c, 1] = image // 3 - 1, image % 3 - 1


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
def search(positions, radii, gap, periods, low, high, width, shape, order, start, first, codes):
    """Number of near pairs; fills `first` with i and `codes` with j and image as far as there is room."""
    found = 0
    for i in range(positions.shape[0]):
        begin = found
        for image in range(9):  # by x, then by y; number 4 is the box itself
            a, b = image // 3 - 1, image % 3 - 1
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
                    j = U(order[U(k)])
                    if not is_near(positions, radii, gap, U(i), j, shift_x, shift_y) or (j == i and image <= 4):
                        continue
                    if found < codes.size:
                        first[found] = i
                        insert(codes, begin, found, (np.int64(j) << BITS) + image)
                    found += 1
    return found


@njit(**FAST)
def directed(first, second, x, y):
    """The lower and the higher disk of a pair, and the periods along x and y from the lower to the higher as a code."""
    if first > second or (first == second and (x < 0 or (x == 0 and y < 0))):
        return second, first, 3 * (1 - x) + 1 - y
    return first, second, 3 * (x + 1) + y + 1


@njit(**MAKES)
def numbers_of(pairs, images, first, second, listed_images, count):
    """Number (b,) of each pair among those listed, in either order of their disks; −1 for others.

    pairs (b, 2) and first, second (c,) listed ones, of `count` disks; images (b, 2), listed_images (c, 2) : periods
    from the first to the second.
    """
    start = np.zeros(count + 2, np.int64)
    for c in range(first.size):
        start[min(first[c], second[c]) + 2] += 1
    for i in range(2, count + 2):
        start[i] += start[i - 1]
    order = np.empty(first.size, np.int64)
    for c in range(first.size):
        low = min(first[c], second[c])
        order[start[low + 1]] = c
        start[low + 1] += 1
    found = np.full(pairs.shape[0], -1, np.int64)
    for k in range(pairs.shape[0]):
        low, high, code = directed(pairs[k, 0], pairs[k, 1], images[k, 0], images[k, 1])
        for e in range(start[low], start[low + 1]):
            c = order[e]
            _, other, own = directed(first[c], second[c], listed_images[c, 0], listed_images[c, 1])
            if other == high and own == code:
                found[k] = c
                break
    return found


@njit(**MAKES)
def ends_of(first, second, live, begin, stop):
    """Offsets (stop + 1,) of the contact ends of disks `begin` to stop − 1, and these ends, ascending for each disk.

    first, second (b,) uint32 disks of pairs in places live (b,), ascending; an end is twice the place, + 1 for the
    second disk.
    """
    start = np.zeros(stop + 1, np.uint32)
    at = np.zeros(stop - begin + 1, np.int64)
    for k in range(live.size):
        at[first[k] - begin + 1] += 1
        at[second[k] - begin + 1] += 1
    for i in range(1, stop - begin + 1):
        at[i] += at[i - 1]
        start[begin + i] = at[i]
    end = np.empty(2 * live.size, np.uint32)
    for k in range(live.size):
        i, j = first[k] - begin, second[k] - begin
        end[at[i]] = 2 * live[k]
        at[i] += 1
        end[at[j]] = 2 * live[k] + 1
        at[j] += 1
    return start, end
