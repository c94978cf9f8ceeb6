"""The continuum round a body of disks, on the sides of type "outside", and the ties between both."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from dembound.boundaries.sides import SIDES, normal_axis
from dembound.boundaries.support import Edge
from dembound.casefile.disks import DiskCase
from dembound.disks.packed_material import PackedMaterial
from dembound.disks.wall import CutBonds, Wall, lag_of
from dembound.errors import CaseError
from dembound.kernels.lanes import LANES
from dembound.kernels.tables import WallTies
from dembound.kernels.wall import tie_forces
from dembound.motion.layout import Layout
from dembound.motion.part import Tie
from dembound.outside.body import GridBody
from dembound.outside.choice import element_size
from dembound.outside.layer import Absorption
from dembound.outside.medium import Medium
from dembound.outside.mesh import Around, Mesh
from dembound.packings.cut import cut_contacts
from dembound.packings.tiling import Assembly

CONTINUUM = ".continuum"
"""Ending of the names of sides of the continuum."""


@dataclass(frozen=True, eq=False)
class Surroundings:
    """A continuum round the disks of a body.

    Attributes
    ----------
    sides : on which it is. element : largest side of an element, as given or chosen, m. body : elements, medium and
    layers. wall : the ties of cut bonds to it. disks : number of disks; the continuum's nodes follow in the scene.
    """

    sides: tuple[str, ...]
    element: float
    body: GridBody
    wall: Wall
    disks: int

    @property
    def count(self) -> int:
        """Number of nodes."""
        return self.body.count

    @property
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data for the record: positions (m, 2), whether nodes absorb (m,), and corners of the cells between them."""
        mesh = self.body.mesh
        return {
            "position": (mesh.positions, "m"),
            "absorbs": (np.any(mesh.depth > 0.0, axis=1), "1"),
            "cell": (mesh.node_cells, "1"),
        }

    @cached_property
    def tied(self) -> np.ndarray:
        """Disks and nodes (k,) that ties act on, by their numbers in the scene, ascending."""
        return np.union1d(self.wall.bonds.particle, self.disks + self.wall.nodes)

    @cached_property
    def tied_by_side(self) -> dict[str, np.ndarray]:
        """Tied disks (k,) by side, and nodes (m,) of the continuum by ``<side>.continuum``, by number in the scene.

        A disk belongs to the side that its first bond is cut by, a node to that of the first element it belongs to.
        """
        wall = self.wall
        disk, first = np.unique(wall.bonds.particle, return_index=True)
        _, begin = np.unique(wall.element, return_index=True)
        nodes = self.body.mesh.nodes[wall.elements].reshape(len(wall.elements), -1)
        node, entry = np.unique(nodes, return_index=True)
        tied = {}
        for number, name in enumerate(SIDES):
            if name in self.sides:
                tied[name] = disk[wall.bonds.side[first] == number]
                tied[f"{name}{CONTINUUM}"] = (
                    self.disks + node[wall.bonds.side[begin[entry // nodes.shape[1]]] == number]
                )
        return tied

    @cached_property
    def edges(self) -> dict[str, Edge]:
        """The tied nodes as sides of their own, by ``<side>.continuum``."""
        edges = {}
        for name, tied in self.tied_by_side.items():
            if name.endswith(CONTINUUM):
                side, nodes = name.removesuffix(CONTINUUM), tied - self.disks
                length = float(self.body.mesh.size[1 - normal_axis(side)])
                edges[name] = Edge(side, tied, self.body.mesh.positions[nodes], np.ones(len(nodes)), length)
        return edges

    def laid_out(self, layout: Layout) -> Layout:
        """The slots of the disks in a layout, and of the continuum's nodes behind them."""
        slots = np.concatenate([layout.slot, self.body.blocks.slot])
        return Layout(slots, -(-self.body.blocks.end // LANES) * LANES)

    def ties(self, layout: Layout, supported: np.ndarray) -> WallTies:
        """The ties for the kernels; supported (k,) are the nodes of the support table, ascending."""
        line = np.zeros(layout.count, dtype=np.int64)
        line[layout.slot[supported]] = np.arange(len(supported))
        return self.wall.ties(layout.slot[: self.disks], layout.slot[self.disks :], line, None)

    def adds_forces(self, layout: Layout) -> Callable[[np.ndarray, np.ndarray, float], None]:
        """A function of displacements u (3, slots), forces (3, slots) and a factor.

        It fills the forces on the continuum, and adds those of the ties times the factor to all.
        """
        slot, tied = self.body.blocks.slot, layout.slot[self.tied]
        ties = self.ties(layout, self.tied)

        def add(u: np.ndarray, force: np.ndarray, times: float) -> None:
            own, of_ties = np.zeros_like(force), np.zeros((len(tied), 3))
            self.body.fill_forces(u, own)
            force[:, slot] = own[:, slot]
            tie_forces(ties, u, np.zeros_like(u), of_ties, 0.0)
            force[:, tied] += times * of_ties.T

        return add


class WallTie(Tie):
    """The half bonds between the disks and the continuum.

    Parameters
    ----------
    surroundings : of the body. layout : the slots of all nodes of the scene.
    """

    def __init__(self, surroundings: Surroundings, layout: Layout) -> None:
        self._surroundings, self._layout = surroundings, layout

    @property
    def nodes(self) -> np.ndarray:
        """Disks and nodes of the continuum (k,) that it acts on, ascending."""
        return self._surroundings.tied

    def bundle(self, supported: np.ndarray) -> NamedTuple:
        """Its arrays for the kernels."""
        return self._surroundings.ties(self._layout, supported)


def medium_of(ground: PackedMaterial) -> Medium:
    """The continuum that a packing is equivalent to, with all six constants."""
    c = ground.material_tensor
    return Medium(ground.density, c[0, 0], c[1, 1], c[0, 1], c[2, 2], c[0, 2], c[1, 2])


def surroundings_of(
    case: DiskCase, ground: PackedMaterial, assembly: Assembly, layout: Layout, sides: Sequence[str]
) -> Surroundings:
    """The continuum on some sides of a body whose disks have a layout.

    Raises CaseError if no element size suits the waves, or the packing's sides cut no bonds.
    """
    keys = case.outside
    medium = medium_of(ground)
    width, height = assembly.extent.tolist()
    largest = keys.element or element_size(case, medium, ground.brick.mean_diameter, keys.order, keys.accuracy)
    element = tuple(length / np.ceil(length / largest - 1e-9) for length in (width, height))
    there = [side in sides for side in ("left", "right", "bottom", "top")]
    low = 0.5 * (assembly.size - assembly.extent)
    mesh = Mesh.around(
        (float(low[0]), float(low[1]), float(low[0]) + width, float(low[1]) + height),
        (float(element[0]), float(element[1])),
        keys.order,
        margin=Around(*(keys.margin * each for each in there)),
        layer=Around(*(keys.layers * each for each in there)),
    )
    cut = cut_contacts(ground.brick, assembly, sides)
    if len(cut.node) == 0:
        raise CaseError([f"boundary.{sides[0]}: cuts no bonds, so nothing can be tied to the continuum"])
    body = GridBody(
        mesh=mesh,
        medium=medium,
        absorption=Absorption(reflection=keys.reflection),
        first_slot=-(-layout.count // LANES) * LANES,
    )
    wall = Wall.of(mesh, CutBonds.of(ground, cut, assembly.positions), lag_of(ground, keys.damping))
    return Surroundings(tuple(sides), largest, body, wall, len(assembly.radii))
