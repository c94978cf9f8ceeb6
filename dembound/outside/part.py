"""The part of a continuum."""

import numpy as np

from dembound.kernels import damped_grid  # noqa: F401  # it registers its law
from dembound.kernels.grid import strain_energies
from dembound.kernels.tables import DampedGrid, Grid
from dembound.motion.cracks import NO_CRACKS, Cracks
from dembound.motion.part import Part
from dembound.motion.state import Arrays, State
from dembound.outside.body import GridBody


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
        for nodes, where in (
            (inside, "inside an element that absorbs"),
            (np.flatnonzero(mesh.held), "on a held edge"),
        ):
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
