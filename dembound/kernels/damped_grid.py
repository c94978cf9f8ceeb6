"""The law of a grid of spectral elements with damping: forces of elements on their points pass through memories.

Each element filters its own forces, see dembound/damping.py, so that neighbours may be damped unlike; those of
an element that absorbs after its convolution variables. The work done on all elements counts as taken by damping, and
the strain energy of those that do not absorb is subtracted when the ledger is written.
"""

from numba import get_thread_id, njit

from dembound.kernels.common import CHUNKS, FAST, U, column_sum
from dembound.kernels.compiler.lanes import LANES, load, splat, store
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.damped import FADED
from dembound.kernels.elements import WITHIN, absorbing_forces, block_forces, shape_of
from dembound.kernels.grid import move_core, move_node, store_rim, sum_at, sum_of
from dembound.kernels.law import is_law
from dembound.kernels.tables import DampedGrid

_STEP = U(LANES)


@njit(**WITHIN)
def _remember(shape, memory, factors, count, block, space):
    """Filter the forces of a block in the first two fields of the work space, by `count` mechanisms."""
    size = U(2) * U(shape.weight.size) * _STEP
    first, own = U(block) * U(count) * size, U(2) * U(block) * U(count) * _STEP
    for p in range(2 * shape.weight.size):
        i = U(p) * _STEP
        f = load(space, i)
        total = splat(0.0)
        for each in range(count):
            k = U(each)
            j = first + k * size + i
            part = load(factors, own + (U(count) + k) * _STEP) * f
            r = load(memory, j) + part
            store(memory, j, (load(factors, own + k * _STEP) * r + (part + FADED)) - FADED)
            total += r
        store(space, i, f - total)


@njit(**FAST)
def _move_blocks(damped, first, last, u, v, body, u_next, space, taken):
    """Compute the forces of blocks first to last − 1, and move their core nodes."""
    grid = damped.grid
    points, blocks, absorber, force = grid.points, grid.blocks, grid.absorber, grid.force
    elastic = blocks.blocks - blocks.layers
    whole, half = splat(0.0), splat(0.0)
    for block in range(first, last):
        shape = shape_of(grid.elements, blocks, block)
        if block < elastic:
            block_forces(points, shape, blocks, block, u, space)
        else:
            absorbing_forces(points, shape, blocks, absorber, block, u, v, space)
        _remember(shape, damped.memory, damped.factors, damped.mechanisms, block, space)
        store_rim(shape, block, space, force)
        before, after = move_core(shape, blocks, block, space, u, v, body, u_next)
        half += before
        whole += before + after
    taken[0] = -0.5 * body.step * sum_of(whole)
    taken[1] = -0.5 * body.step * sum_of(half)


@njit(**FAST)
def _move_shared(blocks, force, first, last, u, v, body, u_next, taken):
    """Sum the forces on shared nodes first to last − 1, and move them."""
    half = 0.0
    whole = 0.0
    for n in range(first, last):
        i = U(blocks.shared_begin + n)
        x, y = sum_at(blocks, U(n), force)
        before = x * v[U(0), i] + y * v[U(1), i]
        move_node(i, x, y, u, v, body, u_next)
        half += before
        whole += before
        if body.mobility[i] > 0.0:  # `finish` adds that of supported ones
            whole += x * v[U(0), i] + y * v[U(1), i]
    taken[2] = -0.5 * body.step * whole
    taken[3] = -0.5 * body.step * half


@in_chunks
@njit(**FAST)
def _move_all_blocks(begin, end, damped, u, v, body, u_next):
    grid = damped.grid
    n = grid.blocks.blocks
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        if first < last:
            _move_blocks(damped, first, last, u, v, body, u_next, grid.space[get_thread_id()], grid.taken[chunk])


@in_chunks
@njit(**FAST)
def _move_all_shared(begin, end, blocks, force, taken, u, v, body, u_next):
    n = blocks.start.size - 1
    for chunk in range(begin, end):
        first, last = chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS
        _move_shared(blocks, force, first, last, u, v, body, u_next, taken[chunk])


@njit(**FAST)
def _power_on_core(damped, v, nodes):
    """Power of the forces of elements on supported core nodes (k,) at velocities v (3, n)."""
    power = 0.0
    for s in range(nodes.size):
        k = nodes[s] - damped.grid.blocks.core_begin
        if 0 <= k < damped.held.shape[1]:
            for c in range(2):
                power += damped.held[c, k] * v[c, nodes[s]]
    return power


@njit(**FAST)
def move(damped, u, u_next, v, body, nodes):
    """One step of all nodes, see law.move."""
    grid = damped.grid
    _move_all_blocks(damped, u, v, body, u_next)
    _move_all_shared(grid.blocks, grid.force, grid.taken, u, v, body, u_next)
    for s in range(nodes.size):
        k = nodes[s] - grid.blocks.core_begin
        if 0 <= k < damped.held.shape[1]:
            for c in range(2):
                loaded = body.load[c, nodes[s]] if body.load.shape[1] > 0 else 0.0
                damped.held[c, k] = u_next[c, nodes[s]] - loaded
    damped.power[0] = _power_on_core(damped, v, nodes)


@njit(**FAST)
def finish(damped, v, body, nodes, work):
    """Add the work done on all elements to the ledger, as damping."""
    grid = damped.grid
    blocks = grid.blocks
    late = _power_on_core(damped, v, nodes)
    for s in range(nodes.size):
        i = U(nodes[s])
        k = nodes[s] - blocks.shared_begin
        if 0 <= k < blocks.start.size - 1:
            x, y = sum_at(blocks, U(k), grid.force)
            late += x * v[U(0), i] + y * v[U(1), i]
    half, early = 0.5 * body.step, damped.power[0]
    work[1, 1] += column_sum(grid.taken, 1) + column_sum(grid.taken, 3) - half * early
    work[0, 1] += column_sum(grid.taken, 0) + column_sum(grid.taken, 2) - half * (early + late)


is_law(DampedGrid, move=move, finish=finish)
