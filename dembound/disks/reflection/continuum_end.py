"""The last brick of a row with the continuum of a case beyond its side, in steady oscillation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from dembound.boundaries.edge import normal_axis
from dembound.continuum.axis import Around
from dembound.continuum.layer import Profile, along_in
from dembound.continuum.medium import Medium
from dembound.continuum.mesh import Mesh
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.reflection.bricks import LAST, BrickInRow, LastBrick, is_outwards
from dembound.disks.reflection.modes import Oscillation
from dembound.disks.surroundings.continuum import Surroundings
from dembound.disks.surroundings.cut_bonds import CutBonds
from dembound.disks.surroundings.wall import Wall
from dembound.packings.brick import Brick
from dembound.packings.cut import cut_contacts
from dembound.packings.tiling import Assembly, tile

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


class Layer(NamedTuple):
    """The layer beyond a side.

    axis : of its normal. profile : of σ, α and τ. along : part of σ for derivatives along the layer.
    """

    axis: int
    profile: Profile
    along: float


class Elements:
    """Equal elements, periodic along one axis, with an absorbing layer along the other.

    Parameters
    ----------
    mesh, medium : the elements, and density and moduli. layer : at one of its sides.

    Attributes
    ----------
    nodes, periods : (E, N²) nodes of every element, and how many periods ahead of their own they are in it, 0 or 1.
    count : number of degrees of freedom, x of all nodes and then y. imaged : (i,) those of nodes that some element has
    a period ahead. moving : (count,) bool, those that are not at rest.
    """

    def __init__(self, mesh: Mesh, medium: Medium, layer: Layer) -> None:
        self._mesh, self._medium, self._layer = mesh, medium, layer
        elements = len(mesh.elements)
        self.nodes = mesh.nodes.reshape(elements, -1)
        periodic = 1 - layer.axis
        lines = mesh.order * mesh.elements[:, periodic, None] + np.arange(mesh.order + 1)
        passed = lines // mesh.axes[periodic].lines
        across = passed[:, None, :] if periodic == 0 else passed[:, :, None]
        self.periods = np.broadcast_to(across, mesh.nodes.shape).reshape(elements, -1)
        self.count = 2 * mesh.count
        self.moving = np.tile(~mesh.held, 2)
        own = self.numbers(np.arange(elements)).reshape(elements, -1)
        ahead = np.tile(self.periods, 2) > 0
        self.imaged = np.unique(own[ahead])
        self._places = np.where(ahead, self.count + np.searchsorted(self.imaged, own), own)

    def numbers(self, elements: np.ndarray) -> np.ndarray:
        """Degrees of freedom (k, 2, N²) of some elements (k,)."""
        return np.stack([self.nodes[elements], self._mesh.count + self.nodes[elements]], axis=1)

    def stiffness(self, oscillation: Oscillation) -> csc_matrix:
        """Dynamic stiffness (count + i, count + i) at a frequency; the last degrees of freedom are the images."""
        from scipy.sparse import coo_matrix

        across = self._mesh.elements[:, self._layer.axis]
        _, first, kind = np.unique(across, return_index=True, return_inverse=True)
        each = np.stack([self._of_element(element, oscillation) for element in first])[kind.ravel()]
        both = self._places[:, :, None], self._places[:, None, :]
        rows, columns = (np.broadcast_to(of, each.shape).ravel() for of in both)
        every = self.count + len(self.imaged)
        return coo_matrix((each.ravel(), (rows, columns)), shape=(every, every)).tocsc()

    def _of_element(self, element: int, oscillation: Oscillation) -> np.ndarray:
        """Dynamic stiffness (2N², 2N²) of one element."""
        mesh, rule = self._mesh, self._mesh.rule
        one, (width, height) = np.eye(rule.count), mesh.element_sizes[element]
        plain = 2.0 / width * np.kron(one, rule.derivative), 2.0 / height * np.kron(rule.derivative, one)
        stretch, delay = self._absorption(element, oscillation)
        along_x, along_y = (of[:, None] * matrix * delay for of, matrix in zip(stretch, plain, strict=True))
        back_x, back_y = (of[:, None] * matrix.T for of, matrix in zip(stretch, plain, strict=True))
        zero = np.zeros_like(along_x)
        strain = np.block([[along_x, zero], [zero, along_y], [along_y, along_x]])
        weight = mesh.quadrature[element].ravel()
        xx, yy, xy = np.split(np.kron(self._medium.matrix, np.diag(weight)) @ strain, 3)
        stiffness = np.vstack([back_x @ xx + back_y @ xy, back_x @ xy + back_y @ yy])
        return stiffness - oscillation.square * self._medium.density * np.diag(np.tile(weight, 2))

    def _absorption(self, element: int, oscillation: Oscillation) -> tuple[np.ndarray, np.ndarray]:
        """At the points of an element: factors (2, N²) of derivatives along x and y, and (N²,) of delayed motion."""
        mesh, (axis, profile, along) = self._mesh, self._layer
        stretch = np.ones((2, self.nodes.shape[1]), dtype=complex)
        if not mesh.absorbs[element, axis]:
            return stretch, np.ones(self.nodes.shape[1])
        q, step = mesh.depth[self.nodes[element], axis], oscillation.time_step
        beside = profile.part_along(q) if profile.is_stretched_along else along
        for direction, part in ((axis, 1.0), (1 - axis, beside)):
            memory = profile.gain(q, step, part) / (1.0 - profile.decay(q, step, part) * oscillation.back)
            stretch[direction] += memory
        return stretch, 1.0 + profile.delay(q, step) * oscillation.lagging


def beside_elements(ground: PackedMaterial, side: str, outside: Surroundings) -> PackedMaterial:
    """The packing in bricks about as long along a side as elements, or as a brick if this is longer."""
    count = copies_beside(ground, side, outside)
    return ground if count == 1 else replace(ground, brick=copies_of(ground.brick, count, 1 - normal_axis(side)))


def copies_beside(ground: PackedMaterial, side: str, outside: Surroundings) -> int:
    """Number of bricks that are about as long along a side as elements."""
    along = 1 - normal_axis(side)
    return max(1, round(_element(outside, along) / float(ground.brick.size[along])))


def _element(outside: Surroundings, axis: int) -> float:
    """Largest size (m) of the elements of a continuum along an axis."""
    return float(outside.body.mesh.axes[axis].sizes.max())


def copies_of(brick: Brick, count: int, axis: int) -> Brick:
    """`count` copies of a brick along an axis as one brick."""
    copy, period = np.repeat(np.arange(count), len(brick.pairs)), np.eye(2)[axis]
    images = np.tile(brick.images, (count, 1))
    further, other = np.divmod(copy + images[:, axis], count)
    pairs = np.tile(brick.pairs, (count, 1)) + len(brick.radii) * np.column_stack([copy, other])
    images[:, axis] = further
    shift = np.repeat(np.arange(count), len(brick.radii))[:, None] * (brick.size * period)
    edge_rows = np.tile(brick.edge_rows, (count, 1))
    edge_rows[len(brick.radii) :, axis] = False
    size, positions = brick.size * (1 + (count - 1) * period), np.tile(brick.positions, (count, 1)) + shift
    several = replace(brick, size=size, positions=positions, radii=np.tile(brick.radii, count))
    return replace(several, pairs=pairs, images=images, edge_rows=edge_rows)


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
        self._elements = Elements(mesh, outside.body.ground.only, _layer(outside, row.side))

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
        self._grid = Grid(self._elements, self._by_nodes())
        self._by_disks = self._elongated_by_disks()
        self._springs = self._wall.bonds.stiffness.ravel()
        self._lagging = 0.0j

    def at(self, oscillation: Oscillation) -> None:
        """Condense at a frequency."""
        self._body.at(oscillation)
        self._grid.at(oscillation)
        self._lagging = self._wall.lag * oscillation.lagging

    def stiffness(self, phase: complex) -> np.ndarray:
        """Dynamic stiffness (k, k) of the interface if the next period along the side moves as this one times phase."""
        body, inner, by_disks = self._body.stiffness(phase), self._count, self._by_disks
        springs = (self._springs * (1.0 + self._lagging))[:, None]
        by_nodes, yielding = self._grid.yielding(phase, springs)
        there = np.unique(self._tied[self._tied >= 0])
        pulled = by_nodes.conj().T @ (springs * by_disks)
        pulling = by_disks.T @ (springs * by_nodes)
        body[np.ix_(there, there)] += by_disks.T @ (springs * by_disks) - pulling @ yielding @ pulled
        if len(body) == inner:
            return body
        return body[:inner, :inner] - body[:inner, inner:] @ np.linalg.solve(body[inner:, inner:], body[inner:, :inner])

    def _elongated_by_disks(self) -> np.ndarray:
        """Elongations (3t, k) of the ties per motion of the kept disks that they act on, in their order."""
        of_disks, _ = self._wall.elongations
        ties = len(self._wall.element)
        row = np.broadcast_to((ties * np.arange(3)[:, None] + np.arange(ties))[:, :, None], of_disks.shape)
        column = np.broadcast_to(self._tied.T, of_disks.shape)
        there = column >= 0
        found = np.zeros((3 * ties, int(self._tied.max(initial=-1)) + 1))
        np.add.at(found, (row[there], column[there]), of_disks[there])
        return found[:, np.unique(self._tied[self._tied >= 0])]

    def _by_nodes(self) -> dict[int, np.ndarray]:
        """Number of periods ahead -> elongations (3t, count) of the ties per motion of the nodes there."""
        wall, elements, along = self._wall, self._elements, 1 - self._axis
        _, of_nodes = wall.elongations
        ties, mesh = len(wall.element), wall.mesh
        beyond = np.floor((wall.bonds.point[:, along] - mesh.origin[along]) / mesh.size[along])
        ahead = (elements.periods[wall.element] + beyond[:, None]).astype(int)
        row = (ties * np.arange(3)[:, None] + np.arange(ties))[:, :, None, None]
        each = row, elements.numbers(wall.element), ahead[:, None, :]
        row, numbers, ahead = (np.broadcast_to(values, of_nodes.shape) for values in each)
        found = {}
        for periods in np.unique(ahead).tolist():
            found[periods] = np.zeros((3 * ties, elements.count))
            chosen = ahead == periods
            np.add.at(found[periods], (row[chosen], numbers[chosen]), of_nodes[chosen])
        return found


class Grid:
    """The elements condensed to the nodes that ties act on.

    Parameters
    ----------
    elements : one period of them. by_nodes : periods ahead -> elongations (3t, count) of the ties per motion of nodes.
    """

    def __init__(self, elements: Elements, by_nodes: Mapping[int, np.ndarray]) -> None:
        self._elements, moving = elements, elements.moving
        acted = np.logical_or.reduce([each.any(axis=0) for each in by_nodes.values()]) & moving
        pulled, imaged = np.flatnonzero(acted), elements.imaged[moving[elements.imaged]]
        base = np.concatenate([pulled, np.setdiff1d(imaged, pulled)])
        others = np.setdiff1d(np.flatnonzero(moving), base)
        images = elements.count + np.flatnonzero(moving[elements.imaged])
        self._by_nodes = {periods: each[:, pulled] for periods, each in by_nodes.items()}
        self._pulled, self._base, self._inner = len(pulled), len(base), len(others)
        self._order = np.concatenate([others, base, images])
        place = np.full(elements.count, -1)
        place[base] = np.arange(len(base))
        self._imaged = place[imaged]
        self._fixed = np.zeros((0, 0), dtype=complex)

    def at(self, oscillation: Oscillation) -> None:
        """Condense at a frequency to the nodes that ties act on, the nodes that have images, and these."""
        from scipy.sparse.linalg import splu

        matrix = self._elements.stiffness(oscillation)[self._order][:, self._order]
        inner = self._inner
        self._fixed = matrix[inner:, inner:].toarray()
        if inner:
            solved = splu(matrix[:inner, :inner].tocsc()).solve(matrix[:inner, inner:].toarray())
            self._fixed -= matrix[inner:, :inner] @ solved

    def yielding(self, phase: complex, springs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Elongations (3t, p) of the ties per motion of their nodes, and motion (p, p) of the nodes per force.

        phase : of the motion a period along the side over this one. springs : (3t, 1) of the ties.
        """
        of_ties = sum((phase**periods * each for periods, each in self._by_nodes.items()), np.zeros((1, 1)))
        base, pulled = self._base, self._pulled
        columns = self._fixed[:, :base].copy()
        columns[:, self._imaged] += phase * self._fixed[:, base:]
        matrix = columns[:base]
        matrix[self._imaged] += np.conj(phase) * columns[base:]
        matrix[:pulled, :pulled] += of_ties.conj().T @ (springs * of_ties)
        return of_ties, np.linalg.solve(matrix, np.eye(base, pulled))[:pulled]


