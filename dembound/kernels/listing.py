"""Lists of pairs made anew: which pairs stay and which are met, and their history carried over; skins and cells."""

import numpy as np
from numba import njit

from dembound.kernels.common import MAKES
from dembound.kernels.contacts import INTACT
from dembound.kernels.lane_step import first_at
from dembound.kernels.near import CODES, reversed_code

NEW = -1
"""In place of the earlier number of a pair that was not listed."""


@njit(**MAKES)
def keys_of(first, second, images, span):
    """Keys (b,) int64 of pairs, see near.near_keys, whichever disk is the first.

    first, second (b,) disks numbered up to span − 1; images (b, 2) : periods from the first to the second.
    """
    keys = np.empty(first.size, np.int64)
    for k in range(first.size):
        i, j, x, y = np.int64(first[k]), np.int64(second[k]), images[k, 0], images[k, 1]
        code = 3 * (x + 1) + y + 1
        turned = i > j or (i == j and (x < 0 or (x == 0 and y < 0)))
        keys[k] = (j * span + i) * CODES + reversed_code(code) if turned else (i * span + j) * CODES + code
    return keys


@njit(**MAKES)
def merged(near, listed, state, held, elsewhere):
    """Keys (b,) of the pairs of a new list, ascending, and the number (b,) of each in the old one, or `NEW`.

    near, listed : keys of the pairs that are near now, and of the old list, whose bonds are in a state (k,). A pair
    stays that is near, has its bond, or is held; pairs elsewhere are left out. All keys are ascending.
    """
    keys, source = np.empty(near.size + listed.size, np.int64), np.empty(near.size + listed.size, np.int64)
    i, j, e, count = 0, 0, 0, 0
    while i < near.size or j < listed.size:
        if j == listed.size or (i < near.size and near[i] < listed[j]):
            key, number = near[i], NEW
            while e < elsewhere.size and elsewhere[e] < key:
                e += 1
            stays = e == elsewhere.size or elsewhere[e] != key
            i += 1
        else:
            key, number = listed[j], j
            is_near = i < near.size and near[i] == key
            stays = is_near or state[j] == INTACT
            if not stays:
                at = first_at(held, key)
                stays = at < held.size and held[at] == key
            i += int(is_near)
            j += 1
        keys[count], source[count] = key, number
        count += int(stays)
    return keys[:count], source[:count]


@njit(**MAKES)
def ends_of(first, second, place, begin, stop):
    """Offsets (stop + 1,) of the contact ends of disks `begin` to stop − 1, and these ends, ascending for each disk.

    first, second (b,) uint32 disks of pairs, the first of which is in this place; an end is twice the place, + 1 for
    the second disk.
    """
    start = np.zeros(stop + 1, np.uint32)
    at = np.zeros(stop - begin + 1, np.int64)
    for k in range(first.size):
        at[first[k] - begin + 1] += 1
        at[second[k] - begin + 1] += 1
    for i in range(1, stop - begin + 1):
        at[i] += at[i - 1]
        start[begin + i] = at[i]
    end = np.empty(2 * first.size, np.uint32)
    for k in range(first.size):
        i, j = first[k] - begin, second[k] - begin
        end[at[i]] = 2 * (place + k)
        at[i] += 1
        end[at[j]] = 2 * (place + k) + 1
        at[j] += 1
    return start, end


@njit(**MAKES)
def sorted_into(positions, low, width, divisions, wraps, numbers):
    """First member (c + 1,) of each cell, and the members (n,) cell by cell, in the order of disks.

    positions (n, 2) m; low, width (2,) m; divisions (2,) columns and rows of cells, of which those wrap that are in
    wraps (2,), and outside of others the outermost cells count. numbers (n,) : of the disks.
    """
    place = np.empty(numbers.size, np.int64)
    start = np.zeros(divisions[0] * divisions[1] + 2, np.int64)
    for k in range(numbers.size):
        x, y = (
            int(np.floor((positions[k, 0] - low[0]) / width[0])),
            int(np.floor((positions[k, 1] - low[1]) / width[1])),
        )
        x = x % divisions[0] if wraps[0] else min(max(x, 0), divisions[0] - 1)
        y = y % divisions[1] if wraps[1] else min(max(y, 0), divisions[1] - 1)
        place[k] = y * divisions[0] + x
        start[place[k] + 2] += 1
    for c in range(2, start.size):
        start[c] += start[c - 1]
    member = np.empty(numbers.size, np.int64)
    for k in range(numbers.size):
        member[start[place[k] + 1]] = numbers[k]
        start[place[k] + 1] += 1
    return start[:-1], member


@njit(**MAKES)
def ahead_of_others(v, begin, cells, time, least):
    """Ways (slots,) m of disks in a time (s) beyond the mean one of their cell; 0 in slots without disks.

    v (3, …) m/s, those of the disks from number `begin` on. Of the mean are left out those that are ahead by more than
    twice the mean of all, and by the least way (m) more.
    """
    ahead = np.zeros(v.shape[1] - begin)
    usual = np.inf
    for _ in range(2):
        total = 0.0
        for c in range(cells.start.size - 1):
            x, y, count = 0.0, 0.0, 0
            for m in range(cells.start[c], cells.start[c + 1]):
                i = cells.member[m]
                if ahead[i] <= usual:
                    x += v[0, begin + i]
                    y += v[1, begin + i]
                    count += 1
            for m in range(cells.start[c], cells.start[c + 1]):
                i = cells.member[m]
                dx, dy = v[0, begin + i] - x / max(count, 1), v[1, begin + i] - y / max(count, 1)
                ahead[i] = time * np.sqrt(dx * dx + dy * dy)
                total += ahead[i]
        usual = 2.0 * total / max(cells.member.size, 1) + least
    return ahead
