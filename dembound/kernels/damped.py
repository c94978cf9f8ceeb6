"""The elastic law with damping: the forces on every disk pass through memories, see dembound/damping.py.

Of a force f, less that at rest, each mechanism takes r = p + g f and remembers p ← e r + g f. The forces on eight disks
are filtered at once, right after they have been computed.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, FAST, U
from dembound.kernels.compiler.lane_access import load, store, where_equal
from dembound.kernels.compiler.lanes import LANES, at_most, choose, lane, splat
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.drag import (
    changed_power,
    note_velocities,
    pull_supported,
    share_of,
    shares,
    with_drag,
    work_on_supported,
)
from dembound.kernels.elastic import row_force
from dembound.kernels.elastic_lanes import gathered
from dembound.kernels.lane_step import INLINED, blocks_of, go_on, kick, next_place, place_of, stray_forces
from dembound.kernels.law import answer, generic, is_law, is_tie
from dembound.kernels.step import note_damping
from dembound.kernels.tables import DampedLinks, LaneRows, NeighbourTable, TieMemories

_SUPPORTED, _MIXED = np.uint8(1), np.uint8(2)

FADED = 1e-216
"""Number (N, N·m) that is added to memories and subtracted again, so that those much smaller become zero.

They would decay into denormal numbers, which are a hundred times slower.
"""


@generic
def move_remembering(rows, memories, u, v, body, u_next, damped):
    """One step of the rows' disks with filtered forces; damped (chunks, 2) gets the work taken by free disks."""


@njit(**INLINED)
def _chosen(factors, layer, kind, k, i, mixed):
    """Factors e or g, by kind, of mechanism k of eight disks from slot i on."""
    factor = splat(factors[U(layer[i]), U(kind), k])
    if mixed:
        for each in range(factors.shape[0]):
            own = where_equal(layer, i, np.uint8(each))
            factor = choose(own, splat(factors[U(each), U(kind), k]), factor)
    return factor


@njit(**INLINED)
def _remember(memory, row, j, e, g, f):
    """The force r that a mechanism takes from a force f on eight disks, whose memories are from place j on in a row."""
    line = memory[row]
    part = g * f
    r = load(line, j) + part
    store(line, j, (e * r + (part + FADED)) - FADED)
    return r


@njit(**INLINED)
def _taken(memories, fx, fy, moment, i, mixed):
    """The forces and moments Σ r that mechanisms take from those on eight disks from slot i on."""
    memory, factors, layer = memories.memory, memories.factors, memories.layer
    count, j = U(factors.shape[2]), i - U(LANES * memories.block)
    rx, ry, rt = splat(0.0), splat(0.0), splat(0.0)
    for each in range(factors.shape[2]):
        k = U(each)
        e, g = _chosen(factors, layer, 0, k, i, mixed), _chosen(factors, layer, 1, k, i, mixed)
        rx += _remember(memory, k, j, e, g, fx)
        ry += _remember(memory, count + k, j, e, g, fy)
        rt += _remember(memory, count + count + k, j, e, g, moment)
    return rx, ry, rt


@njit(**INLINED)
def _move_block(memories, i, kinds, forces, place, factors, u, v, body, u_next, works):
    """One step of the disks in slots i to i + 7 under contact forces; returns works with those of this block added.

    kinds : of the block, see Memories.special. forces, place : forces and moment, displacements and rotation. factors :
    Δt over mass and over moment of inertia. works : power taken from free disks after and before the step, in lanes.
    """
    supported, mixed = kinds & _SUPPORTED != 0, kinds & _MIXED != 0
    fx, fy, moment = forces
    x, y, turn = place
    b, b_turn = factors
    nothing = splat(0.0)
    rest_x, rest_y, rest_t = nothing, nothing, nothing
    if memories.rest.shape[1] > 0:
        rest_x, rest_y, rest_t = load(memories.rest[0], i), load(memories.rest[1], i), load(memories.rest[2], i)
        fx -= rest_x
        fy -= rest_y
        moment -= rest_t
    if body.load.shape[1] > 0:  # first with the forces that it balances, so that their sum is exactly zero
        rest_x += load(body.load[0], i)
        rest_y += load(body.load[1], i)
        rest_t += load(body.load[2], i)
    rx, ry, rt = _taken(memories, fx, fy, moment, i, mixed)
    fx = (fx - rx) + rest_x
    fy = (fy - ry) + rest_y
    moment = (moment - rt) + rest_t
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
    return works[0] + after, works[1] + before


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
def _move_rows_of_copies(rows, memories, first, last, u, v, body, u_next):
    """One step of blocks first to last − 1 in rows of copies; returns works."""
    if first == last:
        return 0.0, 0.0
    stray_forces(rows, first, last, u)
    works = splat(0.0), splat(0.0)
    group, column, r = place_of(rows, first)
    for block in range(first, last):
        if block > first:
            group, column, r = next_place(rows, block, group, column, r)
        fx, fy, moment, x, y, turn, b, b_turn, _ = gathered(rows, block, r, column, u, body)
        works = _move_block(
            memories, U(LANES * block), memories.special[U(block)], (fx, fy, moment), (x, y, turn), (b, b_turn),
            u, v, body, u_next, works,
        )  # fmt: skip
    return _sums(works, body.step)


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
        works = _move_block(memories, i, kinds, forces, place, factors, u, v, body, u_next, works)
    return _sums(works, body.step)