def _mesh(outside: Surroundings, row: BrickInRow, assembly: Assembly) -> Mesh:
    """The elements beyond a side of bricks, as deep as those of a case and about as long."""
    axis, settings = normal_axis(row.side), outside.settings
    deep, period = _element(outside, axis), float(assembly.size[1 - axis])
    cells, element, layer = [settings.margin + settings.layers] * 2, [deep] * 2, {row.side: settings.layers}
    cells[1 - axis] = max(1, round(period / _element(outside, 1 - axis)))
    element[1 - axis] = period / cells[1 - axis]
    origin = row.ground.brick.mass_offset.copy()
    origin[axis] += assembly.size[axis] if is_outwards(row.side) > 0 else -cells[axis] * deep
    sizes, begin = (element[0], element[1]), (float(origin[0]), float(origin[1]))
    places = {"origin": begin, "layer": Around(**layer), "periodic": (axis == 1, axis == 0)}
    return Mesh.uniform(order=settings.order, element=sizes, cells=(cells[0], cells[1]), **places)


def _layer(outside: Surroundings, side: str) -> Layer:
    """The layer of a continuum beyond a side."""
    axis, body = normal_axis(side), outside.body
    thickness = body.mesh.axes[axis].thickness[1 if is_outwards(side) > 0 else 0]
    medium = body.ground.only
    profile = Profile(thickness, medium.normal_speed(axis), body.mesh.inner, body.absorption, along=along_in(medium))
    return Layer(axis, profile, body.absorption.along if body.mesh.periodic[1 - axis] else 0.0)
