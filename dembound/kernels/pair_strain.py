"""The strain of a pair of disks: its stretch and shear from the motion of both, see contacts.py."""

import numpy as np
from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.start_strain import began_with
from dembound.pairwise import P


@njit(**FAST, inline="always")
def pair(c, u, first, second, contact_type, constants):
    """Particles of a pair, its row of constants, and the displacements of j relative to i."""
    i = U(first[c])
    j = U(second[c])
    k = U(contact_type[c])
    return i, j, k, u[U(0), j] - u[U(0), i], u[U(1), j] - u[U(1), i]


@njit(**FAST, inline="always")
def reference_strain(i, j, k, dx, dy, u, constants, began):
    """Normal at the start, distance, stretch and shear of a pair for small displacements."""
    rest = constants[k, P.rest]
    nx = constants[k, P.x] / rest
    ny = constants[k, P.y] / rest
    stretch = nx * dx + ny * dy + began_with(began, k, U(0))
    arm_i = 0.5 * rest + constants[k, P.offset]
    shear = nx * dy - ny * dx - arm_i * u[U(2), i] - (rest - arm_i) * u[U(2), j] + began_with(began, k, U(1))
    return nx, ny, rest, stretch, shear


@njit(**FAST, inline="always")
def updated_stretch(k, dx, dy, constants, began):
    """Normal and distance of a pair whose vector has changed by dx, dy, and its stretch.

    The stretch is (d² − d_0²)/(d + d_0), which keeps the digits that d − d_0 loses, and that at the start.
    """
    x = constants[k, P.x]
    y = constants[k, P.y]
    rest = constants[k, P.rest]
    distance = np.sqrt((x + dx) * (x + dx) + (y + dy) * (y + dy))
    stretch = ((x + x + dx) * dx + (y + y + dy) * dy) / (distance + rest) + began_with(began, k, U(0))
    inverse = 1.0 / distance
    return (x + dx) * inverse, (y + dy) * inverse, distance, stretch


@njit(**FAST, inline="always")
def slide(i, j, k, nx, ny, distance, v, constants):
    """Rate (m/s) of the shear of a pair with normal and distance."""
    arm_i = 0.5 * distance + constants[k, P.offset]
    across = nx * (v[U(1), j] - v[U(1), i]) - ny * (v[U(0), j] - v[U(0), i])
    return across - arm_i * v[U(2), i] - (distance - arm_i) * v[U(2), j]


@njit(**FAST, inline="always")
def updated_strain(i, j, k, dx, dy, was, v, step, constants, began):
    """The strain of a pair whose normal and arms follow the motion; was: the shear before the step (s)."""
    nx, ny, distance, stretch = updated_stretch(k, dx, dy, constants, began)
    return nx, ny, distance, stretch, was + step * slide(i, j, k, nx, ny, distance, v, constants)
