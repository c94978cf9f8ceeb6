"""Arrays of memories of forces: of disks, and of the forces of ties. K mechanisms, n slots of a part."""

from typing import NamedTuple

import numpy as np

from dembound.kernels.tables.grid import Grid
from dembound.kernels.tables.laws import Links


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

    layer : (slots,) uint8, row of each disk in factors (layers, 2, K), e and g of the mechanisms. special : (blocks,)
    uint8 of the scene, 1 for blocks with supported disks or contacts between layers, 2 more for those with disks of
    several layers. memory : (3K, n) N and N·m, component by component. rest : (3, slots) contact forces at rest, which
    nothing remembers, or (3, 0) for none. force (3, slots), held (1,) : work space. crossing : of contacts between
    layers. drag : NoDrag, or Drag, which is not remembered.
    """

    block: int
    layer: np.ndarray
    special: np.ndarray
    factors: np.ndarray
    memory: np.ndarray
    rest: np.ndarray
    force: np.ndarray
    held: np.ndarray
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


class TieMemories(NamedTuple):
    """Memories of the forces of all ties on t supported nodes.

    line : (t,) of the node in the support table. factors : (t, 2, K) e and g. memory : (t, 3, K) N and N·m. rest : (t,
    3) forces at rest, which nothing remembers.
    """

    line: np.ndarray
    factors: np.ndarray
    memory: np.ndarray
    rest: np.ndarray
