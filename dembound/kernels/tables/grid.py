"""Arrays of a grid of spectral elements, and of memories of forces by which ground is damped."""

from typing import NamedTuple

import numpy as np

from dembound.kernels.tables.laws import Links


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
    """The absorbing layer in the last blocks, L of them; see continuum/layer.py.

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


class Crossing(NamedTuple):
    """Memories of the forces of contacts between layers of unlike damping, on t targets.

    target : (t,) slot of the disk on which contacts start[t]:start[t + 1] act, see tables.NeighbourTable. owner : (t,)
    slot of the disk that has these contacts, across a seam its twin. factors : (t, 2, K) e and g of the mechanisms of
    the contacts less those of the disk. memory : (t, 3, K) N and N·m. rest (t, 3) forces at rest, which nothing
    remembers; taken (t, 3) and power (1,) W : work space.
    """

    target: np.ndarray
    owner: np.ndarray
    start: np.ndarray
    neighbour: np.ndarray
    contact_type: np.ndarray
    constants: np.ndarray
    factors: np.ndarray
    memory: np.ndarray
    rest: np.ndarray
    taken: np.ndarray
    power: np.ndarray


class NoDrag(NamedTuple):
    """No drag on the disks of a part."""


class Drag(NamedTuple):
    """Drag αm on the disks of a part, of the mean of the velocities before and after a step.

    share : (slots,) 1/(1 + αΔt/2), 1 for supported disks. half : (2, slots) ½αm N·s/m and ½αI N·m·s. before :
    (3, slots) work space, velocities before the step of supported disks and of those with contacts between layers.
    """

    share: np.ndarray
    half: np.ndarray
    before: np.ndarray


class Memories(NamedTuple):
    """Memories of the contact forces of a part, in blocks of eight slots from number `block` on.

    mechanisms : K numbers, only used for their count K, which is known when a kernel is compiled. kind : (blocks,)
    uint32 of the scene, row of each block in factors (kinds·2·K·8,), e, then g of the mechanisms of its disks.
    special : (blocks,) uint8 of the scene, 1 for blocks with supported disks or contacts between layers. memory :
    (n/8·3·K·8,) N and N·m, of each block component by component, of each mechanism by mechanism. rest : (3, slots)
    contact forces at rest, which nothing remembers, or (3, 0) for none. force (3, slots), held (1,), fading (1,) uint8,
    whether small memories become zero in this step : work space. crossing : of contacts between layers. drag : NoDrag,
    or Drag, which is not remembered.
    """

    mechanisms: tuple[float, ...]
    block: int
    kind: np.ndarray
    special: np.ndarray
    factors: np.ndarray
    memory: np.ndarray
    rest: np.ndarray
    force: np.ndarray
    held: np.ndarray
    fading: np.ndarray
    crossing: Crossing
    drag: NoDrag | Drag


class DampedLinks(NamedTuple):
    """The elastic law with memories of forces."""

    links: Links
    memories: Memories


class DampedGrid(NamedTuple):
    """The law of a grid with memories of the forces of its B blocks of elements, by `mechanisms`, K in number.

    factors : (B·2·K·8,) e, then g of the elements of each block. memory : (B·K·2·Q·8,) N, of the forces on the points
    of the elements along x, then y. held (2, core slots) N, power (1,) W : work space, forces on supported core nodes
    and their power before a step.
    """

    grid: Grid
    mechanisms: int
    factors: np.ndarray
    memory: np.ndarray
    held: np.ndarray
    power: np.ndarray


class Jump(NamedTuple):
    """The jump D = u_L − u_R across the slit of a grid, along E elements of N points; see kernels/jump.py.

    Of the nodes on the slit from the bottom up, n = E(N − 1) + 1: left, right : (n, a), (n, b) slots of nodes at
    these heights whose means, with weights left_share (a,) and right_share (b,), move by u_L and u_R less the incident
    motion. node, copy : (n,) slots of the nodes left and right of the slit; line, copy_line :
    (n,) theirs in the support table. first : of the nodes that move; given : 1 where D is known
    otherwise, and dD/dt is the rotation of nodes, along x, and copies, along y.
    slope : (E, N, N) 1/m, d/dy at points. weight : (E, N) m², of the quadrature along y times the thickness. moduli :
    (E, 6) as of `Shape`. decay, gain, delay : (E, N), B, A and τ (s) along y as of `Absorber`. factors : (E, 2, K) e
    and g of K mechanisms. strain_memory : (E, N, 2) ψ of ∂_y D. memory : (E, N, 2, K) N. traction (n, 2) N, moved
    (2, N), strain, stress (2,) : work space.
    """

    left: np.ndarray
    right: np.ndarray
    left_share: np.ndarray
    right_share: np.ndarray
    node: np.ndarray
    copy: np.ndarray
    line: np.ndarray
    copy_line: np.ndarray
    first: int
    given: int
    slope: np.ndarray
    weight: np.ndarray
    moduli: np.ndarray
    decay: np.ndarray
    gain: np.ndarray
    delay: np.ndarray
    factors: np.ndarray
    strain_memory: np.ndarray
    memory: np.ndarray
    traction: np.ndarray
    moved: np.ndarray
    strain: np.ndarray
    stress: np.ndarray


class TieMemories(NamedTuple):
    """Memories of the forces of all ties on t supported nodes.

    line : (t,) of the node in the support table. factors : (t, 2, K) e and g. memory : (t, 3, K) N and N·m. rest : (t,
    3) forces at rest, which nothing remembers.
    """

    line: np.ndarray
    factors: np.ndarray
    memory: np.ndarray
    rest: np.ndarray
