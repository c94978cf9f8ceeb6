"""Half bonds between particles and the wall of a grid of elements.

A bond that the side of a body cuts is tied to the wall of the grid beyond: its half next to the particle, twice as
stiff as the bond, ends at the point where both disks touch. There the grid has the motion of the bond's middle,

    w_k = Σ_a N_a U_a,k + Σ_gh c_k,gh ∂U_g/∂h,  k = x, y, rotation (no first term for the rotation),

with U the displacements of the nodes of one element, N their shape functions, and c from the motion of the packing's
disks beyond the mean gradient. The reaction on the nodes is the exact transpose, so a tie takes no energy. Elongations
are those of u + ηv, with velocities v half a step behind: the part with η is a dashpot beside every half bond, which
takes out motion that the grid cannot follow.

A particle with a twin in the free-field column is tied by its motion relative to the twin: the grid then has the
scattered waves only.
"""

from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.law import is_tie
from dembound.kernels.tables import WallTies

X, Y, XX, YY, XY, YX = range(6)
"""Rows of the work space: displacements and gradients ∂U_x/∂x, ∂U_y/∂y, ∂U_x/∂y, ∂U_y/∂x, or their conjugate forces."""

VALUE, SLOPE_X, SLOPE_Y = (X, Y), (XX, YX), (XY, YY)
"""The same by component of U."""


@njit(**FAST, forceinline=True)
def _moved(c, i, u, v, lag):
    """Displacement of a node, plus `lag` (s) times its velocity."""
    return u[c, i] + lag * v[c, i]


@njit(**FAST)
def _see(e, c, u, v, lag, ties):
    """Add component c of the grid's motion at the points of the ties of element e to ties.field."""
    value, slope_x, slope_y = VALUE[c], SLOPE_X[c], SLOPE_Y[c]
    first, last = U(ties.start[e]), U(ties.start[e + 1])
    field, row = ties.field, ties.row
    for b in range(ties.up.shape[0]):
        for t in range(first, last):
            row[0, t] = 0.0
            row[1, t] = 0.0
        for a in range(ties.along.shape[0]):
            moved = _moved(c, U(ties.node[e, b, a]), u, v, lag)
            for t in range(first, last):
                row[0, t] += ties.along[a, t] * moved
                row[1, t] += ties.along_slope[a, t] * moved
        for t in range(first, last):
            field[value, t] += ties.up[b, t] * row[0, t]
            field[slope_x, t] += ties.up[b, t] * row[1, t]
            field[slope_y, t] += ties.up_slope[b, t] * row[0, t]


@njit(**FAST)
def _react(e, c, ties, force):
    """Add component c of the forces on the nodes of element e to force (k, 3), from what is conjugate in ties.field."""
    value, slope_x, slope_y = VALUE[c], SLOPE_X[c], SLOPE_Y[c]
    first, last = U(ties.start[e]), U(ties.start[e + 1])
    field, row = ties.field, ties.row
    for b in range(ties.up.shape[0]):
        for t in range(first, last):
            row[0, t] = ties.up[b, t] * field[value, t] + ties.up_slope[b, t] * field[slope_y, t]
            row[1, t] = ties.up[b, t] * field[slope_x, t]
        for a in range(ties.along.shape[0]):
            total = 0.0
            for t in range(first, last):
                total += ties.along[a, t] * row[0, t] + ties.along_slope[a, t] * row[1, t]
            force[ties.line[e, b, a], c] += total


@njit(**FAST)
def _pull(first, last, u, v, lag, ties, force):
    """Add the forces of some ties to force (k, 3) of their particles, given the grid's motion in ties.field (6, t).

    ties.field then contains what is conjugate to it in the forces on the grid. Returns the energy (J) of the ties.
    """
    field, c = ties.field, ties.corrector
    energy = 0.0
    for t in range(first, last):
        i, twin = U(ties.particle[t]), ties.twin[t]
        x = _moved(0, i, u, v, lag)
        y = _moved(1, i, u, v, lag)
        angle = _moved(2, i, u, v, lag)
        if twin >= 0:
            x -= _moved(0, U(twin), u, v, lag)
            y -= _moved(1, U(twin), u, v, lag)
            angle -= _moved(2, U(twin), u, v, lag)
        xx, yy, xy, yx = field[XX, t], field[YY, t], field[XY, t], field[YX, t]
        dx = field[X, t] + c[0, 0, t] * xx + c[0, 1, t] * yy + c[0, 2, t] * xy + c[0, 3, t] * yx - x
        dy = field[Y, t] + c[1, 0, t] * xx + c[1, 1, t] * yy + c[1, 2, t] * xy + c[1, 3, t] * yx - y
        bend = c[2, 0, t] * xx + c[2, 1, t] * yy + c[2, 2, t] * xy + c[2, 3, t] * yx - angle
        nx, ny, arm = ties.normal[0, t], ties.normal[1, t], ties.arm[t]
        open_by = nx * dx + ny * dy
        slip = nx * dy - ny * dx - arm * angle
        pull = ties.stiffness[0, t] * open_by
        shear = ties.stiffness[1, t] * slip
        moment = ties.stiffness[2, t] * bend
        energy += 0.5 * (pull * open_by + shear * slip + moment * bend)
        fx = pull * nx - shear * ny
        fy = pull * ny + shear * nx
        s = ties.particle_line[t]
        force[s, 0] += fx
        force[s, 1] += fy
        force[s, 2] += arm * shear + moment
        field[X, t] = -fx
        field[Y, t] = -fy
        field[XX, t] = -(c[0, 0, t] * fx + c[1, 0, t] * fy + c[2, 0, t] * moment)
        field[YY, t] = -(c[0, 1, t] * fx + c[1, 1, t] * fy + c[2, 1, t] * moment)
        field[XY, t] = -(c[0, 2, t] * fx + c[1, 2, t] * fy + c[2, 2, t] * moment)
        field[YX, t] = -(c[0, 3, t] * fx + c[1, 3, t] * fy + c[2, 3, t] * moment)
    return energy


@njit(**FAST)
def tie_forces(ties, u, v, force, lag):
    """Add the forces of all ties to force (k, 3), with `lag` as η; returns their energy (J) where η is 0."""
    energy = 0.0
    for e in range(ties.start.size - 1):
        first, last = U(ties.start[e]), U(ties.start[e + 1])
        for f in range(6):
            for t in range(first, last):
                ties.field[f, t] = 0.0
        for c in range(2):
            _see(e, c, u, v, lag, ties)
        energy += _pull(first, last, u, v, lag, ties, force)
        for c in range(2):
            _react(e, c, ties, force)
    return energy


@njit(**FAST)
def wall_forces(ties, u, v, force):
    """Add to force (k, 3) of the supported nodes those of the ties; v : (3, n) velocities half a step earlier."""
    tie_forces(ties, u, v, force, ties.lag)


is_tie(WallTies, across=wall_forces)
