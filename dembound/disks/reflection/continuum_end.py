"""The last brick of a row with the continuum of a case beyond its side.

Of the continuum it has one period along the side, of as many bricks and elements as fit together, and all elements
along its normal with their layers. The ties of the bonds that the side cuts are those of a run.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from dembound.boundaries import normal_axis
from dembound.disks.beyond.cut_bonds import CutBonds
from dembound.disks.beyond.surroundings import Surroundings
from dembound.disks.beyond.wall import Wall
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reflection.bricks import LAST, BrickInRow, LastBrick, is_outwards
from dembound.disks.reflection.condensed import Oscillation
from dembound.disks.reflection.elements import Elements, Layer
from dembound.outside.layer import Profile
from dembound.outside.mesh import Around, Mesh
from dembound.packings.brick import Brick
from dembound.packings.cut import cut_contacts
from dembound.packings.tiling import Assembly, tile

if TYPE_CHECKING:
    from scipy.sparse import csr_matrix


def beside_elements(ground: PackedMaterial, side: str, outside: Surroundings) -> PackedMaterial:
    """The packing in bricks about as long along a side as elements, or as a brick if this is longer."""
    along = 1 - normal_axis(side)
    count = max(1, round(_element(outside, along) / float(ground.brick.size[along])))
    return ground if count == 1 else replace(ground, brick=copies_of(ground.brick, count, along))


def _element(outside: Surroundings, axis: int) -> float:
    """Largest size (m) of the elements of a continuum along an axis."""
    return float(outside.body.mesh.axes[axis].sizes.max())


def copies_of(brick: Brick, count: int, axis: int) -> Brick:
    """So many copies of a brick along an axis as one."""
    copy, period = np.repeat(np.arange(count), len(brick.pairs)), np.eye(2)[axis]
    images = np.tile(brick.images, (count, 1))
    further, other = np.divmod(copy + images[:, axis], count)
    pairs = np.tile(brick.pairs, (count, 1)) + len(brick.radii) * np.column_stack([copy, other])
    images[:, axis] = further
    shift = np.repeat(np.arange(count), len(brick.radii))[:, None] * (brick.size * period)
    edge_rows = np.tile(brick.edge_rows, (count, 1))
    edge_rows[len(brick.radii) :, axis] = False
    return replace(
        brick,
        size=brick.size * (1 + (count - 1) * period),
        positions=np.tile(brick.positions, (count, 1)) + shift,
        radii=np.tile(brick.radii, count),
        pairs=pairs,
        images=images,
        edge_rows=edge_rows,
    )


class ContinuumEnd:
    """The last brick and the continuum, condensed to the interface of the brick.

    Parameters
    ----------
    outside : the continuum of a case, on this side. row : the bricks before the last one.
    """

    def __init__(self, outside: Surroundings, row: BrickInRow) -> None:
        ground, self._axis = row.ground, normal_axis(row.side)
        copies, periodic = [1, 1], (self._axis == 1, self._axis == 0)
        copies[self._axis] = LAST
        assembly = tile(ground.brick, (copies[0], copies[1]), periodic)
        mesh = _mesh(outside, row, assembly)
        cut = cut_contacts(ground.brick, assembly, (row.side,), periodic)
        begins = float(mesh.origin[self._axis]) + (0.0 if is_outwards(row.side) > 0 else float(mesh.size[self._axis]))
        bonds = CutBonds.of(ground, cut, assembly.positions).between([begins] * 4)
        self._wall = Wall.of(mesh, bonds, outside.wall.lag, outside.wall.mean)
        self._elements = Elements(mesh, outside.body.medium, _layer(outside, row.side))

        last = LastBrick(assembly, row)
        twin = assembly.brick_particle[last.disks]
        mass = np.stack([ground.mass, ground.mass, ground.inertia])[:, twin]
        moves = np.ones(mass.shape, dtype=bool)
        moves[list(ground.held)] = False
        tied = np.arange(3)[:, None] * len(twin) + last.number[self._wall.bonds.particle]
        self._body = last.condensed(mass, moves, kept=tied[moves.ravel()[tied]])
        place = np.full(mass.size, -1)
        place[self._body.interface] = np.arange(len(self._body.interface))
        self._tied, self._count = place[tied], row.count
        self._oscillation = Oscillation(0.0, 0.0)

    def at(self, oscillation: Oscillation) -> None:
        """Condense at a frequency."""
        self._body.at(oscillation)
        self._oscillation = oscillation

    def stiffness(self, phase: complex) -> np.ndarray:
        """Dynamic stiffness (k, k) of the interface if the motion a period along the side is this one's times phase."""
        from scipy.sparse import diags
        from scipy.sparse.linalg import splu

        body, moving, inner = self._body.stiffness(phase), self._elements.moving, self._count
        of_disks, of_nodes = self._elongations(phase, len(body))
        of_nodes = of_nodes[:, moving]
        springs = diags(self._wall.bonds.stiffness.ravel() * (1.0 + self._wall.lag * self._oscillation.lagging))
        grid = self._elements.stiffness(self._oscillation, phase)[moving][:, moving]
        grid = (grid + of_nodes.conj().T @ springs @ of_nodes).tocsc()
        pulled = np.flatnonzero(of_nodes.getnnz(axis=0))  # the nodes that ties act on
        unit = np.zeros((grid.shape[0], len(pulled)), dtype=complex)
        unit[pulled, np.arange(len(pulled))] = 1.0
        yielding = splu(grid).solve(unit)[pulled]
        of_nodes = of_nodes[:, pulled]
        there = np.unique(self._tied[self._tied >= 0])
        of_disks = of_disks[:, there]
        by_disks = (of_nodes.conj().T @ springs @ of_disks).toarray()
        on_disks = (of_disks.T @ springs @ of_nodes).toarray()
        body[np.ix_(there, there)] += (of_disks.T @ springs @ of_disks).toarray() - on_disks @ yielding @ by_disks
        if len(body) == inner:
            return body
        return body[:inner, :inner] - body[:inner, inner:] @ np.linalg.solve(body[inner:, inner:], body[inner:, :inner])

    def _elongations(self, phase: complex, kept: int) -> tuple[csr_matrix, csr_matrix]:
        """Elongations (3t) of the ties per motion of the kept disks, (3t, kept), and of all nodes."""
        from scipy.sparse import coo_matrix

        wall, elements, along = self._wall, self._elements, 1 - self._axis
        of_disks, of_nodes = wall.elongations
        ties = len(wall.element)
        row = (ties * np.arange(3)[:, None] + np.arange(ties))[:, :, None]
        column = np.broadcast_to(self._tied.T, of_disks.shape)
        there = column >= 0
        by_disks = coo_matrix(
            (of_disks[there], (np.broadcast_to(row, of_disks.shape)[there], column[there])), shape=(3 * ties, kept)
        )
        mesh = wall.mesh
        beyond = np.floor((wall.bonds.point[:, along] - mesh.origin[along]) / mesh.size[along])
        turn = phase ** (elements.periods[wall.element] + beyond[:, None])
        values = of_nodes * turn[:, None, :]
        numbers = np.broadcast_to(elements.numbers(wall.element), values.shape)
        rows = np.broadcast_to(row[..., None], values.shape)
        shape = 3 * ties, elements.count
        by_nodes = coo_matrix((values.ravel(), (rows.ravel(), numbers.ravel())), shape=shape)
        return by_disks.tocsr(), by_nodes.tocsr()


