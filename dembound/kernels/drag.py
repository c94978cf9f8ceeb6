"""Drag on damped disks, −αm(v⁻ + v⁺)/2, by which a step divides by 1 + αΔt/2.

With s = 1/(1 + αΔt/2) a free disk gets v⁺ = (2s − 1)v⁻ + s Δt F/m. The support table moves supported disks with masses
of m/s, so that they get the force −αm v⁻ here. Without drag all functions do nothing, and cost nothing.
"""

from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lane_access import load
from dembound.kernels.compiler.lanes import splat
from dembound.kernels.law import answer, generic
from dembound.kernels.tables import Drag, NoDrag


@generic
def shares(drag, i):
    """The share s of eight disks from slot i on."""


@generic
def share_of(drag, i):
    """The share s of the disk in slot i."""


@generic
def with_drag(drag, i, before, after, was, now):
    """Powers taken from eight disks at their velocities before and after a step, with those of drag.

    was, now : these velocities, of three components.
    """


@generic
def changed_power(drag, c, i, now, change):
    """By how much powers taken from a disk grow, before and after a step, if its new velocity `now` has changed."""


@generic
def note_velocities(drag, v, slots):
    """Note the velocities of disks in these slots (k,) before a step."""


@generic
def pull_supported(drag, slots, v, u_next, nodes):
    """Add drag to the forces on those of the supported nodes (k,) that are in its slots, the first and the end."""


@generic
def work_on_supported(drag, slots, v, nodes, step):
    """Work (J) of drag on these nodes in a step (s), in total and up to the whole step; v : velocities after it."""


@njit(**FAST)
def _shares(drag, i):
    return load(drag.share, i)


@njit(**FAST)
def _one_each(drag, i):
    return splat(1.0)


@njit(**FAST)
def _share_of(drag, i):
    return drag.share[i]


@njit(**FAST)
def _one(drag, i):
    return 1.0


@njit(**FAST)
def _with_drag(drag, i, before, after, was, now):
    half, half_turn = load(drag.half[0], i), load(drag.half[1], i)
    fx, fy, moment = half * (was[0] + now[0]), half * (was[1] + now[1]), half_turn * (was[2] + now[2])
    before += fx * was[0] + fy * was[1] + moment * was[2]
    after += fx * now[0] + fy * now[1] + moment * now[2]
    return before, after


@njit(**FAST)
def _as_they_are(drag, i, before, after, was, now):
    return before, after


@njit(**FAST)
def _changed_power(drag, c, i, now, change):
    grown, was = drag.half[c // U(2), i] * change, drag.before[c, i]
    return grown * was, grown * (was + 2.0 * now - change)


@njit(**FAST)
def _unchanged(drag, c, i, now, change):
    return 0.0, 0.0


@njit(**FAST)
def _note_velocities(drag, v, slots):
    for s in range(slots.size):
        for c in range(3):
            drag.before[c, slots[s]] = v[c, slots[s]]


@njit(**FAST)
def _pull_supported(drag, slots, v, u_next, nodes):
    for s in range(nodes.size):
        i = nodes[s]
        if slots[0] <= i < slots[1]:
            for c in range(3):
                u_next[c, i] -= 2.0 * drag.half[c // 2, i] * v[c, i]


@njit(**FAST)
def _work_on_supported(drag, slots, v, nodes, step):
    whole, half = 0.0, 0.0
    for s in range(nodes.size):
        i = nodes[s]
        if slots[0] <= i < slots[1]:
            for c in range(3):
                was = drag.before[c, i]
                force = 0.5 * step * drag.half[c // 2, i] * (was + v[c, i])
                whole += force * (was + v[c, i])
                half += force * was
    return whole, half


@njit(**FAST)
def _nothing_noted(drag, v, slots):
    pass


@njit(**FAST)
def _no_pull(drag, slots, v, u_next, nodes):
    pass


@njit(**FAST)
def _no_work(drag, slots, v, nodes, step):
    return 0.0, 0.0


for _bundle, _kernels in (
    (Drag, (_shares, _share_of, _with_drag, _changed_power, _note_velocities, _pull_supported, _work_on_supported)),
    (NoDrag, (_one_each, _one, _as_they_are, _unchanged, _nothing_noted, _no_pull, _no_work)),
):
    for _function, _kernel in zip(
        (shares, share_of, with_drag, changed_power, note_velocities, pull_supported, work_on_supported),
        _kernels,
        strict=True,
    ):
        answer(_function, _bundle, _kernel)
