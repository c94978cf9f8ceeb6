"""The time step of a case of disks, from small pieces of the same ground, which serve all cases.

A lattice of larger disks has steps longer by the ratio of the diameters, as all stiffnesses and masses of a plane body
scale alike. Beside a continuum the light nodes at the edges of its elements limit the step, by the ties that pull them:
by how much depends only on the sides of the elements in bricks, and on where bricks meet the nodes. It is found on a
box of a few elements.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import NamedTuple

from dembound.boundaries import Boundary, Periodic
from dembound.boundaries.edge import SIDES, normal_axis
from dembound.boundaries.outside import Outside
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.ground import Ground
from dembound.casefile.disks.outside import OutsideTable
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import build
from dembound.disks.stability import own_step, step_limit
from dembound.errors import DemboundError
from dembound.packings import Packing

LEAST, NARROW = 4, 10
"""Fewest disks along a periodic piece, as those of a square lattice move against their neighbours in the fastest
motion; copies of the brick across a body below which its free edges make steps longer, by 1 % or more."""

LAYERS = 2
"""Elements that absorb beyond each side of a piece."""

MOST = 4
"""Largest number of elements along a piece whose bricks meet nodes as in the case; with more, bricks are everywhere
beside them, nearly as with so many."""

FINE, WIDE, COARSE = 12.0, 24.0, 1.15
"""Sides of elements, in diameters, from which on it hardly matters where bricks meet nodes, and from which on steps
grow by less than 1 %; ratio of the sides between both for which there are pieces."""


class Along(NamedTuple):
    """Numbers of bricks and elements along an axis."""

    bricks: int
    elements: int

    def shorter(self, brick: float) -> Along:
        """The numbers along a short piece in which bricks, `brick` diameters long, meet nodes in the same way."""
        ratio = Fraction(self.bricks, self.elements)
        if (side := float(ratio) * brick) > FINE:
            side = min(FINE * COARSE ** round(math.log(side / FINE, COARSE)), WIDE)
            bricks = max(1, round(side / brick))
            return Along(bricks, max(1, round(bricks * brick / side)))
        if ratio.denominator > MOST:
            tried = [Fraction(bricks, MOST) for bricks in _beside(ratio * MOST)]
            tried += [Fraction(bricks, MOST - 1) for bricks in _beside(ratio * (MOST - 1))]
            ratio = min((each for each in tried if each.denominator >= MOST - 1), key=lambda each: abs(each - ratio))
        times = 2 if ratio.denominator == 1 else 1
        return Along(times * ratio.numerator, times * ratio.denominator)


def _beside(number: Fraction) -> range:
    """Whole numbers about a number, from one on."""
    return range(max(1, math.floor(number) - 1), math.ceil(number) + 2)


@dataclass
class Steps:
    """Time steps of cases that differ from a given one in the size of their disks, their sides and continuum.

    case, ground : given. limits : stability limits of pieces of the given ground, s, by properties of the piece.
    """

    case: DiskCase
    ground: PackedMaterial
    limits: dict[tuple[object, ...], float] = field(default_factory=dict)

    def of(self, case: DiskCase, element: tuple[float, float] | None) -> float:
        """The step (s) of a case whose continuum has elements of a width and height (m); None: it has none.

        Raises CaseError for an automatic step where nothing can vibrate.
        """
        limit = self._inside(case)
        if element is not None:
            limit = min(limit, self._in_continuum(case, element))
        return own_step(case, case.packing.radius / self.case.packing.radius * limit)

    def _inside(self, case: DiskCase) -> float:
        """Stability limit (s) of the given ground inside a body; of a narrow one also by its long sides."""
        least = max(1, math.ceil(LEAST / math.sqrt(len(self.ground.brick.radii))))
        is_narrow = [
            count < NARROW and not wraps for count, wraps in zip(case.packing.copies, case.periodic, strict=True)
        ]
        copies = [count if one else least for count, one in zip(case.packing.copies, is_narrow, strict=True)]
        if all(is_narrow) or len(self.ground.brick.radii) > 1:
            is_narrow, copies = [False, False], [least, least]
        sides: dict[str, Boundary] = {}
        for side in SIDES:
            table = case.side(side)
            if not is_narrow[normal_axis(side)]:
                sides[side] = Periodic(type="periodic")
            elif not table.is_artificial and not table.is_free:
                sides[side] = table.at_rest()
        return self._limit((*copies, *is_narrow, *map(repr, sides.values())), copies, sides)

    def _in_continuum(self, case: DiskCase, element: tuple[float, float]) -> float:
        """Stability limit (s) of the given ground in a continuum with as many elements for each brick."""
        packing, outside = case.packing, case.outside
        brick = [length / self.ground.brick.mean_diameter for length in self.case.packing.brick_size]
        along = [
            Along(count, max(1, round(length / side))).shorter(each)
            for count, length, side, each in zip(packing.copies, packing.extent, element, brick, strict=True)
        ]
        sizes = zip(along, self.case.packing.brick_size, strict=True)
        side = max(each.bricks * own / each.elements for each, own in sizes)
        table = OutsideTable(
            order=outside.order,
            element=side * (1.0 + 1e-9),
            margin=1,
            layers=LAYERS,
            shift=outside.shift,
            delay=outside.delay,
            damping=outside.damping,
        )
        sides: dict[str, Boundary] = {
            each: Periodic(type="periodic") if case.periodic[normal_axis(each)] else Outside(type="outside")
            for each in SIDES
        }
        key = (*along, outside.order, outside.damping, outside.delay, case.periodic)
        return self._limit(key, [each.bricks for each in along], sides, table)

    def _limit(
        self,
        key: tuple[object, ...],
        copies: list[int],
        sides: Mapping[str, Boundary],
        outside: OutsideTable | None = None,
    ) -> float:
        """Stability limit (s) of `copies` bricks of the given ground, found once; infinite if they make no scene.

        Of layers that of the stiffest.
        """
        if key not in self.limits:
            piece = replace(
                self.case,
                packing=self._packing(*copies),
                boundary=sides,
                outside=outside or self.case.outside,
                ground=Ground(),
                hole=(),
                load=(),
                monitor=(),
                wave={},
                static=None,
                incident=None,
            )
            heights = [top - self.case.packing.radius for top in (self.case.box[3], *self.case.joints)]
            layers = [self.case.uniform_at(height).layer for height in heights]
            try:
                self.limits[key] = min(step_limit(build(replace(piece, layer=layer))) for layer in layers)
            except DemboundError:
                self.limits[key] = math.inf
        return self.limits[key]

    def _packing(self, across: int, up: int) -> Packing:
        """The given packing with other numbers of bricks, at the origin."""
        return self.case.packing.with_copies(across, up).model_copy(update={"origin": (0.0, 0.0)})
