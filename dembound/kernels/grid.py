"""The law of a grid of spectral elements, and its step of central differences.

First every block of eight elements computes its forces, moves the nodes inside elements, and stores its forces on
shared nodes. Then each shared node sums the forces of its at most four elements, in a fixed order, and is moved, with
the same bits for any number of threads. Nodes have no rotation, no local damping, and stay at rest on outer edges.

In the ledger, work done on absorbing elements counts as damping at once. Its sum with the kinetic energy and the strain
energy of the other elements is conserved as by central differences.
"""

from numba import get_thread_id, njit

from dembound.kernels import lane_step
from dembound.kernels.common import CHUNKS, FAST, U, column_sum
from dembound.kernels.compiler.lane_access import load, store
from dembound.kernels.compiler.lanes import LANES, at_most, choose, lane, splat
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.elements import WITHIN, absorbing_forces, block_forces, gather, shape_of
from dembound.kernels.law import is_law
from dembound.kernels.step import kick
from dembound.kernels.tables import Grid

_STEP = U(LANES)


@njit(**WITHIN)
def sum_of(values):
    """Sum over the lanes, in order."""
    total = 0.0
    for k in range(LANES):
        total += lane(values, U(k))
    return total


@njit(**WITHIN)
def store_rim(shape, block, space, force):
    """Store the forces in the first two fields of the work space on rim points."""
    size = U(shape.weight.size) * _STEP
    entry = U(2) * U(block) * U(shape.rim.size) * _STEP
    for p in range(shape.rim.size):
        i = U(shape.rim[p]) * _STEP
        store(force, entry, load(space, i))
        store(force, entry + _STEP, load(space, i + size))
        entry += U(2) * _STEP


@njit(**WITHIN)
def move_core(shape, blocks, block, space, u, v, body, u_next):
    """Move the core nodes of a block by a step; returns Σ F·v⁻ and Σ F·v⁺ of those that are not supported."""
    size = U(shape.weight.size) * _STEP
    nothing = splat(0.0)
    before, after = nothing, nothing
    loaded = body.load.shape[1] > 0
    slot = U(blocks.core_begin) + U(block) * U(shape.core.size) * _STEP
    for p in range(shape.core.size):
        i = U(shape.core[p]) * _STEP
        mobility = load(body.mobility, slot)
        held = at_most(mobility, 0.0)
        for c in range(2):
            own = load(space, i + U(c) * size)
            force = own
            if loaded:
                force += load(body.load[c], slot)
            was = load(v[c], slot)
            now = lane_step.kick(was, force, body.free[c] * mobility)
            before += choose(held, 0.0, own * was)
            after += choose(held, 0.0, own * now)
            store(v[c], slot, now)
            store(u_next[c], slot, choose(held, force, load(u[c], slot) + body.step * now))
        slot += _STEP
    return before, after


@njit(**FAST)
def _move_blocks(points, elements, blocks, absorber, force, first, last, u, v, body, u_next, space, taken):
    """Compute the forces of blocks first to last − 1, and move their core nodes."""
    elastic = blocks.blocks - blocks.layers
    for block in range(first, min(last, elastic)):
        shape = shape_of(elements, blocks, block)
        block_forces(points, shape, blocks, block, u, space)
        store_rim(shape, block, space, force)
        move_core(shape, blocks, block, space, u, v, body, u_next)
    whole, half = splat(0.0), splat(0.0)
    for block in range(max(first, elastic), last):
        shape = shape_of(elements, blocks, block)
        absorbing_forces(points, shape, blocks, absorber, block, u, v, space)
        store_rim(shape, block, space, force)
        before, after = move_core(shape, blocks, block, space, u, v, body, u_next)
        half += before
        whole += before + after
    taken[0] = -0.5 * body.step * sum_of(whole)
    taken[1] = -0.5 * body.step * sum_of(half)


@njit(**WITHIN)
def sum_at(blocks, k, force):
    """Force (x, y) of all elements on the k-th shared node."""
    first, end = blocks.start[k], blocks.start[k + U(1)]
    entry = U(blocks.entry[U(first)])
    x, y = force[entry], force[entry + _STEP]
    for e in range(first + 1, end):
        entry = U(blocks.entry[U(e)])
        x += force[entry]
        y += force[entry + _STEP]
    return x, y


@njit(**WITHIN)
def sums_at(blocks, k, force):
    """Sums at a node, and the part of them of elements that absorb."""
    x, y, ax, ay = 0.0, 0.0, 0.0, 0.0
    for e in range(blocks.start[k], blocks.start[k + U(1)]):
        entry = blocks.entry[U(e)]
        fx, fy = force[U(entry)], force[U(entry) + _STEP]
        x += fx
        y += fy
        if entry >= blocks.entry_layer:
            ax += fx
            ay += fy
    return x, y, ax, ay


@njit(**WITHIN)
def move_node(i, x, y, u, v, body, u_next):
    """Move node i by a step under a force (x, y) and steady loads; u_next gets the forces on a supported one."""
    if body.load.shape[1] > 0:
        x += body.load[U(0), i]
        y += body.load[U(1), i]
    mobility = body.mobility[i]
    if mobility == 0.0:
        u_next[U(0), i] = x
        u_next[U(1), i] = y
    else:
        vx = kick(v[U(0), i], x, body.free[0] * mobility, 0.0)
        vy = kick(v[U(1), i], y, body.free[1] * mobility, 0.0)
        v[U(0), i] = vx
        v[U(1), i] = vy
        u_next[U(0), i] = u[U(0), i] + body.step * vx
        u_next[U(1), i] = u[U(1), i] + body.step * vy


