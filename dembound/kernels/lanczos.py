"""The Lanczos iteration for M⁻¹K in displacements: two passes over the disks a step.

M⁻¹K is symmetric in the product ⟨a, b⟩ = Σ m a b, I in place of m for rotations, so that neither roots of masses nor
scaled copies of vectors are needed. Sums are added chunk by chunk: they are the same for any number of threads.
"""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, FAST, MAKES, U
from dembound.kernels.compiler.separate import in_chunks


@njit(**FAST)
def _total(sums):
    """Sum of sums (chunks,), in order."""
    total = 0.0
    for chunk in range(sums.size):
        total += sums[chunk]
    return total


@njit(**MAKES)
def work(u, force):
    """Σ u·F (J) of displacements and forces (3, slots)."""
    sums = np.empty(CHUNKS)
    _works(u, force, sums)
    return _total(sums)


@in_chunks
@njit(**FAST)
def _works(begin, end, u, force, sums):
    n = u.shape[1]
    for chunk in range(begin, end):
        total = 0.0
        for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            i = U(p)
            total += u[U(0), i] * force[U(0), i] + u[U(1), i] * force[U(1), i] + u[U(2), i] * force[U(2), i]
        sums[chunk] = total


@njit(**MAKES)
def next_vector(u, before, force, mass, inertia, free, pull, along, back):
    """Replace `before` by pull·M⁻¹F − along·u − back·before, all (3, slots), and return its square ⟨·, ·⟩.

    mass kg, inertia kg·m² : (slots,), both zero in slots without a disk; free : (3,) 1, or 0 for a component held
    everywhere; pull, along, back : numbers.
    """
    squares = np.empty(CHUNKS)
    _next_vector(u, before, force, mass, inertia, free, pull, along, back, squares)
    return _total(squares)


@in_chunks
@njit(**FAST)
def _next_vector(begin, end, u, before, force, mass, inertia, free, pull, along, back, squares):
    n = u.shape[1]
    for chunk in range(begin, end):
        total = 0.0
        for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            i = U(p)
            m = mass[i]
            shift = 0.0
            turn = 0.0
            if m > 0.0:
                shift = pull / m
                turn = pull / inertia[i]
            x = free[0] * shift * force[U(0), i] - along * u[U(0), i] - back * before[U(0), i]
            y = free[1] * shift * force[U(1), i] - along * u[U(1), i] - back * before[U(1), i]
            t = free[2] * turn * force[U(2), i] - along * u[U(2), i] - back * before[U(2), i]
            before[U(0), i] = x
            before[U(1), i] = y
            before[U(2), i] = t
            total += m * (x * x + y * y) + inertia[i] * (t * t)
        squares[chunk] = total
