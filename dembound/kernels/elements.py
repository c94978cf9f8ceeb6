"""Forces of spectral elements on their nodes, eight elements at once (lanes.py), with and without absorption.

A block has six fields of N × N points in a work space: U and V are displacements along x and y, then A = ∂_x u_x,
B = ∂_x u_y, C = ∂_y u_x and D = ∂_y u_y, of which A, B and D become the stresses σ_xx, σ_xy and σ_yy times the weights
of the quadrature. Nodal forces replace U and V (Komatitsch & Tromp 1999, Geophys. J. Int. 139, 806–822).

In absorbing elements, derivatives along x and y have their own convolution variables (continuum/layer.py), and so have
the nodal forces that belong to derivatives of the test functions along x and y. All elements at a node have the same
coefficients there, so the variable of a nodal force is the sum over its elements.
"""

from typing import Any

from numba import njit

from dembound.kernels.common import FAST, U
from dembound.kernels.compiler.lane_access import combine, combine_more, load, store
from dembound.kernels.compiler.lanes import LANES, larger
from dembound.kernels.tables import ALONG, Shape

WITHIN: dict[str, Any] = FAST | {"forceinline": True}
"""Options of functions that are called for each block: passing their arrays would take as long as a few nodes."""

_STEP = U(LANES)


@njit(**WITHIN)
def shape_of(elements, blocks, block):
    """The shape of the elements of a block."""
    k = U(blocks.shapes[block])
    return Shape(
        elements.gradient_x[k],
        elements.gradient_y[k],
        elements.divergence_x[k],
        elements.divergence_y[k],
        elements.weight[k],
        elements.moduli[k],
        elements.core,
        elements.rim,
    )


@njit(**WITHIN)
def gather(shape, blocks, block, u, space, field):
    """Fill two fields of the work space, from number `field` on, with rows x and y of an array (3, slots)."""
    ux, uy = u[0], u[1]
    size = U(shape.weight.size) * _STEP
    into = U(field) * size
    slot = U(blocks.core_begin) + U(block) * U(shape.core.size) * _STEP
    for p in range(shape.core.size):
        i = into + U(shape.core[p]) * _STEP
        store(space, i, load(ux, slot))
        store(space, i + size, load(uy, slot))
        slot += _STEP
    entry = U(block) * U(shape.rim.size) * _STEP
    for p in range(shape.rim.size):
        i = into + U(shape.rim[p]) * _STEP
        for lane in range(LANES):
            k = U(blocks.rim_slot[entry + U(lane)])
            space[i + U(lane)] = ux[k]
            space[i + size + U(lane)] = uy[k]
        entry += _STEP


@njit(**WITHIN)
def gradients(points, shape, space):
    """A, B, C and D from U and V."""
    size = U(shape.weight.size) * _STEP
    row = U(len(points)) * _STEP
    for line in range(len(points)):
        along_x, along_y = U(line) * row, U(line) * _STEP
        for c in range(2):
            i = U(c) * size
            combine(points, shape.gradient_x, space, i + along_x, space, i + along_x + U(2) * size, _STEP)
            combine(points, shape.gradient_y, space, i + along_y, space, i + along_y + U(4) * size, row)


@njit(**WITHIN)
def stresses(shape, space):
    """Stresses times weights in A, B and D, from the derivatives; the full symmetric plane tensor."""
    size = U(shape.weight.size) * _STEP
    c11, c22, c12, c66, c16, c26 = (
        shape.moduli[0], shape.moduli[1], shape.moduli[2], shape.moduli[3], shape.moduli[4], shape.moduli[5],
    )  # fmt: skip
    for q in range(shape.weight.size):
        i = U(q) * _STEP + U(2) * size
        weight = shape.weight[q]
        xx = weight * load(space, i)
        yy = weight * load(space, i + U(3) * size)
        shear = weight * (load(space, i + size) + load(space, i + U(2) * size))
        store(space, i, c11 * xx + c12 * yy + c16 * shear)
        store(space, i + size, c16 * xx + c26 * yy + c66 * shear)
        store(space, i + U(3) * size, c12 * xx + c22 * yy + c26 * shear)


