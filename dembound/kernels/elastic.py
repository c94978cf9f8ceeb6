"""The history-free elastic law and the step of central differences, fused into one pass over the particles.

Each particle gathers from its own row of contacts, so no two particles write to the same place: the sums come in
the same order, hence with the same bits, for any number of threads. A contact's constants stand once in a small
palette shared by all copies of the brick; a row holds only the neighbour and the palette line (8 bytes).

A palette line (6,) of a contact seen from particle i with neighbour j, unit normal n = (c, s) from i to j or
from j to i (the law is even in n, the arms carry the sign):

    [√k_n c, √k_n s, √(k_s/k_n), √k_s l_i, √k_s l_j, k_r]

so that N = √k_n n·Δu, S = √k_s (t·Δu − l_iθ_i − l_jθ_j), and the force on i is √k_n N n + √k_s S t with the moment
√k_s l_i S + k_r (θ_j − θ_i).
"""

import numpy as np
from numba import njit, prange

U = np.uint64  # unsigned indices spare numba's test for negative ones

FASTMATH = {"contract", "nsz"}
"""Fused multiply-add only: it rounds less and does not depend on threads."""

REST = 1e-250
"""Speeds below this count as rest: they would decay into denormal numbers, which are a hundred times slower."""

CHUNKS = 128
"""Pieces of the particle range handed to the threads; it has no effect on the result."""


@njit(cache=True, fastmath=FASTMATH, error_model="numpy", inline="always")
def _row_force(i, u, start, neighbour, kind, palette):
    """Force (x, y) and moment on particle i from its contacts (Z eqs 7-9; PFC2D linear parallel bond)."""
    x = u[U(0), i]
    y = u[U(1), i]
    turn = u[U(2), i]
    fx = 0.0
    fy = 0.0
    moment = 0.0
    for e in range(start[i], start[i + U(1)]):
        j = U(neighbour[e])
        k = U(kind[e])
        px = palette[k, U(0)]
        py = palette[k, U(1)]
        ratio = palette[k, U(2)]
        arm = palette[k, U(3)]
        turn_j = u[U(2), j]
        dx = u[U(0), j] - x
        dy = u[U(1), j] - y
        N = px * dx + py * dy
        S = ratio * (px * dy - py * dx) - arm * turn - palette[k, U(4)] * turn_j
        T = ratio * S
        fx += px * N - py * T
        fy += py * N + px * T
        moment += arm * S + palette[k, U(5)] * (turn_j - turn)
    return fx, fy, moment


@njit(cache=True, parallel=True, fastmath=FASTMATH, error_model="numpy")
def contact_forces(u, start, neighbour, kind, palette, force):
    """Fill force (3, n) with the contact forces and moments (N, N·m) of displacements and rotations u (3, n)."""
    n = u.shape[1]
    for chunk in prange(CHUNKS):
        for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
            i = U(p)
            force[U(0), i], force[U(1), i], force[U(2), i] = _row_force(i, u, start, neighbour, kind, palette)


@njit(cache=True, fastmath=FASTMATH, error_model="numpy", inline="always")
def _kick(v, f, b, damp):
    """Half-step velocity after a force f, local damping included (Cundall: −damp·|F|·sign(v))."""
    if damp > 0.0:
        f -= damp * abs(f) * np.sign(v)
    w = v + b * f
    return 0.0 if abs(w) <= REST else w  # what is not a number stays so, and is seen


