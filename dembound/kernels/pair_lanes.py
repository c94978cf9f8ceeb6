"""Forces of history-dependent pairs in rows of copies, eight pairs at once (lanes.py).

The formulas are those of contacts.py. A block of eight pairs is computed pair by pair in the step in which one breaks,
and, where intact bonds keep the geometry of the start, from then on.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, FAST, INLINED, MAKES, U, column_sum
from dembound.kernels.compiler.lanes import (
    LANES,
    at_most,
    bits,
    byte_of,
    choose,
    larger,
    load,
    magnitude,
    note_bits,
    root,
    splat,
    store,
    where_equal,
    with_sign,
)
from dembound.kernels.compiler.limits import factors_of
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.contacts import BONDED, CLOSING, INTACT, REFERENCE, UPDATED, closing_work, push_pair
from dembound.kernels.lane_step import next_place, place_of
from dembound.kernels.pair_law import (
    acts,
    bond,
    breaks,
    most_shear,
    normal,
    rubbed,
    shear_of,
    slip_after,
    slip_at,
    slips_by_overlap,
)
from dembound.pairwise import P

_ALL = np.uint8(2**LANES - 1)
_INTACT = np.uint8(INTACT)


@njit(**INLINED)
def _push_one_by_one(block, exists, u, v, step, number, contacts, limits, lost):
    """The pairs of a block in turn."""
    for k in range(LANES):
        if exists & np.uint8(1 << k):
            c = U(LANES) * block + U(k)
            lost[0] += push_pair(c, u, v, step, number, contacts, limits, lost)


@njit(**INLINED)
def _apart(u, i, j):
    """Displacements of eight disks in slots from j on, relative to those from i on."""
    return load(u[0], j) - load(u[0], i), load(u[1], j) - load(u[1], i)


@njit(**INLINED)
def _slide(way, arms, i, j, v):
    """Rate (m/s) of the shear of pairs."""
    (nx, ny), (arm_i, arm_j) = way, arms
    dvx, dvy = _apart(v, i, j)
    return nx * dvy - ny * dvx - arm_i * load(v[2], i) - arm_j * load(v[2], j)


@njit(**INLINED)
def _contact(
    k, q, c, i, j, way, arms, stretch, shear, opening, v, step, gives_way, exists, contacts, limits, kind, taken
):
    """Normal and shear force of contacts; their slip and closing are stored; see `_act`."""
    overlap = (k[q, P.touch] - k[q, P.rest]) - stretch
    slip = load(contacts.slip, c)
    N = normal(limits, k, q, overlap)
    S = shear_of(limits, k, q, overlap, shear, slip)
    if gives_way:
        overlapped = overlap + step * opening
        was_open = at_most(overlapped, 0.0)
        N = larger(N, 0.0)
        N = choose(was_open, CLOSING * N, N)
        had_closed = where_equal(contacts.closed, c, np.uint8(1))
        closed, was, now = byte_of(had_closed), byte_of(was_open), byte_of(at_most(overlap, 0.0))
        passes = np.uint8((was ^ now | closed) & exists)
        if passes != 0:
            passed = closing_work(limits, k, q, overlapped, overlap, had_closed, N)
            _add(taken, LANES, choose(bits(passes), passed, 0.0))
            note_bits(contacts.closed, c, bits(np.uint8(was & ~now & exists)))
        slid = slip
        if slips_by_overlap(limits):
            earlier = shear - step * _slide(way, arms, i, j, v)
            slid = slip_after(limits, k, q, overlapped, overlap, earlier, slip)
            S = shear_of(limits, k, q, overlap, shear, slid)
        most = most_shear(limits, kind, N)
        stays = at_most(magnitude(S), most)
        if slips_by_overlap(limits) or (byte_of(stays) & exists) != exists:
            earlier = shear - step * _slide(way, arms, i, j, v)
            before = shear_of(limits, k, q, overlapped, earlier, slip)
            S = choose(stays, S, with_sign(most, S))
            slid = choose(stays, slid, slip_at(limits, k, q, overlap, shear, S))
            loss = rubbed(limits, k, q, overlapped, overlap, earlier, shear, slip, slid, before, S)
            loss = choose(bits(exists), loss, 0.0)
            store(contacts.slip, c, slid)
            _add(taken, 0, larger(loss, 0.0))
            _add(taken, LANES, choose(at_most(loss, 0.0), loss, 0.0))
    return N, S


@njit(**INLINED)
def _add(sums, first, values):
    """Add eight numbers to those in an array (n,) from index `first` on."""
    store(sums, U(first), load(sums, U(first)) + values)


@njit(**INLINED)
def _store_forces(force, c, exists, fx, fy, on_i, on_j):
    """Store the forces of eight pairs, zero where there is none."""
    if exists != _ALL:
        there = bits(exists)
        fx, fy = choose(there, fx, 0.0), choose(there, fy, 0.0)
        on_i, on_j = choose(there, on_i, 0.0), choose(there, on_j, 0.0)
    store(force[0], c, fx)
    store(force[1], c, fy)
    store(force[2], c, on_i)
    store(force[3], c, on_j)


@njit(**INLINED)
def _act(
    c, q, i, j, block, exists, way, arms, strain, opening, gives_way, follows,
    u, v, step, number, pairs, contacts, limits, taken, lost,
):  # fmt: skip
    """Forces of the eight pairs of a block from their strain: stretch, shear and bending angle.

    way, arms : directions of normals and lever arms, numbers or lanes; opening : speed at which the disks part, where a
    contact gives way; follows : whether the geometry follows the motion. taken (16,) is advanced by the energies (J)
    that friction, and contacts that open and close, take in the eight pairs; where these are computed in turn lost
    (4,).
    """
    k, kind = pairs.constants, U(pairs.contact_type[q])
    nothing = splat(0.0)
    (nx, ny), (arm_i, arm_j), (stretch, shear, bent) = way, arms, strain
    whole = where_equal(contacts.state, c, _INTACT)
    intact = byte_of(whole) & exists
    pull, side, moment = nothing, nothing, nothing
    if intact != 0:
        pull, side, moment = bond(limits, k, q, stretch, shear, bent)
        torn, cut = breaks(limits, k, q, kind, factors_of(limits.factor, c), pull, side, moment)
        if ((byte_of(torn) | byte_of(cut)) & intact) != 0:
            _push_one_by_one(block, exists, u, v, step, number, contacts, limits, lost)
            return
        pull, side, moment = choose(whole, pull, 0.0), choose(whole, side, 0.0), choose(whole, moment, 0.0)
    if acts(limits, k, q):
        N, S = _contact(
            k, q, c, i, j, way, arms, stretch, shear, opening, v, step, gives_way, exists, contacts, limits, kind,
            taken,
        )  # fmt: skip
        pull -= N
        side += S
    if follows:
        gone = byte_of(at_most((k[q, P.touch] - k[q, P.rest]) - stretch, 0.0)) & ~intact & exists
        if gone != 0:  # as if the pair was met anew when it closes, see contacts.push_pair
            shear = choose(bits(np.uint8(gone)), 0.0, shear)
            store(contacts.slip, c, choose(bits(np.uint8(gone)), 0.0, load(contacts.slip, c)))
        store(contacts.shear, c, shear)
    fx, fy = nx * pull - ny * side, ny * pull + nx * side
    _store_forces(contacts.force, c, exists, fx, fy, arm_i * side + moment, arm_j * side - moment)


@njit(**FAST)
def _push_reference(pairs, q, block, exists, i, u, v, step, number, contacts, limits, taken, lost):
    """Forces of the pairs of a block of row q in the geometry of the start; their first disks are from slot i on."""
    c, j = U(LANES) * block, i + U(pairs.step[q, U(1)])
    k = pairs.constants
    nx, ny = pairs.way[q, U(0)], pairs.way[q, U(1)]
    rest = k[q, P.rest]
    arm_i = 0.5 * rest + k[q, P.offset]
    arm_j = rest - arm_i
    dx, dy = _apart(u, i, j)
    turn_i, turn_j = load(u[2], i), load(u[2], j)
    stretch = nx * dx + ny * dy + began_with(pairs.began, q, U(0))
    shear = nx * dy - ny * dx - arm_i * turn_i - arm_j * turn_j + began_with(pairs.began, q, U(1))
    strain = stretch, shear, turn_j - turn_i + began_with(pairs.began, q, U(2))
    gives_way = limits.geometry != REFERENCE or k[q, P.touch] < rest
    opening = splat(0.0)
    if gives_way:
        dvx, dvy = _apart(v, i, j)
        opening = nx * dvx + ny * dvy
    _act(
        c, q, i, j, block, exists, (nx, ny), (arm_i, arm_j), strain, opening, gives_way, False,
        u, v, step, number, pairs, contacts, limits, taken, lost,
    )  # fmt: skip


@njit(**FAST)
def _push_updated(pairs, q, block, exists, i, u, v, step, number, contacts, limits, taken, lost):
    """Forces of a pair of lanes whose normals and arms follow the motion, see pair_strain.updated_strain."""
    c, j = U(LANES) * block, i + U(pairs.step[q, U(1)])
    k = pairs.constants
    dx, dy = _apart(u, i, j)
    dvx, dvy = _apart(v, i, j)
    x = k[q, P.x] + dx
    y = k[q, P.y] + dy
    distance = root(x * x + y * y)
    stretch = ((k[q, P.x] + x) * dx + (k[q, P.y] + y) * dy) / (distance + k[q, P.rest])
    stretch += began_with(pairs.began, q, U(0))
    inverse = 1.0 / distance
    nx, ny = x * inverse, y * inverse
    arm_i = 0.5 * distance + k[q, P.offset]
    arm_j = distance - arm_i
    shear = load(contacts.shear, c) + step * _slide((nx, ny), (arm_i, arm_j), i, j, v)
    strain = stretch, shear, load(u[2], j) - load(u[2], i) + began_with(pairs.began, q, U(2))
    _act(
        c, q, i, j, block, exists, (nx, ny), (arm_i, arm_j), strain, nx * dvx + ny * dvy, True, True,
        u, v, step, number, pairs, contacts, limits, taken, lost,
    )  # fmt: skip


@njit(**FAST, forceinline=True)  # called, it would call the functions above in turn: twice the time
def _push_blocks(pairs, first, last, u, v, step, number, contacts, limits, taken, lost):
    """The pairs in blocks first to last − 1; lost (4,) as of contacts.push, taken (16,) is work space."""
    for k in range(4):
        lost[k] = 0.0
    for k in range(2 * LANES):
        taken[k] = 0.0
    if first == last:
        return
    group, column, q = place_of(pairs, first)
    for block in range(first, last):
        if block > first:
            group, column, q = next_place(pairs, block, group, column, q)
        here, row, exists = U(block), U(q), pairs.exists[U(block)]
        if exists != 0:
            disks = pairs.disk_block[U(group)] + column * pairs.disk_rows[U(group)] + pairs.step[row, U(0)]
            i = U(LANES * disks)
            intact = byte_of(where_equal(contacts.state, U(LANES) * here, _INTACT)) & exists
            if limits.geometry == UPDATED or (limits.geometry == BONDED and intact == 0):
                _push_updated(pairs, row, here, exists, i, u, v, step, number, contacts, limits, taken, lost)
            elif limits.geometry == BONDED and intact != exists:
                _push_one_by_one(here, exists, u, v, step, number, contacts, limits, lost)
            else:
                _push_reference(pairs, row, here, exists, i, u, v, step, number, contacts, limits, taken, lost)
    for k in range(LANES):
        lost[0] += taken[k]
        lost[2] += taken[LANES + k]


@in_chunks
@njit(**MAKES)
def _push_rows(begin, end, u, v, step, number, pairs, contacts, limits, lost):
    n = pairs.exists.size
    taken = np.empty(2 * LANES)
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        _push_blocks(pairs, first, last, u, v, step, number, contacts, limits, taken, lost[chunk])


@njit(**FAST)
def push_rows(u, v, step, number, pairs, contacts, limits, lost):
    """Forces of the pairs in rows, see contacts.push."""
    _push_rows(u, v, step, number, pairs, contacts, limits, lost)
    return int(column_sum(lost, 3))
