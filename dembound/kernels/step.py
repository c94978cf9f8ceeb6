"""The step of central differences, velocities at half steps: what every law's kernel shares."""

import numpy as np
from numba import njit

from dembound.kernels.common import FASTMATH, REST, U


@njit(cache=True, fastmath=FASTMATH, error_model="numpy", inline="always")
def kick(v, f, b, damp):
    """Half-step velocity after a force f, local damping included (Cundall: −damp·|F|·sign(v))."""
    if damp > 0.0:
        f -= damp * abs(f) * np.sign(v)
    w = v + b * f
    return 0.0 if abs(w) <= REST else w  # what is not a number stays so, and is seen


@njit(cache=True, fastmath=FASTMATH, error_model="numpy", inline="always")
def damping_work(v, w, f, b, damp, step):
    """Work (J) that local damping takes in a step from v to w under a force f: whole, and up to the whole step."""
    taken = damp * abs(f) * np.sign(v) * step
    if b == 0.0:  # supported or held: nothing of it acts here
        taken = 0.0
    return 0.5 * taken * (v + w), 0.5 * taken * v


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def support_velocities(u, v, force, supports, drive, body, out, work):
    """Fill out (k, 3) with the velocities of the supported nodes half a step on; see tables.Supports.

    force (k, 3) are contact forces and steady loads there, drive (k, 3) that of this step. work (2, 4) is advanced.
    """
    nodes, inertia, keep, mobility, stiffness, prescribed, _ = supports
    done = 0.0
    half = 0.0
    damped = 0.0
    damped_half = 0.0
    for s in range(nodes.size):
        i = U(nodes[s])
        for c in range(3):
            before = v[U(c), i]
            total = force[s, c] - stiffness[s, c] * u[U(c), i] + drive[s, c]
            drag = 0.0
            if body.damp > 0.0 and mobility[s, c] > 0.0:
                drag = -body.damp * abs(total) * np.sign(before)
            w = keep[s, c] * before + mobility[s, c] * (total + drag) + prescribed[s, c] * drive[s, c]
            w = 0.0 if abs(w) <= REST else w
            out[s, c] = w
            push = inertia[s, c] * (w - before) - force[s, c] - drag
            done += 0.5 * push * (before + w)
            half += 0.5 * push * before
            damped -= 0.5 * drag * (before + w)
            damped_half -= 0.5 * drag * before
    work[1, 0] = work[0, 0] + body.step * half
    work[1, 1] = work[0, 1] + body.step * damped_half
    work[0, 0] += body.step * done
    work[0, 1] += body.step * damped


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def note_before(step, u, v, log):
    """Write down the probes' displacement and half of their velocity before a step."""
    for p in range(log.probes.size):
        for c in range(3):
            log.record[step, p, c] = u[c, log.probes[p]]
            log.record[step, p, 3 + c] = 0.5 * v[c, log.probes[p]]


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def note_after(step, u, v, spare, supports, supported, body, log):
    """Move the supported nodes, and write down what is only known after a step; spare holds the new displacements."""
    for s in range(supports.nodes.size):
        i = supports.nodes[s]
        for c in range(3):
            v[c, i] = supported[s, c]
            spare[c, i] = u[c, i] + body.step * supported[s, c]
    for p in range(log.probes.size):
        for c in range(3):
            log.record[step, p, 3 + c] += 0.5 * v[c, log.probes[p]]
    for q in range(log.tracked.size):
        for c in range(3):
            speed = v[c, log.tracked[q]]
            log.peaks[q, c, 0] = min(log.peaks[q, c, 0], speed)
            log.peaks[q, c, 1] = max(log.peaks[q, c, 1], speed)