@njit(cache=True, fastmath=FASTMATH, error_model="numpy")
def _supported(
    u, v, start, neighbour, kind, palette,
    nodes, keep, mobility, stiffness, preload, prescribed, drive, damp, out,
):  # fmt: skip
    """Velocities (k, 3) of the supported nodes half a step on.

    v⁺ = keep·v + mobility·(F + F_0 − K u + drive) + prescribed·drive. One linear update covers every boundary: a
    centred dashpot C has keep = (m/Δt − C/2)/(m/Δt + C/2) and mobility 1/(m/Δt + C/2); a prescribed component has
    keep = mobility = 0 and prescribed = 1, its drive being its velocity.
    """
    f = np.empty(3)
    for s in range(nodes.size):
        i = U(nodes[s])
        f[0], f[1], f[2] = _row_force(i, u, start, neighbour, kind, palette)
        for c in range(3):
            total = f[c] + preload[s, c] - stiffness[s, c] * u[U(c), i] + drive[s, c]
            if damp > 0.0:
                total -= damp * abs(total) * np.sign(v[U(c), i])
            w = keep[s, c] * v[U(c), i] + mobility[s, c] * total + prescribed[s, c] * drive[s, c]
            out[s, c] = 0.0 if abs(w) <= REST else w


@njit(cache=True, parallel=True, fastmath=FASTMATH, error_model="numpy")
def advance(
    u, spare, v,
    start, neighbour, kind, palette,
    mobility, inverse_inertia, free, damp, dt,
    nodes, keep, node_mobility, stiffness, preload, prescribed, drive,
    probes, record, tracked, peaks,
):  # fmt: skip
    """Advance by drive.shape[0] steps of central differences, velocities living at half steps.

    u, spare, v : (3, n) displacement now, room for the next one, velocity half a step ago; u holds the result.
    start, neighbour, kind, palette : rows of contacts (see the module's text).
    mobility, inverse_inertia : (n,) Δt/m and Δt/I; free : (3,) 1.0, or 0.0 for a component held everywhere.
    nodes … prescribed : the support table, (k,) and (k, 3); drive : (steps, k, 3) N, m/s where prescribed.
    probes : (p,) particles to record; record : (steps, p, 6) displacement and velocity at the start of each step,
    the velocity as the mean of its two half-step values.
    tracked : (q,) particles; peaks : (q, 3, 2) running smallest and largest velocity.
    """
    n = u.shape[1]
    supported = np.empty((nodes.size, 3))
    here, there = u, spare
    for step in range(drive.shape[0]):
        _supported(
            here, v, start, neighbour, kind, palette,
            nodes, keep, node_mobility, stiffness, preload, prescribed, drive[step], damp, supported,
        )  # fmt: skip
        for p in range(probes.size):
            for c in range(3):
                record[step, p, c] = here[c, probes[p]]
                record[step, p, 3 + c] = 0.5 * v[c, probes[p]]
        for chunk in prange(CHUNKS):
            for p in range(chunk * n // CHUNKS, (chunk + 1) * n // CHUNKS):
                i = U(p)
                fx, fy, moment = _row_force(i, here, start, neighbour, kind, palette)
                v[U(0), i] = _kick(v[U(0), i], fx, free[0] * mobility[i], damp)
                v[U(1), i] = _kick(v[U(1), i], fy, free[1] * mobility[i], damp)
                v[U(2), i] = _kick(v[U(2), i], moment, free[2] * inverse_inertia[i], damp)
                there[U(0), i] = here[U(0), i] + dt * v[U(0), i]
                there[U(1), i] = here[U(1), i] + dt * v[U(1), i]
                there[U(2), i] = here[U(2), i] + dt * v[U(2), i]
        for s in range(nodes.size):
            for c in range(3):
                v[c, nodes[s]] = supported[s, c]
                there[c, nodes[s]] = here[c, nodes[s]] + dt * supported[s, c]
        for p in range(probes.size):
            for c in range(3):
                record[step, p, 3 + c] += 0.5 * v[c, probes[p]]
        for q in range(tracked.size):
            for c in range(3):
                speed = v[c, tracked[q]]
                peaks[q, c, 0] = min(peaks[q, c, 0], speed)
                peaks[q, c, 1] = max(peaks[q, c, 1], speed)
        here, there = there, here
    if drive.shape[0] % 2 == 1:
        u[:] = here
