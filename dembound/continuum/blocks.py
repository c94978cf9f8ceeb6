"""Blocks of eight elements for the kernels, and the slots of their nodes."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.continuum.layer import Absorption, Profile
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Mesh
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.tables import ALONG, Absorber, Blocks, Elements
from dembound.motion.state import aligned_zeros

NO_ELEMENT = -1

Profiles = Sequence[tuple[Profile | None, Profile | None]]
"""Along x and y: the absorbing layers before and after; None: there is none."""


@dataclass(frozen=True, eq=False)
class ElementBlocks:
    """The elements of a mesh in blocks: first all elastic ones, then those that absorb along x, y, and both.

    Within each kind they are sorted by shape and medium.

    Attributes
    ----------
    mesh : the elements.
    begin : slot of the first node; a multiple of eight is fastest.
    medium : (E,) number of the medium of every element; None: all have one.
    """

    mesh: Mesh
    begin: int = 0
    medium: np.ndarray | None = None

    @cached_property
    def _kinds(self) -> np.ndarray:
        """(E,) 0 for an elastic element, 1, 2 or 3 for one that absorbs along x, y, or both."""
        return self.mesh.absorbs @ np.array([1, 2])

    @cached_property
    def _patterns(self) -> tuple[np.ndarray, np.ndarray]:
        """The different shapes and media of elements, (S, 2) ascending numbers, and the number (E,) of each one's."""
        shape = self.mesh.element_shape
        medium = np.zeros_like(shape) if self.medium is None else self.medium
        patterns, each = np.unique(np.stack([shape, medium], axis=1), axis=0, return_inverse=True)
        return patterns, each.ravel()

    @property
    def sizes(self) -> np.ndarray:
        """(S, 2) widths and heights of the different elements, m."""
        return self.mesh.shapes[self._patterns[0][:, 0]]

    @property
    def media(self) -> np.ndarray:
        """(S,) number of the medium of the different elements."""
        return self._patterns[0][:, 1]

    @cached_property
    def elements(self) -> np.ndarray:
        """Elements (B, 8) of every block, −1 for none; all of one block have the same kind, shape and medium."""
        blocks = []
        patterns, pattern = self._patterns
        for kind, number in np.ndindex(4, len(patterns)):
            members = np.flatnonzero((self._kinds == kind) & (pattern == number))
            padded = np.full(-(-len(members) // LANES) * LANES, NO_ELEMENT)
            padded[: len(members)] = members
            blocks.append(padded.reshape(-1, LANES))
        return np.concatenate(blocks)

    @cached_property
    def kinds(self) -> np.ndarray:
        """(B,) the kind of every block."""
        return self._kinds[self.elements[:, 0]]

    @property
    def layers(self) -> int:
        """Number of blocks that absorb; they are the last."""
        return int(np.count_nonzero(self.kinds))

    @cached_property
    def core(self) -> np.ndarray:
        """The points inside an element."""
        return np.arange((self.mesh.order + 1) ** 2).reshape((self.mesh.order + 1,) * 2)[1:-1, 1:-1].ravel()

    @cached_property
    def rim(self) -> np.ndarray:
        """The points on its edges."""
        return np.setdiff1d(np.arange((self.mesh.order + 1) ** 2), self.core)

    @cached_property
    def _nodes(self) -> np.ndarray:
        """(B, Q, 8) the nodes of every block, −1 in lanes without an element."""
        flat = self.mesh.nodes.reshape(len(self.mesh.nodes), -1)
        nodes = np.where(self.elements[:, :, None] == NO_ELEMENT, -1, flat[self.elements])
        return np.ascontiguousarray(nodes.transpose(0, 2, 1))

    @cached_property
    def _shared(self) -> tuple[np.ndarray, int]:
        """The nodes (s,) of rims that move, and how many of them belong to elastic elements only; these come first.

        Both groups are sorted by the number of elements of a node.
        """
        count = np.zeros(self.mesh.count, dtype=np.int64)
        absorbing = np.zeros(self.mesh.count, dtype=np.bool_)
        rims = self._nodes[:, self.rim]
        np.add.at(count, rims[rims >= 0], 1)
        of_layers = rims[self.kinds > 0]
        absorbing[of_layers[of_layers >= 0]] = True
        shared = np.flatnonzero((count > 0) & ~self.mesh.held)
        order = np.lexsort((shared, count[shared], absorbing[shared]))
        return shared[order], int(np.count_nonzero(~absorbing[shared]))

    @property
    def shared_begin(self) -> int:
        """Slot of the first shared node."""
        return self.begin + len(self.elements) * len(self.core) * LANES

    @cached_property
    def slot(self) -> np.ndarray:
        """(n,) the slot of every node: core nodes block by block, then shared nodes, then those at rest."""
        slot = np.empty(self.mesh.count, dtype=np.int64)
        core = self._nodes[:, self.core].ravel()
        slot[core[core >= 0]] = self.begin + np.flatnonzero(core >= 0)
        others = np.concatenate([self._shared[0], np.flatnonzero(self.mesh.held)])
        slot[others] = self.shared_begin + np.arange(len(others))
        return slot

    @property
    def end(self) -> int:
        """The slot after the last one."""
        return self.shared_begin + len(self._shared[0]) + int(np.count_nonzero(self.mesh.held))

    @cached_property
    def bundle(self) -> Blocks:
        """The arrays for the kernels."""
        nodes = self._nodes[:, self.rim]
        unused = self.begin + LANES * len(self.core) * np.arange(len(nodes))[:, None, None] + np.arange(LANES)
        shared, elastic = self._shared
        start, entry = self._entries(nodes, shared)
        return Blocks(
            blocks=len(nodes),
            layers=self.layers,
            shapes=self._patterns[1][self.elements[:, 0]],
            core_begin=self.begin,
            rim_slot=np.where(nodes < 0, unused, self.slot[nodes]).astype(np.uint32).ravel(),
            shared_begin=self.shared_begin,
            shared_layer=self.shared_begin + elastic,
            start=start,
            entry=entry,
            entry_layer=2 * (len(nodes) - self.layers) * nodes[0].size,
        )

    def _entries(self, nodes: np.ndarray, shared: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where the forces on every shared node are stored, see `Blocks`; nodes (B, R, 8) of the rims."""
        place = np.arange(nodes.size).reshape(nodes.shape)
        place = 2 * place - place % LANES  # eight along x, then eight along y
        rank = np.full(self.mesh.count + 1, -1)  # the last one is that of lanes without an element
        rank[shared] = np.arange(len(shared))
        owner = rank[nodes].ravel()
        order = np.argsort(owner, kind="stable")
        order = order[np.count_nonzero(owner < 0) :]
        start = np.searchsorted(owner[order], np.arange(len(shared) + 1))
        return start, place.ravel()[order].astype(np.uint32)


def elements_of(blocks: ElementBlocks, media: Sequence[Medium], thickness: float = 1.0) -> Elements:
    """The elements of each shape, of a thickness (m), for the kernels; media : by their numbers."""
    rule, sizes = blocks.mesh.rule, blocks.sizes
    along_x, along_y = (2.0 / size[:, None, None] * rule.derivative for size in sizes.T)
    volumes = 0.25 * thickness * np.prod(sizes, axis=1)
    flat = len(sizes), -1
    return Elements(
        gradient_x=along_x.reshape(flat),
        gradient_y=along_y.reshape(flat),
        divergence_x=-along_x.swapaxes(1, 2).reshape(flat),
        divergence_y=-along_y.swapaxes(1, 2).reshape(flat),
        weight=volumes[:, None] * np.outer(rule.weights, rule.weights).ravel(),
        moduli=np.stack([media[number].moduli for number in blocks.media]),
        core=blocks.core,
        rim=blocks.rim,
    )


def absorber_of(blocks: ElementBlocks, profiles: Profiles, settings: Absorption, step: float) -> Absorber:
    """The layer's coefficients for time steps of `step` (s), and its convolution variables at rest."""
    mesh, count = blocks.mesh, blocks.mesh.order + 1
    elements = blocks.elements[len(blocks.elements) - blocks.layers :]
    absorbs = mesh.absorbs[elements[:, 0]]
    columns = np.zeros((3, len(elements), 2, count, LANES))  # B, A and τ
    for axis in (0, 1):
        lines = mesh.order * mesh.elements[elements, axis][:, None] + np.arange(count)[:, None]  # (L, N, 8)
        depth = mesh.axes[axis].depth[lines % mesh.axes[axis].lines]
        for side, profile in zip((-1.0, 1.0), profiles[axis], strict=True):
            if profile is not None:
                q = np.clip(side * depth, 0.0, 1.0)
                values = profile.decay(q, step), profile.gain(q, step), profile.delay(q, step)
                columns[:, :, axis] = np.where(side * depth > 0.0, values, columns[:, :, axis])
                if mesh.periodic[1 - axis] or profile.is_stretched_along:
                    part = profile.part_along(q) if profile.is_stretched_along else settings.along
                    along = [of(q, step, part) for of in (profile.decay, profile.gain)]
                    there = (side * depth > 0.0) & ~absorbs[:, None, None, 1 - axis]
                    columns[:2, :, 1 - axis] = np.where(there, along, columns[:2, :, 1 - axis])
    size = len(elements) * 4 * count**2 * LANES
    decay, gain, delay = (column.ravel() for column in columns)
    axes = blocks.kinds[len(blocks.kinds) - blocks.layers :].astype(np.int64)
    for axis in (0, 1):
        if mesh.periodic[axis] or any(profile and profile.is_stretched_along for profile in profiles[1 - axis]):
            axes[~absorbs[:, axis]] |= (1 | ALONG) << axis
    return Absorber(axes, decay, gain, delay, aligned_zeros(size), aligned_zeros(size))
