"""Bundles of arrays of a grid of spectral elements.

Elements of N × N points are computed in blocks of eight, one in each lane (kernels/lanes.py). An element has (N − 2)²
*core* points, whose nodes are of no other element, and 4(N − 1) *rim* points. Q = N² points and R rim points; points
are numbered row by row, q = N·row + column.
"""

from typing import NamedTuple

import numpy as np


class Elements(NamedTuple):
    """The elements of a grid of S shapes: width, height and medium. Its arrays are those of `Shape`.

    gradient_x, gradient_y, divergence_x, divergence_y : (S, N·N). weight : (S, Q). moduli : (S, 6). core, rim : of all
    elements.
    """

    gradient_x: np.ndarray
    gradient_y: np.ndarray
    divergence_x: np.ndarray
    divergence_y: np.ndarray
    weight: np.ndarray
    moduli: np.ndarray
    core: np.ndarray
    rim: np.ndarray


class Shape(NamedTuple):
    """Data common to the elements of a block.

    gradient_x, gradient_y, divergence_x, divergence_y : (N·N,) matrices, row by row, that make derivatives (1/m) along
    an axis of displacements of a line of points, and nodal forces of fluxes. weight : (Q,) m², of the quadrature.
    moduli : (6,) Pa, c11, c22, c12, c66, c16, c26. core, rim : points of these kinds.
    """

    gradient_x: np.ndarray
    gradient_y: np.ndarray
    divergence_x: np.ndarray
    divergence_y: np.ndarray
    weight: np.ndarray
    moduli: np.ndarray
    core: np.ndarray
    rim: np.ndarray


class Blocks(NamedTuple):
    """B blocks of eight elements and the slots of their nodes; the last `layers` blocks absorb.

    shapes : (B,) int64, which of the S shapes the elements of a block have.
    core_begin : slot of the first core node; block by block, those of each core point are in eight consecutive slots.
    rim_slot : (B·R·8,) slots of the rim nodes, block by block, point by point. In lanes without an element core slots
    have no node, and those of the rim are among them.
    shared_begin : slot of the first node that moves and is of a rim; they are consecutive, the last ones those of
    elements that absorb, from shared_layer on. start : (s + 1,) of each of these s nodes where its entries begin in
    entry (e,), ascending: indices into the forces (B·R·16 doubles, block by block and point by point eight along x and
    eight along y) of the elements it belongs to. entry_layer : the first index of an element that absorbs.
    """

    blocks: int
    layers: int
    shapes: np.ndarray
    core_begin: int
    rim_slot: np.ndarray
    shared_begin: int
    shared_layer: int
    start: np.ndarray
    entry: np.ndarray
    entry_layer: int


ALONG = 4
"""Factor of the axis along a layer in `Absorber.axes`."""


class Absorber(NamedTuple):
    """The absorbing layer in the last blocks, L of them; see outside/layer.py.

    axes : (L,) 1 for blocks whose elements absorb along x, 2 along y, 3 along both, and ALONG times that of an axis
    whose coefficients are those at the points along the other one. decay, gain, delay : (L·2·N·8,)
    B, A and τ (s) at the points of the elements along x, then along y. strain_memory, force_memory : (L·4·Q·8,) ψ of
    ∂_x u_x, ∂_x u_y, ∂_y u_x, ∂_y u_y, and φ of the forces along x and y of the fluxes through sides across x, then y.
    """

    axes: np.ndarray
    decay: np.ndarray
    gain: np.ndarray
    delay: np.ndarray
    strain_memory: np.ndarray
    force_memory: np.ndarray


class Grid(NamedTuple):
    """The law of a grid.

    points : tuple of N numbers, the points along a side on [−1, 1]; N is part of the type, so known when compiled.
    force : (B·R·16,) N, see Blocks; space : (threads, 6·Q·8) work space; taken : (chunks, 4) J of a step, work that
    elements which absorb have taken, by core nodes and by shared nodes: in all, and up to the whole step.
    """

    points: tuple[float, ...]
    elements: Elements
    blocks: Blocks
    absorber: Absorber
    force: np.ndarray
    space: np.ndarray
    taken: np.ndarray
