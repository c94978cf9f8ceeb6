"""Half bonds between particles and the wall of a grid of elements, eight ties of one element at once (lanes.py).

A bond that the side of a body cuts is tied to the wall of the grid beyond: its half next to the particle, twice as
stiff as the bond, ends at the point where both disks touch. There the grid has the motion of the bond's middle,

    w_k = Σ_a N_a U_a,k + Σ_gh c_k,gh ∂U_g/∂h,  k = x, y, rotation (no first term for the rotation),

with U the displacements of the nodes of one element, N their shape functions, and c from the motion of the packing's
disks beyond the mean gradient. The reaction on the nodes is the exact transpose, so a tie takes no energy. Elongations
are those of u + ηv, with velocities v half a step behind: the part with η is a dashpot beside every half bond, which
damps motion that the grid cannot follow.

A particle with a twin in the free-field column is tied by its motion relative to the twin: the grid then has only the
scattered waves.
"""

from typing import Any

from numba import njit, types

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lane_access import load, store
from dembound.kernels.compiler.lanes import LANES, splat
from dembound.kernels.compiler.separate import apart
from dembound.kernels.law import is_tie
from dembound.kernels.tables import Repeats, WallTies

_WITHIN: dict[str, Any] = FAST | {"forceinline": True}
"""Options of functions that are called for each block: passing their arrays would take as long as a few ties."""

_STEP = U(LANES)

VALUE, SLOPE_X, SLOPE_Y = (0, 1), (2, 5), (4, 3)
"""Fields of a block: U_x, U_y, then ∂U_x/∂x, ∂U_y/∂y, ∂U_x/∂y, ∂U_y/∂x; of each component its value and slopes."""


@njit(**_WITHIN)
def _collect(points, within, e, u, v, lag, ties):
    """Fill ties.moved with displacements, plus `lag` (s) times velocities, of the nodes of element e; clear its forces.

    ties.reaction has a lane for each tie of a block. within : first and end column, first and end row of the nodes.
    """
    count = len(points)
    size = count * count
    for b in range(within[2], within[3]):
        for a in range(within[0], within[1]):
            q = b * count + a
            i = U(ties.node[e, q])
            for c in range(2):
                ties.moved[c * size + q] = u[c, i] + lag * v[c, i]
                store(ties.reaction, U(c * size + q) * _STEP, splat(0.0))


@njit(**_WITHIN)
def _see(points, within, block, ties):
    """Fill the fields of a block with the grid's motion at the points of its ties."""
    count = len(points)
    first = U(block) * U(count) * _STEP
    for c in range(2):
        value, slope_x, slope_y = splat(0.0), splat(0.0), splat(0.0)
        for b in range(within[2], within[3]):
            row, slope = splat(0.0), splat(0.0)
            for a in range(within[0], within[1]):
                moved = splat(ties.moved[c * count * count + b * count + a])
                row += load(ties.along, first + U(a) * _STEP) * moved
                slope += load(ties.along_slope, first + U(a) * _STEP) * moved
            up = load(ties.up, first + U(b) * _STEP)
            value += up * row
            slope_x += up * slope
            slope_y += load(ties.up_slope, first + U(b) * _STEP) * row
        store(ties.field, U(VALUE[c]) * _STEP, value)
        store(ties.field, U(SLOPE_X[c]) * _STEP, slope_x)
        store(ties.field, U(SLOPE_Y[c]) * _STEP, slope_y)


@njit(**_WITHIN)
def _react(points, within, block, ties):
    """Add the forces on the nodes of the block's element to ties.reaction, from the conjugate forces in its fields."""
    count = len(points)
    first = U(block) * U(count) * _STEP
    for c in range(2):
        value = load(ties.field, U(VALUE[c]) * _STEP)
        slope_x, slope_y = load(ties.field, U(SLOPE_X[c]) * _STEP), load(ties.field, U(SLOPE_Y[c]) * _STEP)
        for b in range(within[2], within[3]):
            up = load(ties.up, first + U(b) * _STEP)
            row = up * value + load(ties.up_slope, first + U(b) * _STEP) * slope_y
            slope = up * slope_x
            for a in range(within[0], within[1]):
                at = U(c * count * count + b * count + a) * _STEP
                along, steep = load(ties.along, first + U(a) * _STEP), load(ties.along_slope, first + U(a) * _STEP)
                store(ties.reaction, at, load(ties.reaction, at) + along * row + steep * slope)


@njit(**_WITHIN)
def _particles(block, u, v, lag, ties):
    """Fill ties.own (24,) with the motion of the block's particles from rest, relative to twins if they have any."""
    for lane in range(LANES):
        k = U(block) * _STEP + U(lane)
        i, twin = U(ties.particle[k]), ties.twin[k]
        for c in range(3):
            moved = u[c, i] + lag * v[c, i]
            if twin >= 0:
                moved -= u[c, U(twin)] + lag * v[c, U(twin)]
            ties.own[c * LANES + lane] = moved - ties.rest[U(c) * U(ties.arm.size) + k]