@njit(**WITHIN)
def _move_shared(blocks, force, first, last, u, v, body, u_next, taken):
    """Sum the forces on shared nodes first to last − 1, and move them."""
    elastic = blocks.shared_layer - blocks.shared_begin
    for n in range(first, min(last, elastic)):
        x, y = sum_at(blocks, U(n), force)
        move_node(U(blocks.shared_begin + n), x, y, u, v, body, u_next)
    half = 0.0
    whole = 0.0
    for n in range(max(first, elastic), last):
        i = U(blocks.shared_begin + n)
        x, y, ax, ay = sums_at(blocks, U(n), force)
        before = ax * v[U(0), i] + ay * v[U(1), i]
        move_node(i, x, y, u, v, body, u_next)
        half += before
        whole += before
        if body.mobility[i] > 0.0:  # `finish` adds that of supported ones
            whole += ax * v[U(0), i] + ay * v[U(1), i]
    taken[2] = -0.5 * body.step * whole
    taken[3] = -0.5 * body.step * half


@in_chunks
@njit(**FAST)
def _move_all_blocks(begin, end, points, elements, blocks, absorber, force, space, taken, u, v, body, u_next):
    n = blocks.blocks
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        if first < last:
            own, result = space[get_thread_id()], taken[chunk]
            _move_blocks(points, elements, blocks, absorber, force, first, last, u, v, body, u_next, own, result)


@in_chunks
@njit(**FAST)
def _move_all_shared(begin, end, blocks, force, taken, u, v, body, u_next):
    n = blocks.start.size - 1
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        _move_shared(blocks, force, first, last, u, v, body, u_next, taken[chunk])


@njit(**FAST)
def move(grid, u, u_next, v, body, nodes):
    """One step of all nodes, see law.move."""
    blocks, force, taken = grid.blocks, grid.force, grid.taken
    _move_all_blocks(
        grid.points, grid.elements, blocks, grid.absorber, force, grid.space, taken, u, v, body, u_next
    )  # fmt: skip
    _move_all_shared(blocks, force, taken, u, v, body, u_next)


@njit(**FAST)
def finish(grid, v, body, nodes, work):
    """Add the work taken by absorbing elements to the ledger, as damping."""
    if grid.blocks.layers == 0:
        return
    late = 0.0
    begin = grid.blocks.shared_begin
    for s in range(nodes.size):
        i = U(nodes[s])
        k = nodes[s] - begin
        if grid.blocks.shared_layer - begin <= k < grid.blocks.start.size - 1:
            _, _, ax, ay = sums_at(grid.blocks, U(k), grid.force)
            late += ax * v[U(0), i] + ay * v[U(1), i]
    work[1, 1] += column_sum(grid.taken, 1) + column_sum(grid.taken, 3)
    work[0, 1] += column_sum(grid.taken, 0) + column_sum(grid.taken, 2) - 0.5 * body.step * late


is_law(Grid, move=move, finish=finish)


@njit(**FAST)
def _store_forces(points, elements, blocks, force, first, last, u, result, space):
    """Store the elastic forces of blocks first to last − 1, those on core nodes in result (3, slots)."""
    for block in range(first, last):
        shape = shape_of(elements, blocks, block)
        size = U(shape.weight.size) * _STEP
        block_forces(points, shape, blocks, block, u, space)
        store_rim(shape, block, space, force)
        slot = U(blocks.core_begin) + U(block) * U(shape.core.size) * _STEP
        for p in range(shape.core.size):
            i = U(shape.core[p]) * _STEP
            store(result[0], slot, load(space, i))
            store(result[1], slot, load(space, i + size))
            slot += _STEP


@in_chunks
@njit(**FAST)
def _fill_blocks(begin, end, points, elements, blocks, force, space, u, result):
    n = blocks.blocks
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        _store_forces(points, elements, blocks, force, first, last, u, result, space[get_thread_id()])


@in_chunks
@njit(**FAST)
def _fill_shared(begin, end, blocks, force, result):
    m = blocks.start.size - 1
    for chunk in range(begin, end):
        for k in range(chunk * m // CHUNKS, (chunk + 1) * m // CHUNKS):
            x, y = sum_at(blocks, U(k), force)
            result[U(0), U(blocks.shared_begin + k)] = x
            result[U(1), U(blocks.shared_begin + k)] = y


@njit(**FAST)
def fill_forces(grid, u, result):
    """Fill result (3, slots) with the elastic forces (N) of all elements at displacements u; none on outer edges."""
    _fill_blocks(grid.points, grid.elements, grid.blocks, grid.force, grid.space, u, result)
    _fill_shared(grid.blocks, grid.force, result)


@njit(**FAST)
def _block_energies(points, elements, blocks, first, last, u, energy, space):
    """Strain energies of blocks first to last − 1: −½Σ u·F."""
    for block in range(first, last):
        shape = shape_of(elements, blocks, block)
        size = U(shape.weight.size) * _STEP
        block_forces(points, shape, blocks, block, u, space)
        gather(shape, blocks, block, u, space, 2)
        doubled = splat(0.0)
        for k in range(2 * shape.weight.size):
            i = U(k) * _STEP
            doubled += load(space, i) * load(space, i + U(2) * size)
        energy[block] = -0.5 * sum_of(doubled)


@in_chunks
@njit(**FAST)
def _energies(begin, end, points, elements, blocks, space, u, energy):
    n = energy.size
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        _block_energies(points, elements, blocks, first, last, u, energy, space[get_thread_id()])


@njit(**FAST)
def strain_energies(grid, u, energy):
    """Fill energy (k,) J with the strain energies of the first k blocks at displacements u (3, slots)."""
    _energies(grid.points, grid.elements, grid.blocks, grid.space, u, energy)
