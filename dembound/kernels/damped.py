"""The elastic law with damping: the forces on every disk pass through memories, see dembound/damping.py.

Disks are moved by damped_rows.py; here are contacts between layers of unlike damping, ties, supported disks and the
ledger.
"""

from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.damped_rows import (
    FADES,
    ONE_STEP,
    REST_OF_SECOND,
    TWO_STEPS,
    fade,
    move_remembering,
    remembered,
)
from dembound.kernels.drag import changed_power, note_velocities, pull_supported, share_of, work_on_supported
from dembound.kernels.elastic import row_force
from dembound.kernels.law import is_law, is_tie
from dembound.kernels.step import note_damping
from dembound.kernels.tables import DampedLinks, TieMemories


@njit(**FAST)
def _slots_of(memories):
    """The first slot of the memories of a part, and the one after its last."""
    first = LANES * memories.block
    return first, first + memories.memory.size // (3 * len(memories.mechanisms))


@njit(**FAST)
def _power_on_supported(memories, v, nodes):
    """Power of the forces taken from supported nodes (k,) at velocities v (3, n)."""
    first, last = _slots_of(memories)
    power = 0.0
    for s in range(nodes.size):
        i = nodes[s]
        if first <= i < last:
            for c in range(3):
                power += memories.force[c, i] * v[c, i]
    return power


@njit(**FAST)
def remember_crossing(crossing, u, v):
    """Fill `taken` with the forces that mechanisms take from those of contacts between layers, and their power."""
    power = 0.0
    for t in range(crossing.target.size):
        i = U(crossing.target[t])
        forces = row_force(
            U(t), U(crossing.owner[t]), u, crossing.start, crossing.neighbour, crossing.contact_type, crossing.constants
        )
        for c in range(3):
            crossing.taken[t, c] = _filtered(crossing, t, c, forces[c] - crossing.rest[t, c])
            power += crossing.taken[t, c] * v[U(c), i]
    crossing.power[0] = power


@njit(**FAST)
def _filtered(memories, t, c, f):
    """The force Σ g t that mechanisms take from component c of the force f on target t."""
    memory, factors = memories.memory, memories.factors
    total = 0.0
    for k in range(factors.shape[2]):
        whole = memory[t, c, k] + f
        memory[t, c, k] = remembered(factors[t, 0, k], whole, f)
        total += factors[t, 1, k] * whole
    return total


@njit(**FAST)
def _take_crossing(memories, v, body, u_next, damped):
    """Subtract the forces taken from contacts between layers: the step of free disks is mended."""
    crossing, force = memories.crossing, memories.force
    after = 0.0
    before = crossing.power[0]
    for t in range(crossing.target.size):
        i = U(crossing.target[t])
        for each in range(3):
            c = U(each)
            r = crossing.taken[t, c]
            if body.mobility[i] > 0.0:
                mobility = body.inverse_inertia[i] if each == 2 else body.mobility[i]
                change = -r * body.free[c] * (mobility * share_of(memories.drag, i))
                v[c, i] += change
                u_next[c, i] += body.step * change
                earlier, later = changed_power(memories.drag, c, i, v[c, i], change)
                before += earlier
                after += r * v[c, i] + force[c, i] * change + later
            else:
                u_next[c, i] -= r
                before -= r * v[c, i]
            force[c, i] += r
    damped[0, 0] += 0.5 * body.step * (before + after)
    damped[0, 1] += 0.5 * body.step * before


@njit(**FAST)
def push(damped, u, u_next, v, number, step, work):
    """Make small memories zero at some steps, see law.push; no bond breaks."""
    damped.memories.ahead.state[1] = number
    if number % FADES == 0:
        fade(damped.memories.memory)
    return 0


@njit(**FAST)
def note(damped, index, u, log):
    """Decide whether to do the next step of early blocks, too; those of which motion is recorded are late."""
    ahead = damped.memories.ahead
    state, early = ahead.state, ahead.early
    if index == 0:
        state[0] = ONE_STEP
        for nodes in (log.probes, log.tracked, log.sides.member):
            for s in range(nodes.size):
                block = nodes[s] // LANES
                if block < early.size:
                    early[block] = 0
    if state[0] == TWO_STEPS:
        state[0] = REST_OF_SECOND
        return
    state[0] = ONE_STEP
    if ahead.lag == 0 or damped.memories.rest.shape[1] > 0:  # at rest under stress loads may rotate at every step
        return
    # memories fade at even steps; the other law that could end a call before the second step, linearpbond, is undamped
    if state[1] % 2 == 0 and index + 1 < log.record.shape[0] and log.top_speed.size == 0:
        state[0] = TWO_STEPS


@njit(**FAST)
def move(damped, u, u_next, v, body, nodes):
    """One step of all disks, see law.move."""
    memories = damped.memories
    note_velocities(memories.drag, v, memories.crossing.target)
    note_velocities(memories.drag, v, nodes)
    remember_crossing(memories.crossing, u, v)
    move_remembering(damped.links.rows, memories, u, v, body, u_next, damped.links.damped)
    _take_crossing(memories, v, body, u_next, damped.links.damped)
    pull_supported(memories.drag, _slots_of(memories), v, u_next, nodes)
    memories.held[0] = 0.5 * body.step * _power_on_supported(memories, v, nodes)


@njit(**FAST)
def finish(damped, v, body, nodes, work):
    """Add the energy taken by damping to the ledger."""
    note_damping(damped.links.damped, work)
    half, memories = damped.memories.held[0], damped.memories
    dragged, before = work_on_supported(memories.drag, _slots_of(memories), v, nodes, body.step)
    work[1, 1] += half + before
    work[0, 1] += half + 0.5 * body.step * _power_on_supported(memories, v, nodes) + dragged


@njit(**FAST)
def remember_ties(ties, u, v, force):
    """Filter the forces of ties in force (k, 3), which other ties have added."""
    for t in range(ties.line.size):
        s = ties.line[t]
        for c in range(3):
            f = force[s, c] - ties.rest[t, c]
            force[s, c] = (f - _filtered(ties, t, c, f)) + ties.rest[t, c]


is_law(DampedLinks, push=push, note=note, move=move, finish=finish)
is_tie(TieMemories, across=remember_ties)
