"""The step of central differences, velocities at half steps: functions for the kernels of all laws."""

import numpy as np
from numba import njit

from dembound.kernels.common import CHUNKS, FAST, REST, U, column_sum
from dembound.kernels.compiler.separate import in_chunks


@njit(**FAST, inline="always")
def kick(v, f, b, damp):
    """Half-step velocity after a force f, local damping included (Cundall: −damp·|F|·sign(v))."""
    if damp > 0.0:
        f -= damp * abs(f) * np.sign(v)
    w = v + b * f
    return 0.0 if abs(w) <= REST else w  # nan is kept, so that it is detected


@njit(**FAST, inline="always")
def damping_work(v, w, f, b, damp, step):
    """Work (J) of local damping in a step from v to w under a force f: in total, and up to the whole step."""
    taken = damp * abs(f) * np.sign(v) * step
    if b == 0.0:  # held: no local damping
        taken = 0.0
    return 0.5 * taken * (v + w), 0.5 * taken * v


@njit(**FAST, inline="always")
def move_particle(i, fx, fy, moment, u, v, body, u_next):
    """Move particle i by a step under its contact forces plus steady loads; u_next receives its displacement.

    For a supported particle u_next receives the forces, for `move_supported`. Returns the work (J) of local damping, in
    total and up to the whole step.
    """
    if body.load.shape[1] > 0:
        fx += body.load[U(0), i]
        fy += body.load[U(1), i]
        moment += body.load[U(2), i]
    whole = 0.0
    half = 0.0
    if body.mobility[i] == 0.0:
        u_next[U(0), i] = fx
        u_next[U(1), i] = fy
        u_next[U(2), i] = moment
    else:
        across = body.free[0] * body.mobility[i]
        up = body.free[1] * body.mobility[i]
        about = body.free[2] * body.inverse_inertia[i]
        vx = kick(v[U(0), i], fx, across, body.damp)
        vy = kick(v[U(1), i], fy, up, body.damp)
        spin = kick(v[U(2), i], moment, about, body.damp)
        if body.damp > 0.0:
            for w, c, f, b in ((vx, 0, fx, across), (vy, 1, fy, up), (spin, 2, moment, about)):
                taken, up_to = damping_work(v[U(c), i], w, f, b, body.damp, body.step)
                whole += taken
                half += up_to
        v[U(0), i] = vx
        v[U(1), i] = vy
        v[U(2), i] = spin
        u_next[U(0), i] = u[U(0), i] + body.step * vx
        u_next[U(1), i] = u[U(1), i] + body.step * vy
        u_next[U(2), i] = u[U(2), i] + body.step * spin
    return whole, half


@njit(**FAST)
def clear(values):
    """Set all values (k, m) to zero; an assignment would make numba compile error messages for seconds."""
    for i in range(values.shape[0]):
        for c in range(values.shape[1]):
            values[i, c] = 0.0


@njit(**FAST)
def note_damping(damped, work):
    """Add to work (2, 7) the energy that local damping took from unsupported particles, damped (chunks, 2) J."""
    work[1, 1] += column_sum(damped, 1)
    work[0, 1] += column_sum(damped, 0)


@njit(**FAST)
def note_before(step, u, v, probes, record, twin, followed):
    """Record the probes' displacement and half of their velocity before a step, and half of that of followed twins."""
    for p in range(probes.size):
        for c in range(3):
            record[step, p, c] = u[c, probes[p]]
            record[step, p, 3 + c] = 0.5 * v[c, probes[p]]
    for s in range(twin.size):
        for c in range(3):
            followed[s, c] = 0.5 * v[c, twin[s]] if twin[s] >= 0 else 0.0


@njit(**FAST)
def move_supported(step, u, v, u_next, across, followed, supports, body, work, moved):
    """Move the supported nodes by a step, once all other particles have; u_next contains the new displacements.

    For the supported nodes it contains their contact forces and steady loads before the call. across (k, 3) are the
    forces through seams, whose work counts as that of the outside; followed (k, 3) half the velocity of the nodes'
    twins before the step and receives the mean of that before and after it. work (2, 7) is advanced; moved (3, 3, k)
    receives the velocities before and after the step, and the forces from outside.
    """
    nodes, inertia, keep, mobility = supports.nodes, supports.inertia, supports.keep, supports.mobility
    stiffness, prescribed, twin, follow = supports.stiffness, supports.prescribed, supports.twin, supports.follow
    drive = supports.drive[step]
    done = 0.0
    half = 0.0
    damped = 0.0
    damped_half = 0.0
    for s in range(nodes.size):
        i = U(nodes[s])
        for c in range(3):
            before = v[U(c), i]
            force = u_next[U(c), i]
            total = force + across[s, c] - stiffness[s, c] * u[U(c), i] + drive[s, c]
            drag = 0.0
            if body.damp > 0.0 and mobility[s, c] > 0.0:  # without dashpots, so that it equals that of the twin
                drag = -body.damp * abs(total) * np.sign(before)
            if twin[s] >= 0:
                followed[s, c] += 0.5 * v[U(c), U(twin[s])]
                total += follow[s, c] * followed[s, c]
            w = keep[s, c] * before + mobility[s, c] * (total + drag) + prescribed[s, c] * drive[s, c]
            w = 0.0 if abs(w) <= REST else w
            v[U(c), i] = w
            u_next[U(c), i] = u[U(c), i] + body.step * w
            push = inertia[s, c] * (w - before) - force - drag
            moved[U(0), U(c), s] = before
            moved[U(1), U(c), s] = w
            moved[U(2), U(c), s] = push
            done += 0.5 * push * (before + w)
            half += 0.5 * push * before
            damped -= 0.5 * drag * (before + w)
            damped_half -= 0.5 * drag * before
    work[1, 0] = work[0, 0] + body.step * half
    work[1, 1] = work[0, 1] + body.step * damped_half
    work[0, 0] += body.step * done
    work[0, 1] += body.step * damped


@in_chunks
@njit(**FAST)
def note_top_speeds(begin, end, v, top_speed):
    """Update the largest speeds top_speed (n,) with velocities v (3, n)."""
    n = top_speed.size
    for chunk in range(begin, end):
        for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            i = U(p)
            vx = v[U(0), i]
            vy = v[U(1), i]
            top_speed[i] = max(top_speed[i], np.sqrt(vx * vx + vy * vy))


@njit(**FAST)
def note_after(step, v, probes, record, tracked, peaks):
    """Record the quantities that are known only after a step."""
    for p in range(probes.size):
        for c in range(3):
            record[step, p, 3 + c] += 0.5 * v[c, probes[p]]
    for q in range(tracked.size):
        for c in range(3):
            speed = v[c, tracked[q]]
            peaks[q, c, 0] = min(peaks[q, c, 0], speed)
            peaks[q, c, 1] = max(peaks[q, c, 1], speed)
