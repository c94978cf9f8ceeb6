"""One of the rows of a scene, stepped in place of all of them: each row is one brick wide and moves like the others."""

from dataclasses import dataclass, replace

import numpy as np

from dembound.boundaries.half_mass import mass_factor
from dembound.disks.beyond.edges import find_edges
from dembound.disks.body import parts_of
from dembound.disks.contacts.layout import lay_out
from dembound.disks.reduced.smaller import SmallerScene, supports_at
from dembound.disks.scene import DiskScene, with_half_contacts
from dembound.packings.tiling import Assembly, tile


@dataclass(frozen=True, kw_only=True)
class OneRow(SmallerScene):
    """A row of m of the n disks of a scene, which is periodic across the row.

    Attributes
    ----------
    axis : the axis across the row.
    """

    axis: int

    @property
    def uniform_axes(self) -> tuple[int, ...]:
        """Axes along which all of the scene of the case moves alike."""
        return (*self.of.uniform_axes, self.axis)

    @property
    def saved(self) -> str:
        """Number of rows, and of disks that need not be stepped."""
        rows = self.of.assembly.copies[self.axis]
        return f"rows: {rows:,} identical rows are stepped as one, {self.count:,} of {self.of.count:,} disks"

    def differs(self, what: str) -> str:
        """In words, that something of the rows, in the plural, is not the same in all of them."""
        return f"rows along {'yx'[self.axis]} differ in their {what}"


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
        supports=supports_at(place, scene.supports, share),
        monitors={name: int(like[node]) for name, node in scene.monitors.items()},
        slots=slots,
        of=scene,
        axis=axis,
        like=like,
        place=place,
        load=share * scene.steady_load[:, place],
        still=np.zeros((3, len(place)), dtype=np.bool_),
    )


def _counterparts(assembly: Assembly, row: Assembly, axis: int) -> np.ndarray | None:
    """Of each disk (n,) the row's disk that is a copy of the same one in the same brick; None where one has none."""
    along, kinds = 1 - axis, int(assembly.brick_particle.max()) + 1
    wanted, there = (each.tile[:, along].astype(np.int64) * kinds + each.brick_particle for each in (assembly, row))
    order = np.argsort(there)
    found = order[np.searchsorted(there, wanted, sorter=order).clip(max=len(order) - 1)]
    return found if (there[found] == wanted).all() else None