@in_chunks
@njit(**FAST)
def _move_in_lanes(begin, end, rows, memories, u, v, body, u_next, damped):
    for chunk in range(begin, end):
        first, last = blocks_of(rows, chunk)
        damped[chunk, 0], damped[chunk, 1] = _move_rows_of_copies(rows, memories, first, last, u, v, body, u_next)


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


@njit(**FAST)
def _slots_of(memories):
    """The first slot of the memories of a part, and the one after its last."""
    first = LANES * memories.block
    return first, first + memories.memory.shape[1]


@njit(**FAST)
def _power_on_supported(memories, v, nodes):
    """Power of the forces taken from supported nodes (k,) at velocities v (3, n)."""
    first, last = _slots_of(memories)
    power = 0.0
    for s in range(nodes.size):
        i = nodes[s]
        if first <= i < last:
            for c in range(3):
                power += memories.force[c, i] * v[c, i]
    return power


@njit(**FAST)
def remember_crossing(crossing, u, v):
    """Fill `taken` with the forces that mechanisms take from those of contacts between layers, and their power."""
    power = 0.0
    for t in range(crossing.target.size):
        i = U(crossing.target[t])
        forces = row_force(
            U(t), U(crossing.owner[t]), u, crossing.start, crossing.neighbour, crossing.contact_type, crossing.constants
        )
        for c in range(3):
            crossing.taken[t, c] = _filtered(crossing, t, c, forces[c] - crossing.rest[t, c])
            power += crossing.taken[t, c] * v[U(c), i]
    crossing.power[0] = power


@njit(**FAST)
def _filtered(memories, t, c, f):
    """The force Σ r that mechanisms take from component c of the force f on target t."""
    memory, factors = memories.memory, memories.factors
    total = 0.0
    for k in range(factors.shape[2]):
        part = factors[t, 1, k] * f
        r = memory[t, c, k] + part
        memory[t, c, k] = (factors[t, 0, k] * r + (part + FADED)) - FADED
        total += r
    return total


@njit(**FAST)
def _take_crossing(memories, v, body, u_next, damped):
    """Subtract the forces taken from contacts between layers: the step of free disks is mended."""
    crossing, force = memories.crossing, memories.force
    after = 0.0
    before = crossing.power[0]
    for t in range(crossing.target.size):
        i = U(crossing.target[t])
        for each in range(3):
            c = U(each)
            r = crossing.taken[t, c]
            if body.mobility[i] > 0.0:
                mobility = body.inverse_inertia[i] if each == 2 else body.mobility[i]
                change = -r * body.free[c] * (mobility * share_of(memories.drag, i))
                v[c, i] += change
                u_next[c, i] += body.step * change
                earlier, later = changed_power(memories.drag, c, i, v[c, i], change)
                before += earlier
                after += r * v[c, i] + force[c, i] * change + later
            else:
                u_next[c, i] -= r
                before -= r * v[c, i]
            force[c, i] += r
    damped[0, 0] += 0.5 * body.step * (before + after)
    damped[0, 1] += 0.5 * body.step * before


@njit(**FAST)
def move(damped, u, u_next, v, body, nodes):
    """One step of all disks, see law.move."""
    memories = damped.memories
    note_velocities(memories.drag, v, memories.crossing.target)
    note_velocities(memories.drag, v, nodes)
    remember_crossing(memories.crossing, u, v)
    move_remembering(damped.links.rows, memories, u, v, body, u_next, damped.links.damped)
    _take_crossing(memories, v, body, u_next, damped.links.damped)
    pull_supported(memories.drag, _slots_of(memories), v, u_next, nodes)
    memories.held[0] = 0.5 * body.step * _power_on_supported(memories, v, nodes)


@njit(**FAST)
def finish(damped, v, body, nodes, work):
    """Add the energy taken by damping to the ledger."""
    note_damping(damped.links.damped, work)
    half, memories = damped.memories.held[0], damped.memories
    dragged, before = work_on_supported(memories.drag, _slots_of(memories), v, nodes, body.step)
    work[1, 1] += half + before
    work[0, 1] += half + 0.5 * body.step * _power_on_supported(memories, v, nodes) + dragged


@njit(**FAST)
def remember_ties(ties, u, v, force):
    """Filter the forces of ties in force (k, 3), which other ties have added."""
    for t in range(ties.line.size):
        s = ties.line[t]
        for c in range(3):
            f = force[s, c] - ties.rest[t, c]
            force[s, c] = (f - _filtered(ties, t, c, f)) + ties.rest[t, c]


answer(move_remembering, LaneRows, _move_lanes)
answer(move_remembering, NeighbourTable, _move_table)
is_law(DampedLinks, move=move, finish=finish)
is_tie(TieMemories, across=remember_ties)
