"""The elastic law with damping: the forces on every disk pass through memories, see dembound/damping.py.

Of a force f, less that at rest, a mechanism with the memory s takes g t, t = s + f, and remembers s ← e t + f. The
forces on eight disks are filtered at once, right after they have been computed; their memories are side by side.
"""

from numba import njit, types

from dembound.kernels.common import CHUNKS, FAST, U
from dembound.kernels.compiler.lane_access import fetch, load, load_of, store, store_of
from dembound.kernels.compiler.lanes import LANES, at_most, choose, lane, splat
from dembound.kernels.compiler.separate import apart, in_chunks
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

_STEP = U(LANES)

_AHEAD = U(144 * LANES)
"""By how many places memories are asked for ahead, with three mechanisms those of 16 blocks: without, beyond the cache
steps take 1.3 times as long, as the processor does not ask early enough for a single array that is read at such a pace.
"""

FADED = 1e-216
"""Number (N, N·m) that is added to memories and subtracted again, so that those much smaller become zero.

They would decay into denormal numbers, which are a hundred times slower.
"""

FADES = 256
"""Steps after which small memories of disks become zero.

From FADED to denormal numbers they take longer for e ≥ 0.44, a relaxation time of 1.2 steps.
"""


@generic
def move_remembering(rows, memories, u, v, body, u_next, damped):
    """One step of the rows' disks with filtered forces; damped (chunks, 2) gets the work taken by free disks."""


@njit(**INLINED)
def _filtered_lanes(mechanisms, factors, own, memory, j, f):
    """The sum Σ g t that K mechanisms take from forces f in lanes, whose memories are from place j on.

    mechanisms : K numbers, see Memories. factors : e, then g of the mechanisms in lanes, from place `own` on.
    """
    total = splat(0.0)
    for each in range(len(mechanisms)):  # a constant, so the loop is unrolled: 1.2 times as fast
        k = U(each) * _STEP
        fetch(memory, j + k + _AHEAD)
        t = load(memory, j + k) + f
        store(memory, j + k, load(factors, own + k) * t + f)
        total += load(factors, own + U(len(mechanisms)) * _STEP + k) * t
    return total


@njit(**INLINED)
def _fade(memories, first, last):
    """At some steps make memories of blocks first to last − 1 that are much smaller than FADED zero."""
    if memories.fading[0] != 0:
        size = 3 * len(memories.mechanisms)
        for each in range(size * (first - memories.block), size * (last - memories.block)):
            j = U(each) * _STEP
            store(memories.memory, j, (load(memories.memory, j) + FADED) - FADED)


@njit(**INLINED)
def _move_block(memories, block, forces, place, factors, u, v, body, u_next, works):
    """One step of the disks of a block under contact forces; returns works with those of this block added.

    forces, place : forces and moment, displacements and rotation. factors : Δt over mass and over moment of inertia.
    works : power taken from free disks after and before the step, in lanes.
    """
    i, supported = _STEP * U(block), memories.special[U(block)] != 0
    fx, fy, moment = forces
    x, y, turn = place
    b, b_turn = factors
    gx, gy, gt = fx, fy, moment
    if memories.rest.shape[1] > 0:
        gx -= load_of(memories.rest, U(0), i)
        gy -= load_of(memories.rest, U(1), i)
        gt -= load_of(memories.rest, U(2), i)
    if body.load.shape[1] > 0:  # first with the forces that it balances, so that their sum is exactly zero
        fx += load_of(body.load, U(0), i)
        fy += load_of(body.load, U(1), i)
        moment += load_of(body.load, U(2), i)
    size = U(len(memories.mechanisms)) * _STEP
    own, j = U(2) * size * U(memories.kind[U(block)]), U(3) * size * U(block - memories.block)
    rx, ry, rt = splat(0.0), splat(0.0), splat(0.0)
    if body.free[U(0)] != 0.0:
        rx = _filtered_lanes(memories.mechanisms, memories.factors, own, memories.memory, j, gx)
    if body.free[U(1)] != 0.0:
        ry = _filtered_lanes(memories.mechanisms, memories.factors, own, memories.memory, j + size, gy)
    if body.free[U(2)] != 0.0:
        rt = _filtered_lanes(memories.mechanisms, memories.factors, own, memories.memory, j + size + size, gt)
    fx -= rx
    fy -= ry
    moment -= rt
    was_x, was_y, was_t = load_of(v, U(0), i), load_of(v, U(1), i), load_of(v, U(2), i)
    share = shares(memories.drag, i)
    keep = share + share - 1.0
    now_x = kick(keep * was_x, fx, body.free[U(0)] * (share * b))
    now_y = kick(keep * was_y, fy, body.free[U(1)] * (share * b))
    now_t = kick(keep * was_t, moment, body.free[U(2)] * (share * b_turn))
    before, after = rx * was_x + ry * was_y + rt * was_t, rx * now_x + ry * now_y + rt * now_t
    before, after = with_drag(memories.drag, i, before, after, (was_x, was_y, was_t), (now_x, now_y, now_t))
    if supported:
        held = at_most(b, 0.0)
        before, after = choose(held, 0.0, before), choose(held, 0.0, after)
        store_of(memories.force, U(0), i, rx)
        store_of(memories.force, U(1), i, ry)
        store_of(memories.force, U(2), i, rt)
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


