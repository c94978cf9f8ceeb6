"""The particles of the sides of a scene, also next to a free-field column and to holes."""

from collections.abc import Mapping

import numpy as np

from dembound.boundaries import SIDES, normal_axis
from dembound.boundaries.exposed import exposed, outer_row
from dembound.boundaries.support import Edge
from dembound.casefile.disks import DiskCase
from dembound.errors import CaseError
from dembound.packings.column import Seam
from dembound.packings.tiling import Assembly


def find_edges(assembly: Assembly, periodic: tuple[bool, bool], regular_sides: tuple[str, ...] = ()) -> dict[str, Edge]:
    """The exposed particles of every side that is not periodic; for regular sides, the particles of the outer row."""
    edges = {}
    for side in SIDES:
        axis = normal_axis(side)
        if periodic[axis]:
            continue
        length = float(assembly.extent[1 - axis])
        if side in regular_sides:
            nodes = outer_row(assembly.positions, assembly.radii, side)
        else:
            nodes = exposed(assembly.positions, assembly.radii, side, period=length if periodic[1 - axis] else None)
        edges[side] = Edge(side, nodes, assembly.positions[nodes], 2.0 * assembly.radii[nodes], length)
    return edges


def require_held(case: DiskCase, edges: Mapping[str, Edge]) -> None:
    """Raise CaseError for platens that hold no disk."""
    static = {} if case.static is None else case.static.boundary
    for place, tables in (("boundary", case.boundary), ("static.boundary", static)):
        for side, table in tables.items():
            if side in edges and len(table.part_of(edges[side]).nodes) == 0:
                raise CaseError([f"{place}.{side}.within: no disk of this side is centred in it; make it wider"])


def edge_without(edge: Edge, kept: np.ndarray) -> Edge:
    """A side with the kept particles (m,) bool only; their shares of its length do not change."""
    still = np.isin(edge.nodes, kept)
    if not still.any():
        raise CaseError(
            [
                f"hole: holes remove all {len(edge.nodes)} particles that make up the {edge.side} side, so boundary."
                f"{edge.side} acts on nothing; make them smaller, or let packing.size end where they begin"
            ]
        )
    diameters = edge.diameters[still]
    length = edge.length * float(diameters.sum() / edge.diameters.sum())
    return Edge(edge.side, np.searchsorted(kept, edge.nodes[still]), edge.positions[still], diameters, length)


def edges_beside_column(assembly: Assembly, seam: Seam, edges: Mapping[str, Edge]) -> dict[str, Edge]:
    """The sides of a body with its free-field column: bottom and top include the column, left and right do not.

    The disks visible from below or above are determined in the column, as if there were no sides, so that every disk of
    the body is supported like its twin.
    """
    column = np.arange(len(assembly.radii)) < seam.count
    joint = {}
    for side, edge in edges.items():
        nodes, length = edge.nodes + seam.count, edge.length
        if edge.axis == 1:
            alone = exposed(assembly.positions[column], assembly.radii[column], side, period=seam.width)
            nodes = np.flatnonzero(np.isin(seam.twin, alone))
            length += seam.width
        joint[side] = Edge(side, nodes, assembly.positions[nodes], 2.0 * assembly.radii[nodes], length)
    return joint
