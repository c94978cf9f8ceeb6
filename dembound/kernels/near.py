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
CODES = 9  # of images from −1 to 1 along x and y: 3(x + 1) + y + 1


def near_pairs(positions, radii, gap, periods):
    """All pairs of disks whose gap is at most `gap` (m), also through periodic sides, each once.

    positions (n, 2), radii (n,) in m; periods (2,) m, 0.0 along an axis that is not periodic. Disks may be outside the
    period, but only images from −1 to 1 are found. Returns pairs (b, 2) int32 and images (b, 2) int8, sorted by first
    disk, second disk and image: the vector is x_j + images·periods − x_i, with i < j, or with i = j and the image after
    (0, 0).
    """
    count = len(radii)
    return pairs_of(near_keys(positions, radii + 0.5 * gap, periods, np.arange(count)), count)


def near_keys(positions, reach, periods, names, usual=np.inf):
    """Keys (b,) int64, ascending, of pairs of disks at most as far apart as the sum of what they reach (n,) m.

    positions (n, 2), periods (2,) : see `near_pairs`. names (n,) : the ascending numbers of the disks in keys,
    (i·(largest + 1) + j)·9 + code of the image. usual : m, what most disks reach at most; cells are made for these.
    Disks that reach −inf have no pairs.
    """
    if len(reach) == 0:
        return np.empty(0, np.int64)
    usual, most = min(usual, reach.max()), reach.max()
    # NumPy is slow along the first axis
    low = np.array([positions[:, 0].min(), positions[:, 1].min()])
    high = np.array([positions[:, 0].max(), positions[:, 1].max()])
    width = 2.0 * usual * MARGIN
    shape = table_shape(high - low, width, len(reach))
    order, start = sort_into_cells(positions, low, width, shape)
    reaching = reach[order]
    usually = np.where(reaching > usual, -np.inf, reaching)
    table = positions[order, 0], positions[order, 1], reaching, usually, order
    picked = np.empty(len(order), np.int64)
    found, room = 4 * len(reach), -1
    while found > room:  # once, unless the disks are crowded
        room = found
        keys = np.empty(room, np.int64)
        found = search(
            positions, reach, usual, most, periods, low, high, width, shape, start, table, picked, names, keys
        )
    keys = keys[:found]
    if most > usual:
        keys.sort()
    return keys


def pairs_of(keys, span):
    """Pairs (b, 2) int32 and images (b, 2) int8 of keys (b,) of disks numbered up to span − 1."""
    pairs, images = np.empty((len(keys), 2), np.int32), np.empty((len(keys), 2), np.int8)
    unpack(keys, span, pairs, images)
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
def unpack(keys, span, pairs, images):
    """Fill pairs (b, 2) and images (b, 2) from keys."""
    for k in range(keys.size):
        c = U(k)
        pair = keys[c] // CODES
        code = keys[c] - CODES * pair
        pairs[c, 0], pairs[c, 1] = pair // span, pair % span
        images[c, 0], images[c, 1] = code // 3 - 1, code % 3 - 1


@njit(**FAST)
def reversed_code(code):
    """The code of the opposite image."""
    return CODES - 1 - code


@njit(**FAST)
def pick(first, last, i, own_image, after, x, y, own, across, up, reach, number, picked, count):
    """Add to picked (count of them) the entries first to last − 1 near disk i at x, y (m), of numbers above `after`.

    own_image : whether the disk itself is an entry.
    """
    for k in range(first, last):
        e = U(k)
        dx, dy, r = across[e] - x, up[e] - y, own + reach[e]
        j = np.int64(number[e])
        picked[U(count)] = k
        count += int((dx * dx + dy * dy <= r * abs(r) * MARGIN) & (j > after) & (own_image | (j != i)))
    return count


@njit(**FAST)
def search(positions, reach, usual, most, periods, low, high, width, shape, start, table, picked, names, keys):
    """Number of near pairs; fills `keys` as far as there is room, those of each first disk of usual reach sorted.

    table : place along x and y, reach, usual reach and number of each entry of the cells. Disks that reach further than
    usual look at all cells so far around them, and others leave out pairs with these.
    """
    across, up, reach_of, usually, number = table
    found = 0
    columns, rows = shape[0], shape[1]
    span = names[names.size - 1] + 1
    for i in range(positions.shape[0]):
        begin, own = found, reach[i]
        if own < 0.0:
            continue
        is_wide = own > usual
        around = int((own + most) * MARGIN / width) + 1 if is_wide else 1
        after = -1 if is_wide else i - 1
        reaching = reach_of if is_wide else usually
        for image in range(CODES):  # by x, then by y; number 4 is the box itself
            a, b = image // 3 - 1, image % 3 - 1
            if (a != 0 and periods[0] == 0.0) or (b != 0 and periods[1] == 0.0):
                continue
            # the pair's first disk is shifted back, so that the table need not contain images
            x, y = positions[i, 0] - a * periods[0], positions[i, 1] - b * periods[1]
            far = around * width
            if x < low[0] - far or x > high[0] + far or y < low[1] - far or y > high[1] + far:
                continue
            column, row = cell(x, low[0], width), cell(y, low[1], width)
            count, own_image = 0, image > 4
            for side in range(-around, min(around, columns - around - 1) + 1):
                first = (column + side & (columns - 1)) * (rows + 2)
                if around == 1:
                    at = first + (row & (rows - 1))
                    count = pick(
                        start[at],
                        start[at + 3],
                        i,
                        own_image,
                        after,
                        x,
                        y,
                        own,
                        across,
                        up,
                        reaching,
                        number,
                        picked,
                        count,
                    )
                    continue
                for above in range(-around, min(around, rows - around - 1) + 1):
                    at = first + 1 + (row + above & (rows - 1))
                    count = pick(
                        start[at],
                        start[at + 1],
                        i,
                        own_image,
                        after,
                        x,
                        y,
                        own,
                        across,
                        up,
                        reaching,
                        number,
                        picked,
                        count,
                    )
            for p in range(count):
                e = U(picked[U(p)])
                j = np.int64(number[e])
                dx, dy, r = across[e] - x, up[e] - y, own + reach_of[e]
                if dx * dx + dy * dy > r * r / MARGIN and math.hypot(dx, dy) - own - reach_of[e] > 0.0:
                    continue
                if j < i and reach_of[e] > usual:
                    continue  # of two that reach further the first finds the second
                if found < keys.size:
                    code = image if i <= j else reversed_code(image)
                    insert(keys, begin, found, (names[min(i, j)] * span + names[max(i, j)]) * CODES + code)
                found += 1
    return found
