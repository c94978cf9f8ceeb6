"""One of the rows of a scene, stepped in place of all of them: each row is one brick wide and moves like the others."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.boundaries.half_mass import mass_factor
from dembound.boundaries.support import Supports
from dembound.disks.body import parts_of
from dembound.disks.edges import find_edges
from dembound.disks.layout import lay_out
from dembound.disks.scene import DiskScene, with_half_contacts
from dembound.packings.tiling import Assembly, tile


@dataclass(frozen=True, kw_only=True)
class OneRow(DiskScene):
    """A row of m of the n disks of a scene, which is periodic across the row.

    Attributes
    ----------
    of : the scene.
    axis : the axis across the row.
    like : (n,) the row's disk at the place of each disk of the scene.
    load : (3, m) N and N·m, steady forces and moments.
    """

    of: DiskScene
    axis: int
    like: np.ndarray
    load: np.ndarray

    @property
    def whole(self) -> DiskScene:
        """The scene of the case."""
        return self.of

    @property
    def reduced(self) -> tuple[str, ...]:
        """Number of rows, and of disks that need not be stepped."""
        rows = self.of.assembly.copies[self.axis]
        return (f"rows: {rows:,} identical rows are stepped as one, {self.count:,} of {self.of.count:,} disks",)

    @cached_property
    def weight(self) -> float:  # type: ignore[override]  # 1 for other scenes
        """Mass of the whole scene over that of the row."""
        return float(self.of.mass.sum() / self.mass.sum())

    def widened(self, values: np.ndarray) -> np.ndarray:
        """Values (m, …) of the row as those of all disks (n, …)."""
        return values[self.like]

    @cached_property
    def steady_load(self) -> np.ndarray:
        """(3, m) forces and moments (N, N·m) of the loads without a wave."""
        return self.load

    @cached_property
    def tracked(self) -> np.ndarray:
        """(q,) those at the place of any disk of a side of the whole scene."""
        return np.unique(self.like[self.of.tracked])

    def tracked_of(self, side: str) -> np.ndarray:
        """Where the disks of a side of the whole scene are in `tracked`."""
        return np.searchsorted(self.tracked, self.like[self.of.edges[side].nodes])

    @property
    def bytes(self) -> int:
        """Memory of the row and of the whole scene, whose stability limit is that of the step."""
        return super().bytes + self.of.bytes


def one_row(scene: DiskScene, axis: int) -> OneRow | None:
    """The middle one of the rows of bricks that a scene has along an axis; None if they differ in their disks.

    Whether the others move as it does remains to be checked (reduction.py).
    """
    case, copies, brick = scene.case, [*scene.assembly.copies], scene.ground.brick
    rows, copies[axis] = copies[axis], 1
    periodic = [case.side("left").is_periodic, case.side("bottom").is_periodic]
    periodic[axis] = True
    row = tile(brick, (copies[0], copies[1]), (periodic[0], periodic[1]))
    like = _counterparts(scene.assembly, row, axis)
    if like is None or (np.bincount(like, minlength=len(row.radii)) != rows).any():
        return None
    middle = np.flatnonzero(scene.assembly.tile[:, axis] == rows // 2)
    place = np.empty_like(middle)  # of each disk of the row in the scene
    place[like[middle]] = middle
    edges = find_edges(row, (periodic[0], periodic[1]), case.packing.regular_sides)
    row, _ = with_half_contacts(case, brick, row, None, edges)
    row = replace(row, positions=scene.positions[place])
    fraction = mass_factor(len(place), edges, case.boundary)
    slots, contacts = lay_out(row, scene.ground, parts_of(len(place), None), fraction)
    share = fraction / scene.cell_fraction[place]
    return OneRow(
        case=case,
        ground=scene.ground,
        assembly=row,
        rows=contacts,
        edges=edges,
        supports=_supports_at(place, scene.supports, share),
        monitors={name: int(like[node]) for name, node in scene.monitors.items()},
        slots=slots,
        of=scene,
        axis=axis,
        like=like,
        load=share * scene.steady_load[:, place],
    )


def _counterparts(assembly: Assembly, row: Assembly, axis: int) -> np.ndarray | None:
    """Of each disk (n,) the row's disk that is a copy of the same one in the same brick; None where one has none."""
    along, kinds = 1 - axis, int(assembly.brick_particle.max()) + 1
    wanted, there = (each.tile[:, along].astype(np.int64) * kinds + each.brick_particle for each in (assembly, row))
    order = np.argsort(there)
    found = order[np.searchsorted(there, wanted, sorter=order).clip(max=len(order) - 1)]
    return found if (there[found] == wanted).all() else None


def _supports_at(place: np.ndarray, table: Supports, share: np.ndarray) -> Supports:
    """The support table of some nodes, place (m,), numbered in this order.

    share : (m,) factors of the forces on them, those of their masses.
    """
    order = np.argsort(place)
    near = order[np.searchsorted(place, table.node, sorter=order).clip(max=len(order) - 1)]
    kept = np.flatnonzero(place[near] == table.node)
    kept = kept[np.lexsort((table.component[kept], near[kept]))]
    node, prescribed = near[kept], table.prescribed[kept]
    line = np.full(len(table), -1)
    line[kept] = np.arange(len(kept))
    drives = np.flatnonzero(line[table.drive_row] >= 0)
    drive_row = line[table.drive_row[drives]]
    return Supports(
        node=node,
        component=table.component[kept],
        damping=share[node] * table.damping[kept],
        follow=share[node] * table.follow[kept],
        stiffness=share[node] * table.stiffness[kept],
        prescribed=prescribed,
        drive_row=drive_row,
        drive=np.where(prescribed, 1.0, share[node])[drive_row] * table.drive[drives],
        drive_signal=table.drive_signal[drives],
        signals=table.signals,
    )