def _mesh(outside: Surroundings, row: BrickInRow, assembly: Assembly) -> Mesh:
    """The elements beyond a side of bricks, as deep as those of a case and about as long."""
    axis, settings = normal_axis(row.side), outside.settings
    deep, period = _element(outside, axis), float(assembly.size[1 - axis])
    cells, element, layer = [settings.margin + settings.layers] * 2, [deep] * 2, {row.side: settings.layers}
    cells[1 - axis] = max(1, round(period / _element(outside, 1 - axis)))
    element[1 - axis] = period / cells[1 - axis]
    origin = row.ground.brick.mass_offset.copy()
    origin[axis] += assembly.size[axis] if is_outwards(row.side) > 0 else -cells[axis] * deep
    return Mesh.uniform(
        order=settings.order,
        element=(element[0], element[1]),
        cells=(cells[0], cells[1]),
        origin=(float(origin[0]), float(origin[1])),
        layer=Around(**layer),
        periodic=(axis == 1, axis == 0),
    )


def _layer(outside: Surroundings, side: str) -> Layer:
    """The layer of a continuum beyond a side."""
    axis, body = normal_axis(side), outside.body
    thickness = body.mesh.axes[axis].thickness[1 if is_outwards(side) > 0 else 0]
    profile = Profile(thickness, body.medium.normal_speed(axis), body.mesh.inner, body.absorption)
    return Layer(axis, profile, body.absorption.along if body.mesh.periodic[1 - axis] else 0.0)
