"""A bar of nodes: local springs and peridynamic bonds, and the step of central differences.

The force on node i of a bar is (L eq. 8 and its finite difference counterpart, eq. 17)

    Σ_p k_{i,p} (u_{i+p} − u_i) − k_{i−p,p} (u_i − u_{i−p}),  p = 0 … m

where p = 0 means the local springs between neighbours. Springs and bonds are stored in rows by index offset, so every
loop reads contiguous numbers, without lists of families. Runs of nodes that have only unbroken, equal local springs are
`plain`: they are moved by one stencil with constants. A bar is the only part of its scene: its kernels take all nodes.
"""

import numpy as np
from numba import njit, types

from dembound.kernels.bar_cracks import close_contacts, note_approach, note_impacts, soften
from dembound.kernels.common import DONE, FAST, FASTMATH, REST, TRIGGERED, U
from dembound.kernels.compiler.separate import apart
from dembound.kernels.law import is_law
from dembound.kernels.tables import BarBonds


@njit(**FAST)
def _plain_reached(u, a, b, limit):
    """Number of springs at nodes a to b − 1 whose elongation has reached the limit (m)."""
    reached = 0
    for i in range(U(a), U(b + 1)):
        reached += u[i] - u[i - U(1)] >= limit
    return reached


@njit(**FAST)
def _move_plain(u, v, a, b, stiffness, step, u_next):
    """One step of nodes a to b − 1 between equal springs; stiffness: Δt k/m."""
    one = U(1)
    for i in range(U(a), U(b)):
        w = v[i] + stiffness * ((u[i + one] - u[i]) - (u[i] - u[i - one]))
        w = 0.0 if abs(w) <= REST else w
        v[i] = w
        u_next[i] = u[i] + step * w


@njit(**FAST)
def _move_plain_dragged(u, v, a, b, stiffness, keep, step, u_next, mean):
    """One step of nodes a to b − 1 between equal springs under attenuation, see `_move_plain`.

    mean (n,) gets the means of the velocities half a step before and after.
    """
    one = U(1)
    for i in range(U(a), U(b)):
        w = keep * v[i] + stiffness * ((u[i + one] - u[i]) - (u[i] - u[i - one]))
        w = 0.0 if abs(w) <= REST else w
        mean[i] = 0.5 * (v[i] + w)
        v[i] = w
        u_next[i] = u[i] + step * w


@njit(**FAST)
def _spring_forces(u, a, b, spring, limit, space, force):
    """Fill the forces (N) of local springs on nodes a to b − 1; returns the number of springs at their limit."""
    one, last = U(1), u.size - 1
    reached = 0
    for k in range(U(max(a - 1, 0)), U(min(b, last))):
        e = u[k + one] - u[k]
        reached += (e >= limit[k]) & (spring[k] > 0.0)
        space[k + one] = spring[k] * e
    if a == 0:
        space[0] = 0.0
    if b > last:
        space[b] = 0.0
    for i in range(U(a), U(b)):
        force[i] = space[i + one] - space[i]
    return reached


@njit(**FAST)
def _add_bond_forces(u, a, b, p, bond, limit, space, force):
    """Add the forces (N) of the bonds of one length among nodes a to b − 1; returns how many reach the limit."""
    m, row = U(bond.shape[0]), U(p - 1)
    p = U(p)
    reached = 0
    for i in range(U(a), U(b) - p):
        e = u[i + p] - u[i]
        reached += (e >= limit) & (bond[row, i] > 0.0)
        space[i + m] = bond[row, i] * e
    for i in range(p):  # no bonds begin before the first node or extend beyond the last
        space[U(a) + m - p + i] = 0.0
        space[U(b) + m - p + i] = 0.0
    for i in range(U(a), U(b)):
        force[i] += space[i + m] - space[i + (m - p)]
    return reached


@njit(**FAST)
def forces(u, bonds, force):
    """Fill force (n,) N for the nodes that are not plain; returns the number of springs and bonds at their limit."""
    mixed, zones, space = bonds.mixed, bonds.zones, bonds.space
    reached = 0
    for r in range(mixed.shape[0]):
        a, b = mixed[r, 0], mixed[r, 1]
        if mixed[r, 2]:
            reached += _spring_forces(u, a, b, bonds.spring, bonds.spring_limit, space, force)
        else:
            for i in range(U(a), U(b)):
                force[i] = 0.0
    for z in range(zones.shape[0]):
        a, b = zones[z, 0], zones[z, 1]
        for p in range(1, min(bonds.bond.shape[0], b - a - 1) + 1):
            reached += _add_bond_forces(u, a, b, p, bonds.bond, bonds.bond_limit[z, p - 1], space, force)
    return reached


