"""The least factor of the waves at which a pair reaches a limit of its elastic law."""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, FAST, U
from dembound.kernels.compiler.limits import factor_of
from dembound.kernels.compiler.separate import in_chunks
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.pair_strain import pair, reference_strain


@njit(**FAST)
def least_factors(u, rest, contacts, slopes, allowed, bonds, strength, least, where):
    """Find in each chunk of pairs the least factor f at which a pair reaches a limit with rest + f·(u − rest).

    A limit of a pair with stretch e, shear s and turn θ is a·e + b·s + c·θ = d: slopes (p, m, 3) has a, b, c of the m
    limits of each type of contact, allowed (p, m) their d, infinite for none; strength : 1.0, or factors (b,) of d in
    the limits of bonds, from number `bonds` on. u, rest : (3, slots) displacements. least (chunks,) receives the
    factor, infinite for none, and where (chunks, 2) the pair and its limit.
    """
    _least_factors(u, rest, contacts, slopes, allowed, bonds, strength, least, where)


@in_chunks
@njit(**FAST)
def _least_factors(begin, end, u, rest, contacts, slopes, allowed, bonds, strength, least, where):
    first, second, contact_type, constants = contacts.first, contacts.second, contacts.contact_type, contacts.constants
    began = contacts.began
    b = first.size
    limits = allowed.shape[1]
    for chunk in range(begin, end):
        lowest = np.inf
        which = -1
        limit = -1
        for p in range(chunk * b // CHUNKS, (chunk + 1) * b // CHUNKS):
            c = U(p)
            i, j, k, x, y = pair(c, rest, first, second, contact_type, constants)
            _, _, _, still_stretch, still_shear = reference_strain(i, j, k, x, y, rest, constants, began)
            still_turn = rest[U(2), j] - rest[U(2), i] + began_with(began, k, U(2))
            i, j, k, x, y = pair(c, u, first, second, contact_type, constants)
            _, _, _, stretch, shear = reference_strain(i, j, k, x, y, u, constants, began)
            stretch -= still_stretch
            shear -= still_shear
            turn = u[U(2), j] - u[U(2), i] + began_with(began, k, U(2)) - still_turn
            for number in range(limits):
                m = U(number)
                to_stretch = slopes[k, m, U(0)]
                to_shear = slopes[k, m, U(1)]
                to_turn = slopes[k, m, U(2)]
                grows = to_stretch * stretch + to_shear * shear + to_turn * turn
                if grows > 0.0:
                    still = to_stretch * still_stretch + to_shear * still_shear + to_turn * still_turn
                    most = allowed[k, m]
                    if number >= bonds:
                        most *= factor_of(strength, c)
                    factor = (most - still) / grows
                    if factor < lowest:
                        lowest = factor
                        which = p
                        limit = number
        least[chunk] = lowest
        where[chunk, 0] = which
        where[chunk, 1] = limit
