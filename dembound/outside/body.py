"""The continuum as a body: elements, medium and absorbing layer, with the masses and slots of its nodes."""

from dataclasses import dataclass
from functools import cached_property

import numba
import numpy as np

from dembound.damping.quality import Mechanisms
from dembound.kernels.common import CHUNKS
from dembound.kernels.grid import fill_forces
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import Absorber, DampedGrid, Grid
from dembound.motion.layout import aligned_zeros
from dembound.outside.blocks import ElementBlocks, absorber_of, elements_of
from dembound.outside.layer import USUAL, Absorption
from dembound.outside.medium import Medium
from dembound.outside.mesh import Mesh


@dataclass(frozen=True, eq=False, kw_only=True)
class GridBody:
    """A continuum on a mesh.

    Attributes
    ----------
    mesh, medium : its elements, and density and moduli. mechanisms : of its damping, whose moduli are those of the
    medium at one frequency; None without damping.
    absorption : settings of the layers of the mesh.
    thickness : m, across the plane; by default that of the disks.
    added_mass : (n,) kg on nodes, beyond that of the medium; by default none.
    first_slot : slot of its first node in the scene; multiples of eight are fastest.
    """

    mesh: Mesh
    medium: Medium
    mechanisms: Mechanisms | None = None
    absorption: Absorption = USUAL
    thickness: float = 1.0
    added_mass: np.ndarray | float = 0.0
    first_slot: int = 0

    @property
    def count(self) -> int:
        """Number of nodes n."""
        return self.mesh.count

    @cached_property
    def mass(self) -> np.ndarray:
        """(n,) kg."""
        return self.medium.density * self.thickness * self.mesh.areas + self.added_mass

    @property
    def stepped_medium(self) -> Medium:
        """The medium with the unrelaxed moduli with which it is stepped."""
        return self.medium if self.mechanisms is None else self.medium.times(self.mechanisms.unrelaxed)

    @cached_property
    def mass_for_limit(self) -> np.ndarray:
        """(n,) kg, less than the mass where the delay τ acts, so that M⁻¹K bounds the time step with the delay.

        With gradients of u + τv central differences are stable up to ω²(Δt² + 2τΔt) = 4, so that ω² counts 1 + 2τ/Δt
        times.
        """
        q = self.mesh.depth.max(axis=1)
        return self.mass / (1.0 + 2.0 * self.absorption.delay * q**2)

    @cached_property
    def blocks(self) -> ElementBlocks:
        """The elements in blocks, and the slots of the nodes."""
        return ElementBlocks(self.mesh, self.first_slot)

    def bundle(self, absorber: Absorber) -> Grid:
        """The arrays of its law."""
        elements, blocks = elements_of(self.blocks, self.stepped_medium, self.thickness), self.blocks.bundle
        space = 6 * elements.weight.shape[1] * LANES
        return Grid(
            points=tuple(self.mesh.rule.points.tolist()),
            elements=elements,
            blocks=blocks,
            absorber=absorber,
            force=aligned_zeros(2 * len(blocks.rim_slot)),
            space=aligned_zeros(numba.config.NUMBA_NUM_THREADS, space),  # type: ignore[attr-defined]
            taken=np.zeros((CHUNKS, 4)),
        )

    def law(self, time_step: float) -> Grid:
        """The arrays of its law for time steps Δt (s), with layers at rest."""
        return self.bundle(absorber_of(self.blocks, self.medium, self.absorption, time_step))

    def damped(self, grid: Grid, time_step: float) -> DampedGrid | None:
        """The arrays of its law with memories for time steps Δt (s), at rest; None without damping."""
        if self.mechanisms is None:
            return None
        each = self.mechanisms.per_step(time_step)
        blocks, count = grid.blocks.blocks, each.shape[1]
        factors = np.broadcast_to(each[None, :, :, None], (blocks, 2, count, LANES)).ravel()
        memory = aligned_zeros(blocks * count * 2 * grid.elements.weight.shape[1] * LANES)
        held = np.zeros((2, blocks * grid.elements.core.size * LANES))
        return DampedGrid(grid, count, factors, memory, held, np.zeros(1))

    @cached_property
    def _elastic(self) -> Grid:
        """The law without its layers' convolution variables."""
        nothing = np.zeros(0)
        return self.bundle(Absorber(np.zeros(0, dtype=np.int64), *[nothing] * 5))

    def fill_forces(self, u: np.ndarray, force: np.ndarray) -> None:
        """Fill force (3, slots) of its nodes with elastic forces (N) at displacements u, zero on outer edges."""
        fill_forces(self._elastic, u, force)
