"""The particles of the sides of a scene, also next to a free-field column, and bodies with holes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import chain

import numpy as np

from dembound.boundaries.edge import SIDES, Edge, exposed, normal_axis, outer_row
from dembound.casefile.disks.model import DiskCase
from dembound.errors import CaseError
from dembound.holes.hole import Floor, Hole
from dembound.packings.brick import Brick
from dembound.packings.column import Seam
from dembound.packings.cut import cut_contacts
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


def edge_without(edge: Edge, kept: np.ndarray, *, may_end: bool = False) -> Edge | None:
    """A side with the kept particles (m,) only; their shares of its length do not change.

    None if it has none left and may end, as nothing acts on it; else raises CaseError.
    """
    still = np.isin(edge.nodes, kept)
    if not still.any():
        if may_end:
            return None
        said = f"hole: holes remove all {len(edge.nodes)} particles that make up the {edge.side} side, so boundary."
        more = f"{edge.side} acts on nothing; make them smaller, or let packing.size end where they begin"
        raise CaseError([said + more])
    diameters = edge.diameters[still]
    length = edge.length * float(diameters.sum() / edge.diameters.sum())
    return Edge(edge.side, np.searchsorted(kept, edge.nodes[still]), edge.positions[still], diameters, length)


def edges_beside_columns(assembly: Assembly, seams: Sequence[Seam], edges: Mapping[str, Edge]) -> dict[str, Edge]:
    """The sides of a body with its free-field columns: bottom and top include the columns, left and right do not.

    The disks visible from below or above are determined in the columns, as if there were no sides, so that every disk
    of the body is supported like its twin. Beside two columns those visible from above are those of the body alone.
    """
    first, joint = seams[-1].disks.stop, {}
    for side, edge in edges.items():
        nodes, length = edge.nodes + first, edge.length
        if edge.axis == 1:
            each = []
            for seam in seams:
                places, radii = assembly.positions[seam.disks], assembly.radii[seam.disks]
                each.append(seam.disks.start + exposed(places, radii, side, period=seam.width))
            if side == "bottom" or len(seams) == 1:
                nodes = np.flatnonzero(np.isin(seams[0].twin, each[0]))
            nodes = np.unique(np.concatenate([nodes, *each[1:]]))
            length += sum(seam.width for seam in seams)
        joint[side] = Edge(side, nodes, assembly.positions[nodes], 2.0 * assembly.radii[nodes], length)
    return joint


BAND = 4.0
"""Least width, in diameters, of a floor beside a side with ground of that height beyond it."""

ON_IT = 1e-6
"""Part of a diameter by which a disk centred on a floor may be above it: rounding."""


def hollowed(
    case: DiskCase,
    brick: Brick,
    body: Assembly,
    edges: Mapping[str, Edge],
    holes: tuple[Hole, ...],
    floors: Mapping[str, Floor],
) -> tuple[Assembly, dict[str, Edge], np.ndarray]:
    """A body and its sides without the particles in holes, and the indices (m,) of the remaining particles.

    The surface of a hole is free: no particles are added to a side.

    floors : at left and right sides, left by these holes and by any made before.

    Raises CaseError for holes that reach a side beyond which the ground goes on, except for floors.
    """
    removed = np.logical_or.reduce([hole.takes(body.positions, case.packing.span) for hole in holes])
    left, kept = body.without(removed)
    beyond = {"free field": case.free_field_sides, "continuum": case.outside_sides}
    each = (_at_sides(case, brick, body, kept, holes, what, sides, floors) for what, sides in beyond.items())
    if problems := [*chain.from_iterable(each)]:
        raise CaseError(problems)
    acting: set[str] = {side for load in case.load for side in load.sides or ()}
    acting |= {side for side, table in case.boundary.items() if not table.is_free}
    if case.static is not None:
        acting |= {*case.static.boundary} | ({*SIDES} if case.static.stress is not None else set())
    found = {side: edge_without(edge, kept, may_end=side not in acting) for side, edge in edges.items()}
    return left, {side: edge for side, edge in found.items() if edge is not None}, kept


def _at_sides(
    case: DiskCase,
    brick: Brick,
    body: Assembly,
    kept: np.ndarray,
    holes: tuple[Hole, ...],
    beyond: str,
    sides: tuple[str, ...],
    floors: Mapping[str, Floor],
) -> list[str]:
    """Messages about holes that remove disks beside some sides, beyond which there is a free field or continuum.

    kept : (m,) indices of the disks that remain.
    """
    cut = cut_contacts(brick, body, sides, case.periodic)
    remains, diameter = np.isin(cut.node, kept), brick.mean_diameter
    wrong = np.zeros(len(cut.node), dtype=np.bool_)
    uneven = {}
    for number, side in enumerate(SIDES):
        here, up = cut.side == number, body.positions[cut.node, 1]
        lost = here & ~remains
        if (floor := floors.get(side)) is None:
            wrong |= lost
        elif floor.width < BAND * diameter:
            uneven[side] = floor
            wrong |= lost
        elif np.any(up[here & remains] > floor.height + ON_IT * diameter):
            wrong |= lost
        else:  # of random packings a floor also leaves disks without connection
            wrong |= lost & (up < floor.height - diameter)
    lost = cut.only(wrong)
    problems, inside = [], np.zeros(len(lost.node), dtype=np.bool_)
    for place, hole in case.named_holes:
        if hole in holes:
            taken = hole.takes(body.positions[lost.node], case.packing.span)
            problems += _mistakes(f"{place}: reaches", lost.side[taken], beyond, uneven, diameter)
            inside |= taken
    return problems or _mistakes("hole: cuts off disks at", lost.side[~inside], beyond, {}, diameter)


def _mistakes(what: str, sides: np.ndarray, beyond: str, uneven: Mapping[str, Floor], diameter: float) -> list[str]:
    """Messages about a hole at sides with numbers (k,); empty without mistakes. uneven : floors there, by side."""
    names = [SIDES[number] for number in np.unique(sides)]
    flat, others = [name for name in names if name in uneven], [name for name in names if name not in uneven]
    problems = [
        f"{what} boundary.{name}, beyond which the ground is level: beside it the hole must take all disks down to one "
        f"height, over at least {BAND * diameter:.4g} m (now {uneven[name].width:.3g} m at y = "
        f"{uneven[name].height:.4g} m); make it level there, or leave disks between them"
        for name in flat
    ]
    if others:
        problems.append(
            f"{what} {' and '.join(f'boundary.{name}' for name in others)}, where the {beyond} has no hole; leave "
            "disks between them: make the hole smaller, or the body larger (packing.size)"
        )
    return problems
