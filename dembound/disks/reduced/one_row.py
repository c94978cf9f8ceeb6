"""One of the rows of a scene, stepped in place of all of them: each row is one brick wide and moves like the others."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.boundaries.half_mass import mass_factor
from dembound.boundaries.support import Supports
from dembound.disks.beyond.edges import find_edges
from dembound.disks.body import parts_of
from dembound.disks.contact_types import with_half_contacts, with_layers
from dembound.disks.contacts.layout import lay_out
from dembound.disks.ram import run_bytes
from dembound.disks.scene import DiskScene
from dembound.packings.tiling import Assembly, tile


@dataclass(frozen=True, kw_only=True)
class OneRow(DiskScene):
    """A row of m of the n disks of a scene, which is periodic across the row.

    Attributes
    ----------
    of : the scene of the case.
    axis : the axis across the row.
    like : (n,) the disk of the row that moves like each disk of the case's scene.
    load : (3, m) N and N·m, steady forces and moments.
    """

    of: DiskScene
    axis: int
    like: np.ndarray
    load: np.ndarray

    @property
    def probes(self) -> np.ndarray:
        """Disks (p,) whose motion is recorded, in place of the probes of the case's scene."""
        return self.like[self.of.probes]

    def observed(self, record: np.ndarray, times: np.ndarray) -> np.ndarray:
        """The motion of the monitors."""
        return self.of.observed(record, times)

    @property
    def whole(self) -> DiskScene:
        """The scene of the case."""
        return self.of

    @property
    def uniform_axes(self) -> tuple[int, ...]:
        """The axis along which the motion of the case's scene does not vary."""
        return (self.axis,)

    @property
    def reduced(self) -> tuple[str, ...]:
        """Text with the number of rows, and of disks that need not be stepped."""
        rows = self.of.assembly.copies[self.axis]
        return (f"rows: {rows:,} identical rows are stepped as one, {self.count:,} of {self.of.count:,} disks",)

    @cached_property
    def weight(self) -> float:  # type: ignore[override]  # 1 for other scenes
        """Mass of the case's scene over the mass of the row."""
        return float(self.of.mass.sum() / self.mass.sum())

    def widened(self, name: str, values: np.ndarray) -> np.ndarray:
        """Values (m, …) of the row's disks, expanded to all disks of the case; name : of the quantity."""
        return values[self.like]

    def side_peaks(self, side: str, peaks: np.ndarray) -> np.ndarray:
        """Peaks at a side of the whole scene, see `Scene.side_peaks`."""
        return self.of.side_peaks(side, peaks[np.searchsorted(self.tracked, self.like[self.of.tracked])])

    @cached_property
    def steady_load(self) -> np.ndarray:
        """Forces and moments (3, m) N, N·m of the loads without a wave."""
        return self.load

    @cached_property
    def tracked(self) -> np.ndarray:
        """Disks (q,) that move like any disk of a side of the whole scene."""
        return np.unique(self.like[self.of.tracked])

    @property
    def largest_memory(self) -> float:
        """Largest RAM (bytes) of a run of the row, with the case's scene kept."""
        return run_bytes(self.case, [self.of.sizes, self.sizes])


def one_row(scene: DiskScene, axis: int) -> OneRow | None:
    """The middle one of the rows of bricks that a scene has along an axis; None if they differ in their disks.

    Whether the others move as it does remains to be checked (reduction.py).
    """
    case, copies, brick = scene.case, [*scene.assembly.copies], scene.ground.brick
    rows, copies[axis] = copies[axis], 1
    periodic = [case.side("left").is_periodic, case.side("bottom").is_periodic]
    periodic[axis] = True
    low = scene.low + np.eye(2)[axis] * (rows // 2) * brick.size
    row = tile(brick, (copies[0], copies[1]), (periodic[0], periodic[1]), (float(low[0]), float(low[1])))
    like = _counterparts(scene.assembly, row, axis)
    if like is None or (np.bincount(like, minlength=len(row.radii)) != rows).any():
        return None
    middle = np.flatnonzero(scene.assembly.tile[:, axis] == rows // 2)
    place = np.empty_like(middle)  # of each disk of the row in the scene
    place[like[middle]] = middle
    edges = find_edges(row, (periodic[0], periodic[1]), case.packing.regular_sides)
    row, _ = with_half_contacts(case, brick, row, None, edges)
    row, _ = with_layers(scene.ground, replace(row, positions=scene.positions[place]), None)
    fraction = mass_factor(len(place), edges, case.boundary)
    slots, contacts = lay_out(row, scene.ground, parts_of(len(place), None), fraction, by_level=scene.ground.is_layered)
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
    """For each disk (n,) the row's disk that is a copy of the same brick disk; None if any disk has none."""
    along, kinds = 1 - axis, int(assembly.brick_particle.max()) + 1
    requested, there = (each.tile[:, along].astype(np.int64) * kinds + each.brick_particle for each in (assembly, row))
    order = np.argsort(there)
    found = order[np.searchsorted(there, requested, sorter=order).clip(max=len(order) - 1)]
    return found if (there[found] == requested).all() else None


def _supports_at(place: np.ndarray, table: Supports, share: np.ndarray) -> Supports:
    """The support table of the nodes `place` (m,), numbered in this order.

    share : (m,) factors of the forces on them, equal to those of their masses.
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