@njit(**FAST)
def _plain_triggers(u, plain, limit):
    """Whether a spring at a plain node has reached its limit, (r,) m."""
    reached = 0
    for r in range(plain.shape[0]):
        if limit[r] < np.inf:
            reached += _plain_reached(u, plain[r, 0], plain[r, 1], limit[r])
    return reached > 0


@njit(**FAST)
def _triggers(u, bonds):
    """Whether one of the other springs has reached a limit at which the method is called."""
    for k in range(bonds.spring.size):
        if bonds.triggers[k] and bonds.spring[k] > 0.0 and u[k + 1] - u[k] >= bonds.spring_limit[k]:
            return True
    return False


@apart(types.float64)
@njit(**FAST)
def break_at_limit(number, u, v, step, bonds):
    """Break all springs and bonds at their limit for good (L eq. 6), in step `number`; returns their energy (J).

    For a spring k with elongation e now and e⁻ one step earlier this is ½k e⁻e, which closes the energy balance
    exactly. It is negative only if the elongation of a bond changes its sign within a step.
    """
    lost = 0.0
    for k in range(bonds.spring.size):
        e = u[k + 1] - u[k]
        if bonds.spring[k] > 0.0 and e >= bonds.spring_limit[k]:
            lost += 0.5 * bonds.spring[k] * e * (e - step * (v[k + 1] - v[k]))
            bonds.spring[k] = 0.0
            bonds.spring_broken[k] = number
    for row in range(bonds.bond.shape[0]):
        for z in range(bonds.zones.shape[0]):
            for i in range(bonds.zones[z, 0], bonds.zones[z, 1] - row - 1):
                e = u[i + row + 1] - u[i]
                if bonds.bond[row, i] > 0.0 and e >= bonds.bond_limit[z, row]:
                    lost += 0.5 * bonds.bond[row, i] * e * (e - step * (v[i + row + 1] - v[i]))
                    bonds.bond[row, i] = 0.0
                    bonds.bond_broken[row, i] = number
    return lost


@njit(**FAST)
def plane_force(k, u, bonds):
    """Force (N, tension positive) of all springs and bonds across plane k, between nodes k and k + 1."""
    total = bonds.spring[k] * (u[k + 1] - u[k])
    for row in range(bonds.bond.shape[0]):
        p = row + 1
        for i in range(max(0, k - row), min(k, u.size - 1 - p) + 1):
            total += bonds.bond[row, i] * (u[i + p] - u[i])
    if bonds.through.size > 0:
        total += bonds.through[k]
    return total


@njit(**FAST)
def node_stress(i, u, bonds):
    """Stress (Pa, tension positive) at node i: the mean over both adjacent planes, or at an end the single plane.

    Between planes of different sections it is the mean force over the mean section.
    """
    total = 0.0
    section = 0.0
    if i > 0:
        total += plane_force(i - 1, u, bonds)
        section += bonds.sections[i - 1]
    if i < u.size - 1:
        total += plane_force(i, u, bonds)
        section += bonds.sections[i]
    return total / section


@njit(**FAST)
def stresses(u, bonds, stress):
    """Fill stress (n,) Pa of all nodes, see `node_stress`."""
    for i in range(u.size):
        stress[i] = node_stress(i, u, bonds)


@njit(**FAST)
def stored(u, bonds):
    """Strain energy (J) in springs and in bonds at displacements u (n,) m."""
    springs = 0.0
    for k in range(bonds.spring.size):
        springs += 0.5 * bonds.spring[k] * (u[k + 1] - u[k]) ** 2
    peridynamic = 0.0
    for row in range(bonds.bond.shape[0]):
        for i in range(u.size - row - 1):
            peridynamic += 0.5 * bonds.bond[row, i] * (u[i + row + 1] - u[i]) ** 2
    return springs, peridynamic


@njit(**FAST)
def _move_mixed(u, v, a, b, mobility, keep, step, u_next, mean):
    """One step of nodes a to b − 1 with their forces in u_next (n,), which gets their new displacements."""
    for i in range(U(a), U(b)):
        w = keep * v[i] + mobility[i] * u_next[i]
        w = 0.0 if abs(w) <= REST else w
        mean[i] = 0.5 * (v[i] + w)
        v[i] = w
        u_next[i] = u[i] + step * w


