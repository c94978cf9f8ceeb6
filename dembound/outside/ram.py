"""The RAM that a continuum needs, from the numbers of its nodes and elements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from dembound.outside.mesh import Mesh


@dataclass(frozen=True)
class GridSizes:
    """Numbers of the nodes and elements of a mesh, how many elements absorb, and their order."""

    nodes: int
    elements: int
    absorbing: int
    order: int

    @classmethod
    def of(cls, mesh: Mesh) -> GridSizes:
        """The numbers of a mesh, computed without its arrays, so that any number of elements is possible."""
        nodes = elements = elastic = 1
        left_out_nodes = left_out = 0 if mesh.box is None else 1
        for axis, cells in enumerate(mesh.cells):
            nodes *= mesh.order * cells + (not mesh.periodic[axis])
            elements *= cells
            elastic *= cells - sum(mesh.layer.along(axis))
            if mesh.box is not None:
                first, last = mesh.box[axis], mesh.box[2 + axis]
                left_out *= last - first
                left_out_nodes *= mesh.order * (last - first) - 1 + (first == 0) + (last == cells)
        absorbing = elements - elastic
        if mesh.levels is not None and mesh.box is not None:
            beside = mesh.box[0], mesh.cells[0] - mesh.box[2]
            for level, columns, layer in zip(mesh.levels, beside, mesh.layer.along(0), strict=True):
                above = mesh.cells[1] - level
                left_out += columns * above
                left_out_nodes += mesh.order * above * (mesh.order * columns + (columns > 0))  # with the box's side
                absorbing -= layer * above
        return cls(nodes - left_out_nodes, elements - left_out, absorbing, mesh.order)

    @classmethod
    def all_of(cls, meshes: Sequence[Mesh]) -> GridSizes:
        """The sums of the numbers of several meshes of one order."""
        each = [cls.of(mesh) for mesh in meshes]
        nodes, elements, absorbing = (
            sum(getattr(sizes, name) for sizes in each) for name in ("nodes", "elements", "absorbing")
        )
        return cls(nodes, elements, absorbing, each[0].order)

    @property
    def points(self) -> int:
        """Number of points of an element."""
        return (self.order + 1) ** 2

    @property
    def rim(self) -> int:
        """Number of points on the edges of an element."""
        return 4 * self.order


def body_bytes(z: GridSizes) -> float:
    """Bytes of a continuum in a scene, with the arrays of its law and of the same law without layers.

    By node: positions twice, crossing lines, depths (64), number, area, slots and their nodes, two masses, mass and
    inertia in the scene (72), where its entries begin (3). By element: its place (16), lines (16 a row of points),
    nodes twice (16 a point); those of its rim, and their entries (8), and the forces on them under both laws (32). Of
    layers: convolution variables, and coefficients (48 a row).
    """
    row = z.order + 1
    element = 16 + 16 * row + 16 * z.points + 40 * z.rim
    return 139.0 * z.nodes + element * z.elements + memories_bytes(z) + 48 * row * z.absorbing


def memories_bytes(z: GridSizes) -> float:
    """Bytes of the convolution variables of absorbing layers, eight numbers a point."""
    return 64.0 * z.points * z.absorbing


def header_bytes(z: GridSizes) -> float:
    """Bytes of a mesh while it is written to a record: positions and flags (17), cells three times (96)."""
    return 113.0 * z.nodes


def snapshot_bytes(z: GridSizes) -> float:
    """Bytes of a snapshot: motion, its change since the start (72), what is not yet in the file (72), and stress.

    The stress needs displacements, derivatives, strains and stresses at the points of all elements (13 numbers), with
    weights and their product.
    """
    return 144.0 * z.nodes + 8 * 15 * z.points * z.elements
