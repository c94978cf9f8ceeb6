"""The continuum as a body and as a part that is stepped: elements, medium and absorbing layer."""

from dataclasses import dataclass
from functools import cached_property

import numba
import numpy as np

from dembound.boundaries.edge import SIDES
from dembound.continuum.axis import WHOLE
from dembound.continuum.blocks import ElementBlocks, absorber_of, elements_of
from dembound.continuum.layer import USUAL, Absorption, Profile, along_in
from dembound.continuum.medium import Ground, Layered, Medium, Unlike, layered
from dembound.continuum.mesh import Mesh
from dembound.damping import Attenuation, factors_of
from dembound.kernels import damped_grid  # noqa: F401  # it registers its law
from dembound.kernels.common import CHUNKS
from dembound.kernels.compiler.lanes import LANES
from dembound.kernels.grid import fill_forces, strain_energies
from dembound.kernels.tables.grid import Absorber, DampedGrid, Grid
from dembound.motion.part import NO_CRACKS, Cracks, Part
from dembound.motion.state import Arrays, State, aligned_zeros


@dataclass(frozen=True, eq=False, kw_only=True)
class GridBody:
    """A continuum on a mesh.

    Attributes
    ----------
    mesh, medium : its elements, and density and moduli; of layers, edges of elements lie on their joints; of unlike
    sides the elements right of the mesh's box have the right one. mechanisms :
    of the damping of each layer, whose moduli are those of the medium at one frequency, None without; () without any.
    absorption : settings of the layers of the mesh.
    thickness : m, across the plane; by default that of the disks.
    added_mass : (n,) kg on nodes, beyond that of the medium; by default none.
    first_slot : slot of its first node in the scene; multiples of eight are fastest.
    inner : m, length between the layers of which their shift depends; None: that of the mesh.

    Raises ValueError if a joint of layers lies inside elements.
    """

    mesh: Mesh
    medium: Ground
    mechanisms: tuple[Attenuation | None, ...] = ()
    absorption: Absorption = USUAL
    thickness: float = 1.0
    added_mass: np.ndarray | float = 0.0
    first_slot: int = 0
    inner: float | None = None

    def __post_init__(self) -> None:
        edges = self.mesh.origin[1] + self.mesh.axes[1].edges
        for joint in self.ground.joints:
            if edges[0] < joint < edges[-1] and np.abs(edges - joint).min() > WHOLE * self.mesh.size[1]:
                raise ValueError(f"the joint of layers at y = {joint:g} m lies inside elements")

    @cached_property
    def ground(self) -> Layered | Unlike:
        """The layers of its medium."""
        return layered(self.medium)

    @cached_property
    def layer(self) -> np.ndarray:
        """(E,) number of the layer that every element is in."""
        heights = self.mesh.rectangles[:, 1::2].mean(axis=1)
        if isinstance(self.ground, Unlike):
            return self.ground.number_at(heights, self.mesh.is_right)
        return self.ground.number_at(heights)

    @property
    def count(self) -> int:
        """Number of nodes n."""
        return self.mesh.count

    @cached_property
    def mass(self) -> np.ndarray:
        """(n,) kg."""
        return self.own_mass + self.added_mass

    @property
    def own_mass(self) -> np.ndarray:
        """(n,) kg, of the medium."""
        areas = (self.mesh.areas_of(self.layer == number) for number in range(len(self.ground.media)))
        each = [medium.density * self.thickness * of for medium, of in zip(self.ground.media, areas, strict=True)]
        return np.sum(each, axis=0)

    @property
    def stepped_media(self) -> tuple[Medium, ...]:
        """The medium of each layer with the unrelaxed moduli with which it is stepped."""
        each = zip(self.ground.media, self.mechanisms or (None,) * len(self.ground.media), strict=True)
        return tuple(medium if damped is None else medium.times(damped.unrelaxed) for medium, damped in each)

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
        return ElementBlocks(self.mesh, self.first_slot, self.layer)

    def profile(self, side: str) -> Profile | None:
        """The absorbing layer at a side, None without; its speed is that of the fastest P waves in it.

        It is the same at all heights of layered ground, and stretches both axes where one grows, see layer.py.
        """
        axis, end = divmod(SIDES.index(side), 2)
        if (cells := self.mesh.layer.along(axis)[end]) == 0:
            return None
        place = self.mesh.elements[:, axis]
        there = np.unique(self.layer[place >= self.mesh.cells[axis] - cells if end else place < cells])
        speed = max(self.ground.media[number].normal_speed(axis) for number in there)
        thickness, guides = self.mesh.axes[axis].thickness[end], axis == 0 and len(there) > 1
        along = max(along_in(self.ground.media[number]) for number in there)
        return Profile(thickness, speed, self.inner or self.mesh.inner, self.absorption, guides, along)

    @property
    def is_stretched_along(self) -> bool:
        """Whether its layers stretch both axes because a medium is strongly anisotropic, and so return more."""
        return any(profile and profile.along > 0.0 for profile in map(self.profile, SIDES))

    def bundle(self, absorber: Absorber) -> Grid:
        """The arrays of its law."""
        elements, blocks = elements_of(self.blocks, self.stepped_media, self.thickness), self.blocks.bundle
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
        left, right, bottom, top = (self.profile(side) for side in SIDES)
        profiles = (left, right), (bottom, top)
        return self.bundle(absorber_of(self.blocks, profiles, self.absorption, time_step))

    def damped(self, grid: Grid, time_step: float) -> DampedGrid | None:
        """The arrays of its law with memories for time steps Δt (s), at rest; None without damping."""
        if not any(self.mechanisms):
            return None
        each = factors_of(self.mechanisms, time_step)[self.layer[self.blocks.elements[:, 0]]]
        blocks, count = grid.blocks.blocks, each.shape[2]
        factors = np.repeat(each, LANES)
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