@njit(**FAST)
def _move_unsupported(u, v, bonds, step, u_next, nodes):
    """One step of all nodes except the supported ones (k,)."""
    plain, mixed, mobility, mean = bonds.plain, bonds.mixed, bonds.mobility, bonds.mean
    for r in range(plain.shape[0]):
        a, b, push, keep = plain[r, 0], plain[r, 1], bonds.plain_push[r], bonds.plain_keep[r]
        if bonds.drag.size > 0:
            _move_plain_dragged(u, v, a, b, push, keep, step, u_next, mean)
        else:
            _move_plain(u, v, a, b, push, step, u_next)
    for r in range(mixed.shape[0]):
        first, b, keep = mixed[r, 0], mixed[r, 1], bonds.mixed_keep[r]
        for s in range(nodes.size):
            if first <= nodes[s] < b:
                _move_mixed(u, v, first, nodes[s], mobility, keep, step, u_next, mean)
                first = nodes[s] + 1
        _move_mixed(u, v, first, b, mobility, keep, step, u_next, mean)


@njit(cache=True, fastmath=FASTMATH | {"reassoc"}, error_model="numpy")
def _drag_work(mean, v, drag):
    """Power (J/s) of dashpots drag (n,) N·s/m on mean velocities: in a step, and from its middle to its end."""
    whole = 0.0
    late = 0.0
    for i in range(mean.size):
        whole += drag[i] * mean[i] * mean[i]
        late += drag[i] * mean[i] * v[i]
    return whole, 0.5 * late


@njit(**FAST)
def _note_drag(v, mean, before, nodes, drag, step, work):
    """Add the energy taken by attenuation to the ledger; for supported nodes it is part of the work from outside."""
    for s in range(nodes.size):
        i = nodes[s]
        mean[i] = 0.5 * (before[s] + v[i])
        taken = drag[i] * mean[i] * step
        work[0, 0] += taken * mean[i]
        work[1, 0] += taken * 0.5 * before[s]
    whole, late = _drag_work(mean, v, drag)
    work[1, 1] += step * (whole - late)
    work[0, 1] += step * whole


@njit(**FAST)
def check(bonds, u, u_next, v):
    """Whether a spring has reached a limit at which the method is called; stores the forces in u_next.

    bonds : see tables.BarBonds; of u, u_next and v, which have three rows, a bar uses the first.
    """
    x = u[0]
    bonds.reached[0] = forces(x, bonds, u_next[0])
    if _plain_triggers(x, bonds.plain, bonds.plain_limit):
        return TRIGGERED
    return TRIGGERED if bonds.reached[0] > 0 and _triggers(x, bonds) else DONE


@njit(**FAST)
def push(bonds, u, u_next, v, number, step, work):
    """Break springs and bonds at their limit, or let them open; store the forces of the others in u_next."""
    soft, reached = bonds.softening, bonds.reached[0] > 0
    if reached or soft.listed[0] > 0 or soft.below.size > 0:
        if soft.row.size > 0:
            work[0, 3] += soften(number, u[0], v[0], step, bonds)
        else:
            work[0, 3] += break_at_limit(number, u[0], v[0], step, bonds)
        work[1, 3] = work[0, 3]
        forces(u[0], bonds, u_next[0])
    return 0


@njit(**FAST)
def note(bonds, index, u, log):
    """Record the stress (Pa) at the probes, in the seventh column."""
    for q in range(log.probes.size):
        log.record[index, q, 6] = node_stress(log.probes[q], u[0], bonds)


@njit(**FAST)
def move(bonds, u, u_next, v, body, nodes):
    """One step of all nodes except the supported ones."""
    w, before = v[0], bonds.before
    for s in range(nodes.size):
        before[s] = w[nodes[s]]
    note_approach(w, bonds.contacts)
    _move_unsupported(u[0], w, bonds, body.step, u_next[0], nodes)
    close_contacts(u_next[0], w, bonds.mobility, bonds.mean, body.step, bonds.contacts)


@njit(**FAST)
def finish(bonds, v, body, nodes, work):
    """Add the energy taken by attenuation and by impacts to the ledger."""
    if bonds.contacts.left.size > 0:
        note_impacts(v[0], body.step, bonds.contacts, work)
    if bonds.drag.size > 0:
        _note_drag(v[0], bonds.mean, bonds.before, nodes, bonds.drag, body.step, work)


is_law(BarBonds, check=check, push=push, note=note, move=move, finish=finish)
