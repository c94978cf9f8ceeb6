"""Measures of history-dependent contacts that do not change them: motion left before a limit, and energy."""

import numpy as np
from numba import njit, types

from dembound.kernels.common import CHUNKS, FAST, MAKES, U, column_sum, largest
from dembound.kernels.compiler.limits import factor_of
from dembound.kernels.compiler.separate import apart, in_chunks
from dembound.kernels.compiler.start_strain import began_with
from dembound.kernels.contacts import BONDED, INTACT, REFERENCE, UPDATED
from dembound.kernels.pair_law import acts, bond_energy, bond_room, contact_energy, contact_room, rolling, rolls
from dembound.kernels.pair_strain import pair, reference_strain, updated_stretch
from dembound.pairwise import P

TURN = 0.01
"""Largest rotation of a pair under the law of small displacements, whose error is half its square."""


@apart(types.float64)
@njit(**MAKES)
def slack(u, contacts, limits, keeps_slip):
    """Least relative motion (m) of two surfaces after which a pair leaves the elastic law; negative after it has left.

    A pair leaves it where a contact that has a stiffness opens, closes or slides, a bond reaches its strength, or, if
    geometry follows the motion, it has turned by TURN. Stretch, shear and R̄ times the relative rotation change by no
    more than the relative motion of the surfaces, which gives a lower bound for each condition. keeps_slip : contacts
    have slid earlier.
    """
    closest = np.empty(CHUNKS)
    _closest(u, contacts, limits, keeps_slip, closest)
    return -largest(closest)


@in_chunks
@njit(**FAST)
def _closest(begin, end, u, contacts, limits, keeps_slip, closest):
    """Fill closest (chunks,) with the least `slack` of each chunk of pairs, negative."""
    first, second, contact_type = contacts.first, contacts.second, contacts.contact_type
    constants, began, state, slip = contacts.constants, contacts.began, contacts.state, contacts.slip
    geometry = limits.geometry
    b = first.size
    for chunk in range(begin, end):
        room = np.inf
        for p in range(chunk * b // CHUNKS, (chunk + 1) * b // CHUNKS):
            c = U(p)
            i, j, k, dx, dy = pair(c, u, first, second, contact_type, constants)
            nx, ny, distance, stretch, shear = reference_strain(i, j, k, dx, dy, u, constants, began)
            if geometry == UPDATED:
                room = min(room, TURN * distance - abs(nx * dy - ny * dx))
            overlap = constants[k, P.touch] - constants[k, P.rest] - stretch
            if not acts(limits, constants, k):
                pass
            elif constants[k, P.touch] >= distance:
                stuck = shear - slip[c] if keeps_slip else shear
                room = min(room, contact_room(limits, constants, k, k, overlap, stuck))
            else:
                room = min(room, -overlap)
            if state[c] == INTACT:
                turn = u[U(2), j] - u[U(2), i] + began_with(began, k, U(2))
                room = min(room, bond_room(limits, constants, k, k, factor_of(limits.factor, c), stretch, shear, turn))
        closest[chunk] = -room


@njit(**MAKES)
def strain_energy(u, contacts, limits):
    """Energy (J) stored in contacts and in bonds at displacements u (3, n), with shear and slip of the last push.

    With the geometry REFERENCE shear and slip are not read.
    """
    stored = np.empty((CHUNKS, 2))
    _strain_energies(u, contacts, limits, stored)
    return column_sum(stored, 0), column_sum(stored, 1)


@in_chunks
@njit(**FAST)
def _strain_energies(begin, end, u, contacts, limits, stored):
    """Fill stored (chunks, 2) with the `strain_energy` of contacts and of bonds in each chunk of pairs."""
    first, second, contact_type = contacts.first, contacts.second, contacts.contact_type
    constants, began, state = contacts.constants, contacts.began, contacts.state
    all_shear, slip, geometry = contacts.shear, contacts.slip, limits.geometry
    bound = contacts.bound
    in_rows = bound[0]
    for chunk in range(begin, end):
        in_contacts = 0.0
        in_bonds = 0.0
        first_in_rows = chunk * in_rows // CHUNKS
        count = (chunk + 1) * in_rows // CHUNKS - first_in_rows
        for p in range(count + bound[chunk + 1] - bound[chunk]):
            c = U(first_in_rows + p) if p < count else U(bound[chunk] + p - count)
            i, j, k, dx, dy = pair(c, u, first, second, contact_type, constants)
            intact = state[c] == INTACT
            if geometry >= REFERENCE or (geometry == BONDED and intact):
                _, _, _, stretch, shear = reference_strain(i, j, k, dx, dy, u, constants, began)
            else:
                _, _, _, stretch = updated_stretch(k, dx, dy, constants, began)
                shear = all_shear[c]
            overlap = constants[k, P.touch] - constants[k, P.rest] - stretch
            slid = shear
            if constants[k, P.touch] < constants[k, P.rest] and overlap <= 0.0:  # open, as at the start
                overlap = 0.0
                slid = 0.0
            elif geometry != REFERENCE:
                overlap = max(overlap, 0.0)
                slid -= slip[c]
            in_contacts += contact_energy(limits, constants, k, overlap, slid)
            if intact:
                turn = u[U(2), j] - u[U(2), i] + began_with(began, k, U(2))
                in_bonds += bond_energy(limits, constants, k, stretch, shear, turn)
            elif rolls(limits):
                in_contacts += 0.5 * rolling(limits, constants, k)[0] * contacts.rolled[c] ** 2
        stored[chunk, 0] = in_contacts
        stored[chunk, 1] = in_bonds
