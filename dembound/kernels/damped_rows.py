"""The step of disks whose forces pass through memories, in blocks of eight.

Of a force f, less that at rest, a mechanism with the memory s takes g t, t = s + f, and remembers s ← e t + f. Forces
on eight disks are filtered right after they have been computed; their memories are side by side.

Of large bodies the next step is done in the same sweep, some blocks behind, for `early` blocks, whose neighbours move
without supports (tables `Ahead`), while motion and memories are in the cache; that of the others follows in the next
call. Each block does the same in both, so results have the same bits.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, FAST, U
from dembound.kernels.compiler.lanes import LANES, at_most, choose, lane, load, splat, store, where_equal
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.drag import shares, with_drag
from dembound.kernels.elastic import row_force
from dembound.kernels.elastic_lanes import gathered
from dembound.kernels.lane_step import INLINED, blocks_of, go_on, kick, next_place, place_of, stray_forces
from dembound.kernels.law import answer, generic
from dembound.kernels.tables import LaneRows, NeighbourTable

_SUPPORTED, _MIXED = np.uint8(1), np.uint8(2)

FADED = 1e-216
"""Number (N, N·m) that is added to memories and subtracted again, so that those much smaller become zero.

They would decay into denormal numbers, which are a hundred times slower.
"""


FADES = 256
"""Steps after which small memories of disks become zero, an even number, see damped.note.

From FADED to denormal numbers they take longer for e ≥ 0.44, a relaxation time of 1.2 steps.
"""

ALL, EARLY, LATE = 0, 1, 2
"""Choices of blocks."""

ONE_STEP, TWO_STEPS, REST_OF_SECOND = 0, 1, 2
"""What is done in a step: it, with the next one of early blocks, or what that left."""

PARTS, TILE = 16, 16
"""Ranges of blocks which sweeps of two steps do not leave, and blocks that do the same step in a row."""

_NOW, _NEXT = 2 * LANES, 4 * LANES
"""Places of early blocks' powers in Ahead.works, in this step and in the next."""


@generic
def move_remembering(rows, memories, u, v, body, u_next, damped):
    """One step of the rows' disks with filtered forces; damped (chunks, 2) gets the work taken by free disks."""


@njit(**INLINED)
def remembered(e, t, f):
    """What a mechanism remembers of a force f that made its memory t, zero if it is small; numbers or lanes."""
    return (e * t + (f + FADED)) - FADED