@in_chunks
@njit(**FAST)
def _move_in_lanes(begin, end, rows, memories, u, v, body, u_next, damped):
    for chunk in range(begin, end):
        first, last = blocks_of(rows, chunk)
        works = splat(0.0), splat(0.0)
        if first < last:
            _fade(memories, first, last)
            stray_forces(rows, first, last, u)
            group, column, r = place_of(rows, first)
            for block in range(first, last):
                if block > first:
                    group, column, r = next_place(rows, block, group, column, r)
                fx, fy, moment, x, y, turn, b, b_turn, _ = gathered(rows, block, r, column, u, body)
                works = _move_block(
                    memories, block, (fx, fy, moment), (x, y, turn), (b, b_turn), u, v, body, u_next, works
                )
        damped[chunk, 0], damped[chunk, 1] = _sums(works, body.step)


@in_chunks
@njit(**FAST)
def _move_one_by_one(begin, end, rows, memories, u, v, body, u_next, damped):
    start, force = rows.start, memories.force
    neighbour, contact_type, constants = rows.neighbour, rows.contact_type, rows.constants
    begins, disks = memories.block, start.size - 1
    count = (disks - LANES * begins + LANES - 1) // LANES
    for chunk in range(begin, end):
        first, last = begins + chunk * count // CHUNKS, begins + (chunk + 1) * count // CHUNKS
        for p in range(LANES * first, min(LANES * last, disks)):
            i = U(p)
            force[U(0), i], force[U(1), i], force[U(2), i] = row_force(
                i, i, u, start, neighbour, contact_type, constants
            )
        _fade(memories, first, last)
        works = splat(0.0), splat(0.0)
        for block in range(first, last):
            i = _STEP * U(block)
            forces = load_of(force, U(0), i), load_of(force, U(1), i), load_of(force, U(2), i)
            place = load_of(u, U(0), i), load_of(u, U(1), i), load_of(u, U(2), i)
            factors = load(body.mobility, i), load(body.inverse_inertia, i)
            works = _move_block(memories, block, forces, place, factors, u, v, body, u_next, works)
        damped[chunk, 0], damped[chunk, 1] = _sums(works, body.step)


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
    return first, first + memories.memory.size // (3 * len(memories.mechanisms))


@apart(types.float64)
@njit(**FAST)
def _power_on(force, first, last, v, nodes):
    power = 0.0
    for s in range(nodes.size):
        i = nodes[s]
        if first <= i < last:
            for c in range(3):
                power += force[c, i] * v[c, i]
    return power


@njit(**INLINED)
def _power_on_supported(memories, v, nodes):
    """Power of the forces taken from supported nodes (k,) at velocities v (3, n)."""
    first, last = _slots_of(memories)
    return _power_on(memories.force, first, last, v, nodes)


@apart()
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
    """The force Σ g t that mechanisms take from component c of the force f on target t."""
    memory, factors = memories.memory, memories.factors
    total = 0.0
    for k in range(factors.shape[2]):
        whole = memory[t, c, k] + f
        memory[t, c, k] = (factors[t, 0, k] * whole + (f + FADED)) - FADED
        total += factors[t, 1, k] * whole
    return total


@apart()
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
def push(damped, u, u_next, v, number, step, work):
    """Note whether small memories become zero in this step, see law.push; no bond breaks."""
    damped.memories.fading[0] = number % FADES == 0
    return 0


@njit(**FAST)
def move(damped, u, u_next, v, body, nodes):
    """One step of all disks, see law.move."""
    memories = damped.memories
    note_velocities(memories.drag, v, memories.crossing.target)
    note_velocities(memories.drag, v, nodes)
    crosses = memories.crossing.target.size > 0
    if crosses:
        remember_crossing(memories.crossing, u, v)
    move_remembering(damped.links.rows, memories, u, v, body, u_next, damped.links.damped)
    if crosses:
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
is_law(DampedLinks, push=push, move=move, finish=finish)
is_tie(TieMemories, across=remember_ties)
