"""The step of central differences on blocks of eight disks: functions for kernels of rows of copies."""

from numba import njit

from dembound.kernels.common import CHUNKS, FAST, INLINED, REST, U
from dembound.kernels.compiler.lane_access import store_of
from dembound.kernels.compiler.lanes import LANES, at_most, choose, magnitude, with_sign
from dembound.kernels.elastic import row_force

RUN = 16
"""Blocks of which chunks have whole multiples, as to begin one takes as long as some blocks."""


@njit(**INLINED)
def kick(v, f, b):
    """Half-step velocity after a force f, see step.kick."""
    w = v + b * f
    return choose(at_most(magnitude(w), REST), 0.0, w)


@njit(**INLINED)
def local_damping(v, f, damp):
    """The negative force of local damping (Cundall: −damp·|F|·sign(v))."""
    return choose(at_most(magnitude(v), 0.0), 0.0, with_sign(damp * magnitude(f), v))


@njit(**FAST)
def first_at(numbers, least):
    """Index of the first of ascending numbers that is not below the least."""
    low = 0
    high = numbers.size
    while low < high:
        middle = (low + high) // 2
        if numbers[middle] < least:
            low = middle + 1
        else:
            high = middle
    return low


@njit(**FAST)
def stray_forces(rows, first, last, u):
    """Forces and moments of strays on the disks in blocks first to last − 1, in rows.extra."""
    extra = rows.extra
    for k in range(first_at(rows.stray, LANES * first), first_at(rows.stray, LANES * last)):
        i = U(rows.stray[k])
        fx, fy, moment = row_force(
            U(k), i, u, rows.stray_start, rows.stray_neighbour, rows.stray_type, rows.stray_constants
        )
        extra[U(0), i] = fx
        extra[U(1), i] = fy
        extra[U(2), i] = moment


@njit(**INLINED)
def blocks_of(rows, chunk):
    """First block of a chunk, and the one after its last; in small bodies many chunks are empty."""
    begin = rows.group_block[0]
    n = rows.group_block[rows.group_block.size - 1] - begin
    first, last = chunk * n // CHUNKS // RUN * RUN, (chunk + 1) * n // CHUNKS // RUN * RUN
    return begin + first, begin + (n if chunk + 1 == CHUNKS else last)


@njit(**INLINED)
def place_of(rows, block):
    """Group, column and row of a block."""
    group = first_at(rows.group_block, block + 1) - 1
    begin, end = rows.group_row[group], rows.group_row[group + 1]
    before = block - rows.group_block[group]
    return group, before // (end - begin), begin + before % (end - begin)


@njit(**INLINED)
def next_place(rows, block, group, column, r):
    """Places of a block, from those of the block before."""
    r += 1
    if r == rows.group_row[group + 1]:
        if block == rows.group_block[group + 1]:
            group += 1
            while block == rows.group_block[group + 1]:  # groups without rows
                group += 1
            column = -1
        column += 1
        r = rows.group_row[group]
    return group, column, r


@njit(**INLINED)
def go_on(i, special, b, fx, fy, moment, x, y, turn, now_x, now_y, now_t, step, v, u_next):
    """Store velocities and new displacements; for supported disks forces in place of displacements."""
    store_of(v, U(0), i, now_x)
    store_of(v, U(1), i, now_y)
    store_of(v, U(2), i, now_t)
    x += step * now_x
    y += step * now_y
    turn += step * now_t
    if special:
        held = at_most(b, 0.0)
        x = choose(held, fx, x)
        y = choose(held, fy, y)
        turn = choose(held, moment, turn)
    store_of(u_next, U(0), i, x)
    store_of(u_next, U(1), i, y)
    store_of(u_next, U(2), i, turn)
