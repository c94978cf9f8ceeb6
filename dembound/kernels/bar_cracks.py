"""Contacts between the ranges of a bar, and bonds whose force falls as they open, so that a crack takes its energy."""

import numpy as np
from numba import njit, types

from dembound.kernels.common import FAST
from dembound.kernels.compiler.separate import apart


@njit(**FAST)
def note_approach(v, contacts):
    """Keep the speeds (c,) m/s at which both nodes of each contact approach before the step."""
    for c in range(contacts.left.size):
        i = contacts.left[c]
        contacts.before[c] = v[i] - v[i + 1]


@njit(**FAST)
def close_contacts(u_next, v, mobility, mean, step, contacts):
    """Push apart the nodes of contacts that overlap at their new displacements u_next (n,) m."""
    for c in range(contacts.left.size):
        i = contacts.left[c]
        overlap = u_next[i] - u_next[i + 1] - contacts.gap[c]
        contacts.push[c] = 0.0
        if overlap > 0.0:
            contacts.closed[c] = True
            push = overlap / (step * (mobility[i] + mobility[i + 1]))
            contacts.push[c] = push
            for k, force in ((i, -push), (i + 1, push)):
                gained = mobility[k] * force
                v[k] += gained
                mean[k] += 0.5 * gained
                u_next[k] += step * gained


@njit(**FAST)
def note_impacts(v, step, contacts, work):
    """Add the energy (J) that impulses took in this step to the ledger; v (n,) m/s after it."""
    whole = 0.0
    half = 0.0
    for c in range(contacts.left.size):
        i = contacts.left[c]
        taken = 0.5 * step * contacts.push[c]
        half += taken * contacts.before[c]
        whole += taken * (contacts.before[c] + v[i] - v[i + 1])
    work[1, 2] = work[0, 2] + half
    work[0, 2] += whole


WHOLE, OPENING = -1, -2
"""Marks of an unbroken bond: intact, or with a force that falls. Broken ones are marked with the step of the break."""

TIE = 1e-9
"""Difference up to which elongations over limits are equal."""

ELONGATION, STRETCH, APART, PER_DECADE, SLOWEST, FASTEST = range(6)
"""Columns of the laws of tables.Softening."""


@njit(**FAST)
def stiffness_of(q, e, soft):
    """Stiffness (N/m) of the q-th opening bond at elongation e (m)."""
    far = soft.furthest[q]
    if e < 0.0:
        return soft.whole[q]
    if far >= soft.apart[q]:
        return 0.0
    left = (soft.apart[q] - far) / (soft.apart[q] - soft.limit[q])
    return soft.whole[q] * left * soft.limit[q] / far


@njit(**FAST)
def _change(q, e, before, number, bonds):
    """Adjust the q-th opening bond to elongations e now and `before`, a step earlier; returns the energy (J) taken."""
    soft = bonds.softening
    row, i = soft.row[q], soft.first[q]
    soft.furthest[q] = max(soft.furthest[q], e)
    new = stiffness_of(q, e, soft)
    now = bonds.spring[i] if row < 0 else bonds.bond[row, i]
    if (new < now and e * before >= 0.0) or (new > now and e * before <= 0.0):
        if row < 0:
            bonds.spring[i] = new
        else:
            bonds.bond[row, i] = new
    else:
        new = now
    broken = bonds.spring_broken if row < 0 else bonds.bond_broken[row]
    if soft.furthest[q] >= soft.apart[q] and broken[i] == OPENING:
        broken[i] = number
    return 0.5 * (now - new) * e * before


@njit(**FAST)
def _rate(row, i, e, number, step, soft):
    """Mean strain rate (1/s) of a bond at elongation e (m) since it was last below the share `rise` of its limit."""
    law = soft.laws[soft.part[i]]
    share = e / (max(row + 1, 1) * law[ELONGATION])
    return law[STRETCH] * (share - soft.rise) / (step * max(number - soft.below[row + 1, i], 1))


@njit(**FAST)
def _gain(row, i, e, number, step, soft):
    """Strength of a bond at its present strain rate over that at the slowest one of its law."""
    law = soft.laws[soft.part[i]]
    if law[PER_DECADE] == 0.0:
        return 1.0
    rate = min(max(_rate(row, i, e, number, step, soft), law[SLOWEST]), law[FASTEST])
    return 1.0 + law[PER_DECADE] * np.log10(rate / law[SLOWEST])


@njit(**FAST)
def _watch(u, row, broken, number, soft):
    """Note which bonds of a row are below the share `rise` of their limit in step `number`."""
    p = max(row + 1, 1)
    for i in range(u.size - p):
        if broken[i] == WHOLE:
            if u[i + p] - u[i] < soft.rise * p * soft.laws[soft.part[i], ELONGATION]:
                soft.below[row + 1, i] = number
            elif soft.below[row + 1, i] < 0:
                soft.below[row + 1, i] = number - 1


@njit(**FAST)
def _begin(row, i, e, gain, stiffness, number, step, soft):
    """Add a bond to the opening ones, at elongation e (m) and a factor of its strength at the slowest rate."""
    q, law = soft.listed[0], soft.laws[soft.part[i]]
    soft.row[q], soft.first[q], soft.began[q], soft.whole[q] = row, i, number, stiffness
    soft.limit[q], soft.apart[q] = gain * max(row + 1, 1) * law[ELONGATION], law[APART] / gain
    soft.furthest[q] = soft.limit[q]
    soft.rate[q] = _rate(row, i, e, number, step, soft) if law[PER_DECADE] > 0.0 else 0.0
    soft.listed[0] = q + 1


@njit(**FAST)
def _begin_row(u, row, stiffness, broken, number, step, soft):
    """Let bonds of a row that have reached their limit open.

    Of two neighbouring planes that exceed it equally the left one opens, and unloads the other; one that still exceeds
    its limit a step later opens then. Longer bonds cross the same plane together with their neighbours.
    """
    p = max(row + 1, 1)
    left = 0.0
    for i in range(u.size - p):
        here, e = 0.0, u[i + p] - u[i]
        limit = p * soft.laws[soft.part[i], ELONGATION]
        if e >= limit and broken[i] == WHOLE and stiffness[i] > 0.0:
            here, gain = e / limit, _gain(row, i, e, number, step, soft)
            if here >= gain and (p > 1 or abs(here - left) > TIE):
                _begin(row, i, e, gain, stiffness[i], number, step, soft)
                broken[i] = OPENING
        left = here


@apart(types.float64)
@njit(**FAST)
def soften(number, u, v, step, bonds):
    """Adjust all bonds that open or begin to open in step `number`; returns the energy (J) they take.

    bonds : see tables.BarBonds; u (n,) m now, v (n,) m/s half a step (s) earlier.
    """
    soft = bonds.softening
    if soft.below.size > 0:
        _watch(u, -1, bonds.spring_broken, number, soft)
        for row in range(bonds.bond.shape[0]):
            _watch(u, row, bonds.bond_broken[row], number, soft)
    if bonds.reached[0] > 0:
        _begin_row(u, -1, bonds.spring, bonds.spring_broken, number, step, soft)
        for row in range(bonds.bond.shape[0]):
            _begin_row(u, row, bonds.bond[row], bonds.bond_broken[row], number, step, soft)
    lost = 0.0
    for q in range(soft.listed[0]):
        i, p = soft.first[q], max(soft.row[q] + 1, 1)
        e = u[i + p] - u[i]
        lost += _change(q, e, e - step * (v[i + p] - v[i]), number, bonds)
    return lost
