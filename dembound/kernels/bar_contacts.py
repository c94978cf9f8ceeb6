"""Contacts between the ranges of a bar: they push, and open where they would have to pull.

A contact has no stiffness. Where two nodes would overlap at the end of a step they get opposite impulses in the middle
of it, so that they just touch then. With the mobilities b = Δt/m of both and an overlap d this takes the force

    P = d / (Δt (b_l + b_r)).

Momentum is conserved. The motion is that of one node with both masses as long as P > 0, so the limit of the time step
is that of the bonded bar. In the ledger a force does work on the mean of the velocities before and after, so an impulse
takes the energy P g/2 with g the gap one step earlier: nothing while the contact remains closed, and
when it closes a part that vanishes with the mass of the nodes.
"""

from numba import njit

from dembound.kernels.common import FAST


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
