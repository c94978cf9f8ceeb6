"""Ground whose layers differ at the left and right of a vertical plane.

A disk belongs to the side that its centre is in. A contact across the plane has the springs of both sides in series, as
one across a joint. The plane is where the mass and the stiffness change within half a diameter; unlike at joints,
nothing corrects that, as waves from below run along it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, Self

import numpy as np

from dembound.disks.material.layered import LayeredGround, Zone, require_thick
from dembound.disks.material.packed_material import PackedMaterial

BESIDE = 4.0
"""Diameters of height up to which zones of either side that do not overlap may have contacts with each other."""


@dataclass(frozen=True)
class UnlikeGround(LayeredGround):
    """A brick in layers that differ left and right of a plane x = meet.

    Its zones, layers and joints are those of the left side and then those of the right one. Layers have the numbers of
    the case, in which common ones are of both sides.

    Attributes
    ----------
    sides : the ground of the left and of the right side everywhere. numbers : in the case, of the layers of each from
    the surface down. meet : m.
    """

    sides: tuple[LayeredGround, ...] = ()
    numbers: tuple[tuple[int, ...], ...] = ()
    meet: float = 0.0

    @classmethod
    def of(cls, sides: Sequence[LayeredGround], numbers: Sequence[Sequence[int]], meet: float) -> Self:
        """The ground of two sides that meet at x = meet (m)."""

        def renumbered(name: str) -> tuple[Zone, ...]:
            return tuple(
                zone._replace(layer=own[zone.layer])
                for side, own in zip(sides, numbers, strict=True)
                for zone in getattr(side, name)
            )

        slowest = min(sides, key=lambda each: float(np.nanmin([each.wave_speeds(axis) for axis in (0, 1)])))
        return cls(
            **{each.name: getattr(slowest, each.name) for each in fields(PackedMaterial) if each.init},
            zones=renumbered("zones"),
            layers=renumbered("layers"),
            joints=tuple(joint for side in sides for joint in side.joints),
            sides=tuple(sides),
            numbers=tuple(tuple(own) for own in numbers),
            meet=meet,
        )

    def beside(self, side: str) -> LayeredGround:
        """The ground of the left or right side, as if it were everywhere; its layers are numbered from its surface."""
        return self.sides[0 if side == "left" else 1]

    def at(self, height: float, x: float | None = None) -> PackedMaterial:
        """The material at a height and a place x, m. Raises ValueError without x where both sides differ."""
        if x is not None:
            return self.sides[int(self.is_right(np.array([x]))[0])].at(height)
        place = np.array([[0.0, height]])
        one, other = (own[side.layer_of(place)[0]] for side, own in zip(self.sides, self.numbers, strict=True))
        if one != other:
            raise ValueError(f"the ground at y = {height:g} m is not the same at both sides")
        return self.sides[0].at(height)

    @property
    def materials(self) -> tuple[PackedMaterial, ...]:
        """The materials of its layers in the order of the case, without corrections."""
        each = {zone.layer: zone.material for zone in self.layers}
        return tuple(each[number] for number in sorted(each))

    def _with(self, **damping: Any) -> Self:
        """The ground with other damping in all layers, see `PackedMaterial`."""
        return self.of([side._with(**damping) for side in self.sides], self.numbers, self.meet)

    def is_right(self, x: np.ndarray) -> np.ndarray:
        """Whether disks at places x (n,) m belong to the right side."""
        return np.asarray(x + self._rounding >= self.meet)

    def zone_of(self, places: np.ndarray) -> np.ndarray:
        """Number of the zone of disks at places (n, 2) m."""
        left, right = self.sides
        return np.where(self.is_right(places[:, 0]), len(left.zones) + right.zone_of(places), left.zone_of(places))

    @cached_property
    def _pairing(self) -> tuple[tuple[tuple[int, int], ...], np.ndarray]:
        """The pairings, and the number in them of every two zones, −1 for none."""
        found, first = [], 0
        for side in self.sides:
            found += [(first + a, first + b) for a, b in side.pairings]
            first += len(side.zones)
        near, split = BESIDE * self.brick.mean_diameter, len(self.sides[0].zones)
        for a in range(split):
            for b in range(split, first):
                one, other = self.zones[a], self.zones[b]
                if one.low < other.high + near and other.low < one.high + near:
                    found += [(a, b), (b, a)]
        number = np.full((first, first), -1)
        for k, (a, b) in enumerate(found):
            number[a, b] = k
        return tuple(found), number

    @property
    def pairings(self) -> tuple[tuple[int, int], ...]:
        """The zones of the first and second disk of contacts, in the order of the variants of the brick's contacts."""
        return self._pairing[0]

    def pairing_of(self, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        """Number (b,) in `pairings` of contacts between disks at places first and second (b, 2) m."""
        found: np.ndarray = self._pairing[1][self.zone_of(first), self.zone_of(second)]
        require_thick((found >= 0).all())
        return found

    def side_of_bricks(self, left: np.ndarray) -> np.ndarray:
        """A number (k,) of bricks from x = left (k,) m on: the same for those whose contacts are of one side alone."""
        reach = float(np.abs(self.brick.vectors[:, 0]).max())
        on_right, on_left = left - reach > self.meet, left + float(self.brick.size[0]) + reach < self.meet
        return np.where(on_right, 1, np.where(on_left, 0, 2 + np.arange(len(left))))