class GridPart(Part):
    """A continuum under its law (kernels/grid.py).

    Parameters
    ----------
    body : elements, medium and layers. time_step : Δt in s. name : its name in the state.
    first_node : number of its first node in the scene.
    supported : (k,) its nodes, numbered from 0, that the support table or ties move.
    damped : whether its damping acts, not in a static stage.

    Raises ValueError if a supported node lies inside an element that absorbs, whose energy could not be accounted for,
    or on an outer edge, which is at rest.
    """

    law_name = "continuum"

    def __init__(
        self,
        body: GridBody,
        time_step: float,
        *,
        name: str = "continuum",
        first_node: int = 0,
        supported: np.ndarray | None = None,
        damped: bool = True,
    ) -> None:
        self.name = name
        self.body = body
        self.nodes = slice(first_node, first_node + body.count)
        self._law = body.law(time_step)
        self._damped = body.damped(self._law, time_step) if damped else None
        self._refuse(np.zeros(0, dtype=np.int64) if supported is None else supported)

    def _refuse(self, supported: np.ndarray) -> None:
        """Raise ValueError for nodes that cannot be supported."""
        mesh = self.body.mesh
        inside = mesh.nodes[mesh.absorbs.any(axis=1), 1:-1, 1:-1]
        for nodes, where in ((inside, "inside an element that absorbs"), (np.flatnonzero(mesh.held), "on a held edge")):
            if np.isin(supported, nodes).any():
                raise ValueError(f"a supported node is {where}")

    def law(self) -> Grid | DampedGrid:
        """The arrays of the law."""
        return self._law if self._damped is None else self._damped

    def react(self, why: int, steps: int, state: State) -> None:
        """Do nothing: the law never changes."""

    def stored(self, u: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) at displacements (3, slots) of the elements that do not absorb.

        Energy that reaches elements that absorb is counted as damping.
        """
        blocks = self._law.blocks
        energy = np.empty(blocks.blocks - blocks.layers)
        strain_energies(self._law, u, energy)
        return float(np.sum(energy)), 0.0

    def counted(self, u: np.ndarray) -> float:
        """Strain energy (J) at displacements (3, slots) that the loop counts as taken by damping."""
        return 0.0 if self._damped is None else self.stored(u)[0]

    def take_cracks(self, steps: int) -> Cracks:
        """None, as a continuum does not break."""
        return NO_CRACKS

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """Stress (m, 3) σ_xx, σ_yy, σ_xy, tension positive."""
        return {"stress": (stress(self.body, displacement[:2, self.nodes]), "Pa")}

    def saved_arrays(self) -> Arrays:
        """The convolution variables of the layers, and the memories of damping."""
        absorber = self._law.absorber
        saved = {"strain_memory": absorber.strain_memory, "force_memory": absorber.force_memory}
        return saved if self._damped is None else saved | {"memory": self._damped.memory}

    def restore(self, saved: Arrays) -> None:
        """Restore the arrays returned by `saved_arrays` in another run of the same case."""
        for name, values in self.saved_arrays().items():
            values[:] = saved[name]


def stress(body: GridBody, displacement: np.ndarray) -> np.ndarray:
    """Stress (n, 3) Pa of every node: σ_xx, σ_yy, σ_xy at displacements (2, n) m, tension positive.

    The mean over the node's elements, weighted by area; in layers convolution variables are left out.
    """
    mesh = body.mesh
    derivative = mesh.rule.derivative
    u = displacement[:, mesh.nodes]  # (2, E, N, N) by row and column
    steeper_x, steeper_y = 2.0 / mesh.element_sizes.T[:, :, None, None]
    along_x = steeper_x * np.einsum("ik,cejk->ceji", derivative, u)
    along_y = steeper_y * np.einsum("jk,ceki->ceji", derivative, u)
    strain = np.stack([along_x[0], along_y[1], along_y[0] + along_x[1]])
    each = np.empty_like(strain)
    for number, medium in enumerate(body.ground.media):
        chosen = body.layer == number
        each[:, chosen] = np.einsum("ab,beji->aeji", medium.matrix, strain[:, chosen])
    node, weights = mesh.nodes.ravel(), mesh.quadrature.ravel()
    return np.stack([np.bincount(node, weights * row.ravel(), mesh.count) / mesh.areas for row in each], axis=1)