@njit(**FAST)
def fade(memory):
    """Make memories (n,) that are much smaller than FADED zero."""
    for each in range(memory.size // LANES):
        i = U(LANES * each)
        store(memory, i, (load(memory, i) + FADED) - FADED)


@njit(**INLINED)
def _remember(memory, j, e, f):
    """Add forces f on eight disks to their memories from place j on, and let these fade; returns the sums t."""
    t = load(memory, j) + f
    store(memory, j, e * t + f)
    return t


@njit(**INLINED)
def _taken_by(memory, j, e, g, forces, free, taken):
    """Forces and moments taken from those on eight disks, with those of one more mechanism, in directions that move."""
    rx, ry, rt = taken
    if free[U(0)] != 0.0:
        rx += g * _remember(memory, j, e, forces[0])
    if free[U(1)] != 0.0:
        ry += g * _remember(memory, j + U(LANES), e, forces[1])
    if free[U(2)] != 0.0:
        rt += g * _remember(memory, j + U(2 * LANES), e, forces[2])
    return rx, ry, rt


@njit(**INLINED)
def _of_each(factors, layer, kind, k, i):
    """Factors e or g, by kind, of mechanism k of eight disks of several layers from slot i on."""
    factor = splat(0.0)
    for each in range(factors.shape[0]):
        factor = choose(where_equal(layer, i, np.uint8(each)), splat(factors[U(each), U(kind), k]), factor)
    return factor


@njit(**INLINED)
def _taken(memories, forces, i, mixed, free):
    """The forces and moments Σ g t that mechanisms take from those on eight disks from slot i on."""
    memory, factors, layer, mechanisms = memories.memory, memories.factors, memories.layer, memories.mechanisms
    first = U(3 * len(mechanisms)) * (i - U(LANES * memories.block))
    taken = splat(0.0), splat(0.0), splat(0.0)
    if mixed:
        for each in range(factors.shape[2]):
            k = U(each)
            e, g = _of_each(factors, layer, 0, k, i), _of_each(factors, layer, 1, k, i)
            taken = _taken_by(memory, first + U(3 * LANES) * k, e, g, forces, free, taken)
    else:
        decay, gain = factors[U(layer[i]), U(0)], factors[U(layer[i]), U(1)]
        for each in range(len(mechanisms)):  # a constant, so the loop is unrolled: 1.2 times as fast
            k = U(each)
            taken = _taken_by(memory, first + U(3 * LANES) * k, splat(decay[k]), splat(gain[k]), forces, free, taken)
    return taken


@njit(**INLINED)
def _move_block(memories, i, kinds, forces, place, factors, u, v, body, u_next):
    """One step of the disks in slots i to i + 7 under contact forces; returns powers taken from free disks.

    kinds : of the block, see Memories.special. forces, place : forces and moment, displacements and rotation. factors :
    Δt over mass and over moment of inertia. The powers are those after and before the step, in lanes.
    """
    supported, mixed = kinds & _SUPPORTED != 0, kinds & _MIXED != 0
    fx, fy, moment = forces
    x, y, turn = place
    b, b_turn = factors
    gx, gy, gt = fx, fy, moment
    if memories.rest.shape[1] > 0:
        gx -= load(memories.rest[0], i)
        gy -= load(memories.rest[1], i)
        gt -= load(memories.rest[2], i)
    if body.load.shape[1] > 0:  # first with the forces that it balances, so that their sum is exactly zero
        fx += load(body.load[0], i)
        fy += load(body.load[1], i)
        moment += load(body.load[2], i)
    rx, ry, rt = _taken(memories, (gx, gy, gt), i, mixed, body.free)
    fx -= rx
    fy -= ry
    moment -= rt
    was_x, was_y, was_t = load(v[0], i), load(v[1], i), load(v[2], i)
    share = shares(memories.drag, i)
    keep = share + share - 1.0
    now_x = kick(keep * was_x, fx, body.free[0] * (share * b))
    now_y = kick(keep * was_y, fy, body.free[1] * (share * b))
    now_t = kick(keep * was_t, moment, body.free[2] * (share * b_turn))
    before, after = rx * was_x + ry * was_y + rt * was_t, rx * now_x + ry * now_y + rt * now_t
    before, after = with_drag(memories.drag, i, before, after, (was_x, was_y, was_t), (now_x, now_y, now_t))
    if supported:
        held = at_most(b, 0.0)
        before, after = choose(held, 0.0, before), choose(held, 0.0, after)
        store(memories.force[0], i, rx)
        store(memories.force[1], i, ry)
        store(memories.force[2], i, rt)
    go_on(i, supported, b, fx, fy, moment, x, y, turn, now_x, now_y, now_t, body.step, v, u_next)
    return after, before


@njit(**INLINED)
def _sums(works, step):
    """Work (J) of a step in all lanes, in total and up to the whole step, see step.damping_work."""
    after, before = works
    whole = 0.0
    half = 0.0
    for k in range(LANES):
        whole += lane(after, U(k))
        half += lane(before, U(k))
    return 0.5 * step * (whole + half), 0.5 * step * half


@njit(**FAST)
def _step_blocks(rows, memories, first, last, which, u, v, body, u_next, works, at):
    """One step of those of blocks first to last − 1 that are chosen by `which`, of ALL, EARLY or LATE.

    works : powers are added to those of late blocks from 0 on, to those of early ones from `at` on, see Ahead.
    """
    if which != EARLY:
        stray_forces(rows, first, last, u)
    early, at = memories.ahead.early, U(at)
    late_works = load(works, U(0)), load(works, U(LANES))
    early_works = load(works, at), load(works, at + U(LANES))
    group, column, r = place_of(rows, first)
    for block in range(first, last):
        if block > first:
            group, column, r = next_place(rows, block, group, column, r)
        is_early = early[U(block)] != 0
        if (which == EARLY and not is_early) or (which == LATE and is_early):
            continue
        fx, fy, moment, x, y, turn, b, b_turn, _ = gathered(rows, block, r, column, u, body)
        after, before = _move_block(
            memories, U(LANES * block), memories.special[U(block)], (fx, fy, moment), (x, y, turn), (b, b_turn),
            u, v, body, u_next,
        )  # fmt: skip
        if is_early:
            early_works = early_works[0] + after, early_works[1] + before
        else:
            late_works = late_works[0] + after, late_works[1] + before
    store(works, U(0), late_works[0])
    store(works, U(LANES), late_works[1])
    store(works, at, early_works[0])
    store(works, at + U(LANES), early_works[1])


@njit(**FAST)
def _move_part(rows, memories, first, last, u, v, body, u_next, works):
    """One step of blocks first to last − 1, with the next one of early ones or what that left, see Ahead.state."""
    what, lag = memories.ahead.state[0], memories.ahead.lag
    for k in range(2 * LANES):
        works[k] = 0.0
        works[_NOW + k] = works[_NEXT + k] if what == REST_OF_SECOND else 0.0
        works[_NEXT + k] = 0.0
    size, pieces, turns = last - first, 1, 1
    if what == TWO_STEPS:
        size, pieces = TILE, (last - first + TILE - 1) // TILE
        turns = 2 * (pieces + lag)
    for turn in range(turns):  # a single call, as each one would be compiled anew
        which, at, here, there = LATE if what == REST_OF_SECOND else ALL, _NOW, u, u_next
        piece = turn // 2
        if turn % 2 == 1:
            which, at, here, there = EARLY, _NEXT, u_next, u
            piece -= lag
        if 0 <= piece < pieces:
            begin = first + piece * size
            _step_blocks(rows, memories, begin, min(begin + size, last), which, here, v, body, there, works, at)


@njit(**INLINED)
def _work_of(works, at, step):
    """Work (J) of a step whose powers are in works from place `at` on, in total and up to the whole step."""
    return _sums((load(works, U(at)), load(works, U(at + LANES))), step)


@njit(**FAST)
def _move_disks(memories, first, last, u, v, body, u_next):
    """One step of blocks first to last − 1 whose contact forces are in memories.force; returns works."""
    force = memories.force
    works = splat(0.0), splat(0.0)
    for block in range(first, last):
        i = U(LANES * block)
        forces = load(force[0], i), load(force[1], i), load(force[2], i)
        place = load(u[0], i), load(u[1], i), load(u[2], i)
        factors = load(body.mobility, i), load(body.inverse_inertia, i)
        kinds = memories.special[U(block)]
        after, before = _move_block(memories, i, kinds, forces, place, factors, u, v, body, u_next)
        works = works[0] + after, works[1] + before
    return _sums(works, body.step)


@in_chunks
@njit(**FAST)
def _move_in_lanes(begin, end, rows, memories, u, v, body, u_next, damped):
    sweeps = memories.ahead.lag > 0
    each = CHUNKS // PARTS if sweeps else 1
    for part in range((begin + each - 1) // each, (end + each - 1) // each):
        first, _ = blocks_of(rows, each * part)
        _, last = blocks_of(rows, each * part + each - 1)
        whole, half = 0.0, 0.0
        if first < last:
            works = memories.ahead.works[part]
            _move_part(rows, memories, first, last, u, v, body, u_next, works)
            whole, half = _work_of(works, 0, body.step)
            if sweeps:
                early = _work_of(works, _NOW, body.step)
                whole, half = whole + early[0], half + early[1]
        damped[part, 0], damped[part, 1] = whole, half


@in_chunks
@njit(**FAST)
def _move_one_by_one(begin, end, rows, memories, u, v, body, u_next, damped):
    start, force = rows.start, memories.force
    neighbour, contact_type, constants = rows.neighbour, rows.contact_type, rows.constants
    block, disks = memories.block, start.size - 1
    count = (disks - LANES * block + LANES - 1) // LANES
    for chunk in range(begin, end):
        first, last = block + chunk * count // CHUNKS, block + (chunk + 1) * count // CHUNKS
        for p in range(LANES * first, min(LANES * last, disks)):
            i = U(p)
            force[U(0), i], force[U(1), i], force[U(2), i] = row_force(
                i, i, u, start, neighbour, contact_type, constants
            )
        damped[chunk, 0], damped[chunk, 1] = _move_disks(memories, first, last, u, v, body, u_next)


@njit(**FAST)
def _move_lanes(rows, memories, u, v, body, u_next, damped):
    _move_in_lanes(rows, memories, u, v, body, u_next, damped)


@njit(**FAST)
def _move_table(rows, memories, u, v, body, u_next, damped):
    _move_one_by_one(rows, memories, u, v, body, u_next, damped)


answer(move_remembering, LaneRows, _move_lanes)
answer(move_remembering, NeighbourTable, _move_table)
