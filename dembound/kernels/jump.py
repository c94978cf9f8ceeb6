"""The jump between two undisturbed grounds, across the slit of a grid that has the motion relative to either.

Left of the slit a grid has w = u − u_L, right of it w = u − u_R, with u_L and u_R the motion of columns of the ground
at both sides. On the slit the motion u is one, so that w_R = w_L + D with D = u_L − u_R, which is known, as columns do
not depend on the grid; and so is the traction on it, σ(w_R) = σ(w_L) + σ(D). With T_j = ∫ N_j σ(D)·x̂ dy over the slit

    (m_L + m_R) dw_L/dt = F_L + F_R − T − m_R dD/dt

for its nodes, of which there is one for either side. D only depends on y: σ(D)·x̂ = (c12 ∂D_y/∂y + c16 ∂D_x/∂y,
c66 ∂D_x/∂y + c26 ∂D_y/∂y), with derivatives along y stretched in absorbing layers as those of the grid (elements.py),
and with the memories of damped ground (damped_grid.py).

Both nodes are first moved each by itself, under forces that include −T. Their velocities then become those of a
collision that conserves momentum after which they differ by that of D.
"""

from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.damped import FADED
from dembound.kernels.law import is_tie
from dembound.kernels.tables import Jump


@njit(**FAST)
def _apart(jump, n, c, values):
    """D, or its rate, at the n-th node of the slit along c, from displacements or velocities (3, n)."""
    apart = 0.0
    for k in range(jump.left_share.size):
        apart += jump.left_share[k] * values[c, U(jump.left[n, k])]
    for k in range(jump.right_share.size):
        apart -= jump.right_share[k] * values[c, U(jump.right[n, k])]
    return apart


@njit(**FAST)
def _element_traction(jump, e, u, v):
    """Add the traction of element e of the slit at displacements u, with velocities v half a step earlier (3, n)."""
    count = jump.weight.shape[1]
    first = e * (count - 1)
    for j in range(count):
        for c in range(2):
            jump.moved[c, j] = _apart(jump, first + j, c, u) + jump.delay[e, j] * _apart(jump, first + j, c, v)
    for j in range(count):
        for c in range(2):
            slope = 0.0
            for i in range(count):
                slope += jump.slope[e, j, i] * jump.moved[c, i]
            jump.strain_memory[e, j, c] = jump.decay[e, j] * jump.strain_memory[e, j, c] + jump.gain[e, j] * slope
            jump.strain[c] = slope + jump.strain_memory[e, j, c]
        x, y = jump.strain[0], jump.strain[1]
        jump.stress[0] = jump.moduli[e, 2] * y + jump.moduli[e, 4] * x
        jump.stress[1] = jump.moduli[e, 3] * x + jump.moduli[e, 5] * y
        for c in range(2):
            force = jump.weight[e, j] * jump.stress[c]
            total = 0.0
            for k in range(jump.factors.shape[2]):
                part = jump.factors[e, 1, k] * force
                kept = jump.memory[e, j, c, k] + part
                jump.memory[e, j, c, k] = jump.factors[e, 0, k] * kept + (part + FADED) - FADED
                total += kept
            jump.traction[first + j, c] += force - total


@njit(**FAST)
def pull_apart(jump, u, v, force):
    """Subtract from force (k, 3) of the supported nodes left of the slit the traction T, unless that is given."""
    if jump.given > 0:
        return
    for n in range(jump.node.size):
        for c in range(2):
            jump.traction[n, c] = 0.0
    for e in range(jump.weight.shape[0]):
        _element_traction(jump, e, u, v)
    for n in range(jump.first, jump.node.size):
        for c in range(2):
            force[jump.line[n], c] -= jump.traction[n, c]


@njit(**FAST)
def _changed(s, c, i, now, inertia, u_next, v, step, moved, work):
    """Give a supported node, of line s and slot i, the velocity `now` along c after a step, and book the work."""
    change = now - v[c, i]
    before, push = moved[0, c, s], moved[2, c, s]
    more = push + inertia[s, c] * change
    work[0, 0] += 0.5 * step * (more * (before + now) - push * (before + v[c, i]))
    work[1, 0] += 0.5 * step * (more - push) * before
    moved[1, c, s] = now
    moved[2, c, s] = more
    v[c, i] = now
    u_next[c, i] += step * change


@njit(**FAST)
def join_sides(jump, u_next, v, step, inertia, moved, work):
    """Join the nodes of both sides of the slit after a step, see `law.join`."""
    for n in range(jump.first, jump.node.size):
        own, copy = jump.line[n], jump.copy_line[n]
        i, j = U(jump.node[n]), U(jump.copy[n])
        for c in range(2):
            apart = v[2, i if c == 0 else j] if jump.given > 0 else _apart(jump, n, c, v)
            heavy, light = inertia[own, c], inertia[copy, c]
            now = (heavy * v[c, i] + light * (v[c, j] - apart)) / (heavy + light)
            _changed(own, c, i, now, inertia, u_next, v, step, moved, work)
            _changed(copy, c, j, now + apart, inertia, u_next, v, step, moved, work)


is_tie(Jump, across=pull_apart, join=join_sides)