@njit(**WITHIN)
def forces(points, shape, space):
    """Nodal forces in U and V from the stresses in A, B and D."""
    size = U(shape.weight.size) * _STEP
    row = U(len(points)) * _STEP
    for line in range(len(points)):
        i = U(line) * row
        combine(points, shape.divergence_x, space, i + U(2) * size, space, i, _STEP)
        combine(points, shape.divergence_x, space, i + U(3) * size, space, i + size, _STEP)
    for line in range(len(points)):
        i = U(line) * _STEP
        combine_more(points, shape.divergence_y, space, i + U(3) * size, space, i, row)
        combine_more(points, shape.divergence_y, space, i + U(5) * size, space, i + size, row)


@njit(**WITHIN)
def block_forces(points, shape, blocks, block, u, space):
    """Nodal forces of an elastic block in U and V, at displacements u (3, slots)."""
    gather(shape, blocks, block, u, space, 0)
    gradients(points, shape, space)
    stresses(shape, space)
    forces(points, shape, space)


@njit(**WITHIN)
def _look_back(points, shape, absorber, layer, space):
    """Add to U and V the velocities in A and B times τ, the larger τ of both axes."""
    count = len(points)
    size = U(shape.weight.size) * _STEP
    first = U(layer) * U(2 * count) * _STEP
    for r in range(count):
        along_y = load(absorber.delay, first + U(count + r) * _STEP)
        for c in range(count):
            delay = larger(load(absorber.delay, first + U(c) * _STEP), along_y)
            i = U(r * count + c) * _STEP
            store(space, i, load(space, i) + delay * load(space, i + U(2) * size))
            store(space, i + size, load(space, i + size) + delay * load(space, i + U(3) * size))


@njit(**WITHIN)
def remember(points, shape, absorber, layer, memory, space):
    """Add convolution variables to the fields A and B in blocks that absorb along x, and to C and D along y."""
    count = len(points)
    size = U(shape.weight.size) * _STEP
    axes = absorber.axes[layer]
    for axis in range(2):
        if axes & (1 << axis) == 0:
            continue
        first = (U(2) * U(layer) + U(axis)) * U(count) * _STEP
        by_row = (axis == 1) != (axes & (ALONG << axis) != 0)
        for r in range(count):
            for c in range(count):
                at = first + U(r if by_row else c) * _STEP
                decay, gain = load(absorber.decay, at), load(absorber.gain, at)
                i = U(r * count + c) * _STEP
                for component in range(2):
                    field = U(2 * axis + component)
                    k = (U(4) * U(layer) + field) * size + i
                    place = (U(2) + field) * size + i
                    value = load(space, place)
                    now = decay * load(memory, k) + gain * value
                    store(memory, k, now)
                    store(space, place, value + now)


@njit(**WITHIN)
def _forces_apart(points, shape, space):
    """Nodal forces from the stresses in A, B and D: of derivatives along x in A and B, along y in C and D."""
    size = U(shape.weight.size) * _STEP
    row = U(len(points)) * _STEP
    for line in range(len(points)):
        i = U(line) * _STEP
        combine(points, shape.divergence_y, space, i + U(3) * size, space, i + U(4) * size, row)
        combine(points, shape.divergence_y, space, i + U(5) * size, space, i + U(5) * size, row)
    for line in range(len(points)):
        i = U(line) * row
        combine(points, shape.divergence_x, space, i + U(2) * size, space, i + U(2) * size, _STEP)
        combine(points, shape.divergence_x, space, i + U(3) * size, space, i + U(3) * size, _STEP)


@njit(**WITHIN)
def absorbing_forces(points, shape, blocks, absorber, block, u, v, space):
    """Nodal forces in U and V of a block that absorbs; u, v : (3, slots), velocities half a step earlier."""
    layer = block - (blocks.blocks - blocks.layers)
    gather(shape, blocks, block, u, space, 0)
    gather(shape, blocks, block, v, space, 2)
    _look_back(points, shape, absorber, layer, space)
    gradients(points, shape, space)
    remember(points, shape, absorber, layer, absorber.strain_memory, space)
    stresses(shape, space)
    _forces_apart(points, shape, space)
    remember(points, shape, absorber, layer, absorber.force_memory, space)
    size = U(shape.weight.size) * _STEP
    for q in range(shape.weight.size):
        i = U(q) * _STEP
        store(space, i, load(space, i + U(2) * size) + load(space, i + U(4) * size))
        store(space, i + size, load(space, i + U(3) * size) + load(space, i + U(5) * size))