@njit(**_WITHIN)
def _corrector(block, component, ties, gradient):
    """Motion of the bonds' middles beyond that of the points: c of one component times the gradients, four lanes."""
    first = U(block) * U(12) * _STEP + U(component) * U(4) * _STEP
    xx, yy, xy, yx = gradient
    along = load(ties.corrector, first) * xx + load(ties.corrector, first + _STEP) * yy
    across = load(ties.corrector, first + U(2) * _STEP) * xy + load(ties.corrector, first + U(3) * _STEP) * yx
    return along + across


@njit(**_WITHIN)
def _pull(block, u, v, lag, ties):
    """Replace a block's fields by their conjugate forces on the grid, and ties.own by the forces on the particles.

    Returns the energy (J) of the ties in lanes.
    """
    _particles(block, u, v, lag, ties)
    field, own = ties.field, ties.own
    gradient = (
        load(field, U(2) * _STEP), load(field, U(3) * _STEP), load(field, U(4) * _STEP), load(field, U(5) * _STEP),
    )  # fmt: skip
    angle = load(own, U(2) * _STEP)
    dx = load(field, U(0)) + _corrector(block, 0, ties, gradient) - load(own, U(0))
    dy = load(field, _STEP) + _corrector(block, 1, ties, gradient) - load(own, _STEP)
    bend = _corrector(block, 2, ties, gradient) - angle
    at = U(block) * _STEP
    size = U(ties.arm.size)
    nx, ny, arm = load(ties.normal, at), load(ties.normal, size + at), load(ties.arm, at)
    opened = nx * dx + ny * dy
    slipped = nx * dy - ny * dx - arm * angle
    pull = load(ties.stiffness, at) * opened
    shear = load(ties.stiffness, size + at) * slipped
    moment = load(ties.stiffness, U(2) * size + at) * bend
    fx = pull * nx - shear * ny
    fy = pull * ny + shear * nx
    store(own, U(0), fx)
    store(own, _STEP, fy)
    store(own, U(2) * _STEP, arm * shear + moment)
    store(field, U(0), splat(0.0) - fx)
    store(field, _STEP, splat(0.0) - fy)
    first = U(block) * U(12) * _STEP
    for g in range(4):
        place = first + U(g) * _STEP
        along, up = load(ties.corrector, place), load(ties.corrector, place + U(4) * _STEP)
        turn = load(ties.corrector, place + U(8) * _STEP)
        store(field, U(2 + g) * _STEP, splat(0.0) - along * fx - up * fy - turn * moment)
    return splat(0.5) * (pull * opened + shear * slipped + moment * bend)


@njit(**_WITHIN)
def _scatter(points, within, e, block, last, ties, force):
    """Add the forces in ties.own to the block's particles, and after the last block those on the element's nodes."""
    for lane in range(LANES):
        s = U(ties.particle_line[U(block) * _STEP + U(lane)])
        for c in range(3):
            force[s, c] += ties.own[c * LANES + lane]
    if last:
        count = len(points)
        for b in range(within[2], within[3]):
            for a in range(within[0], within[1]):
                q = b * count + a
                for c in range(2):
                    total = 0.0
                    for lane in range(LANES):
                        total += ties.reaction[(c * count * count + q) * LANES + lane]
                    force[ties.line[e, q], c] += total


@njit(**_WITHIN)
def _element_forces(points, within, e, u, v, lag, ties, force):
    """Add the forces of the ties of element e, which act on the nodes within these columns and rows."""
    energy = splat(0.0)
    _collect(points, within, e, u, v, lag, ties)
    for block in range(ties.start[e], ties.start[e + 1]):
        _see(points, within, block, ties)
        energy += _pull(block, u, v, lag, ties)
        _react(points, within, block, ties)
        _scatter(points, within, e, block, block == ties.start[e + 1] - 1, ties, force)
    return energy


@apart(types.float64)
@njit(**FAST)
def tie_forces(ties, u, v, force, lag):
    """Add the forces of all ties to force (k, 3), with `lag` as η; returns their energy (J) where η is 0."""
    points = ties.points
    everything = (0, len(points), 0, len(points))  # loops of known length are twice as fast
    energy = splat(0.0)
    for e in range(ties.start.size - 1):
        within = ties.reach[e, 0], ties.reach[e, 1], ties.reach[e, 2], ties.reach[e, 3]
        if within == everything:
            energy += _element_forces(points, everything, e, u, v, lag, ties, force)
        else:
            energy += _element_forces(points, within, e, u, v, lag, ties, force)
    store(ties.own, U(0), energy)
    total = 0.0
    for lane in range(LANES):
        total += ties.own[lane]
    return total


@njit(**FAST)
def wall_forces(ties, u, v, force):
    """Add to force (k, 3) of the supported nodes the forces of the ties; v : (3, n) velocities half a step earlier."""
    tie_forces(ties, u, v, force, ties.lag)


@njit(**FAST)
def repeated_forces(repeats, u, v, force):
    """Repeat forces (k, 3) of earlier ties at some lines on other lines; u, v : (3, n), without effect."""
    for r in range(repeats.source.size):
        for c in range(3):
            force[repeats.target[r], c] += force[repeats.source[r], c]


is_tie(WallTies, across=wall_forces)
is_tie(Repeats, across=repeated_forces)
