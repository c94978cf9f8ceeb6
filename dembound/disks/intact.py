"""The disks beside the sides of a body whose bonds do not break, so that forces at rest always act on held ground."""

from collections.abc import Mapping

import numpy as np

from dembound.boundaries.edge import SIDES, Edge
from dembound.casefile.disks import DiskCase
from dembound.errors import CaseError
from dembound.packings.brick import Brick
from dembound.packings.cut import cut_contacts
from dembound.packings.tiling import Assembly

MOST = 0.5
"""Largest share of the disks of a body that may be in intact zones."""


def intact_zones(
    case: DiskCase, brick: Brick, assembly: Assembly, edges: Mapping[str, Edge], first: int
) -> dict[str, np.ndarray]:
    """The disks (k,) of each zone by side, numbered as in the assembly, of which the body's begin with `first`.

    The disks at a side, which are the first of a zone, are those that are exposed there or have contacts beyond it.
    """
    depths, count = case.intact, len(assembly.radii)
    if not depths:
        return {}
    cut = cut_contacts(brick, assembly.part(slice(first, count)), tuple(depths), case.periodic)
    zones, pairs = {}, assembly.pairs
    for side, depth in depths.items():
        inside = np.zeros(count, dtype=np.bool_)
        if side in edges:
            inside[edges[side].nodes] = True
        inside[:first] = False
        inside[first + cut.node[cut.side == SIDES.index(side)]] = True
        for _ in range(depth - 1):
            inside[pairs[inside[pairs].any(axis=1)].ravel()] = True
        zones[side] = np.flatnonzero(inside)
    return zones


def intact_disks(case: DiskCase, zones: Mapping[str, np.ndarray], count: int, first: int) -> np.ndarray | None:
    """Whether the bonds of each of `count` disks never break, (count,); None if all may.

    A free-field column, of the first disks, is intact as a whole.
    """
    if not zones:
        return None
    inside = np.zeros(count, dtype=np.bool_)
    inside[np.concatenate(list(zones.values()))] = True
    if any(side in case.column_sides for side in zones):
        inside[:first] = True
    return inside


def require_room(case: DiskCase, zones: Mapping[str, np.ndarray], count: int) -> None:
    """Raise CaseError if the zones cover more than half of the `count` disks of a body."""
    inside = len(np.unique(np.concatenate([np.zeros(0, np.int64), *zones.values()])))
    if inside > MOST * count:
        keys = " and ".join(f"boundary.{side}.intact" for side in zones)
        depths = " and ".join(str(case.intact[side]) for side in zones)
        said = f"{keys}: {'is' if len(zones) == 1 else 'are'} {depths}: bonds of {inside:,} of {count:,} disks would"
        more = "more than half of the body; take a larger body, or give 0 where they may break"
        raise CaseError([f"{said} not break, {more}"])
