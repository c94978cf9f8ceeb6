"""Bodies with holes: the disks in them are removed, but for those that the ground beyond a side holds."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from dembound.boundaries.sides import SIDES
from dembound.boundaries.support import Edge
from dembound.casefile.disks import DiskCase
from dembound.casefile.messages import numbered
from dembound.disks.edges import edge_without
from dembound.errors import CaseError
from dembound.holes import Hole
from dembound.packings.brick import Brick
from dembound.packings.cut import cut_contacts
from dembound.packings.tiling import Assembly


def hollowed(
    case: DiskCase, brick: Brick, body: Assembly, edges: Mapping[str, Edge], holes: tuple[Hole, ...]
) -> tuple[Assembly, dict[str, Edge], np.ndarray]:
    """A body and its sides without the particles in holes, and the indices (m,) of the remaining particles.

    The surface of a hole is free: no particles are added to a side.

    Raises CaseError for holes that reach a side beyond which the ground goes on.
    """
    removed = np.logical_or.reduce([hole.contains(body.positions) for hole in holes])
    left, kept = body.without(removed)
    beyond = {"free field": case.free_field_sides, "continuum": case.outside_sides}
    problems = [line for what in beyond for line in _at_sides(case, brick, body, kept, holes, what, beyond[what])]
    if problems:
        raise CaseError(problems)
    return left, {side: edge_without(edge, kept) for side, edge in edges.items()}, kept


def _at_sides(
    case: DiskCase,
    brick: Brick,
    body: Assembly,
    kept: np.ndarray,
    holes: tuple[Hole, ...],
    beyond: str,
    sides: tuple[str, ...],
) -> list[str]:
    """Mistakes of holes that take disks beside some sides, beyond which there is a free field or continuum.

    kept : (m,) indices of the disks that remain.
    """
    cut = cut_contacts(brick, body, sides, case.periodic)
    lost = cut.only(~np.isin(cut.node, kept))
    problems, inside = [], np.zeros(len(lost.node), dtype=np.bool_)
    for place, hole in numbered("hole", case.hole):
        if hole in holes:
            taken = hole.contains(body.positions[lost.node])
            problems += _mistake(f"{place}: reaches", lost.side[taken], beyond)
            inside |= taken
    return problems or _mistake("hole: cuts off disks at", lost.side[~inside], beyond)


def _mistake(what: str, sides: np.ndarray, beyond: str) -> list[str]:
    """The mistake of a hole at some sides, by their numbers (k,); none without any."""
    names = [f"boundary.{SIDES[number]}" for number in np.unique(sides)]
    if not names:
        return []
    return [
        f"{what} {' and '.join(names)}, where the {beyond} has no hole; leave disks between them: make the hole "
        "smaller, or the body larger (packing.size)"
    ]
