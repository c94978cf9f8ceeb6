"""The base of all packing tables."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Self

from pydantic import Field

from dembound.errors import CaseError
from dembound.packings.brick import Brick
from dembound.packings.dense import Recipe, radius_range
from dembound.table import LARGEST_WHOLE, Box, Table, quantity
from dembound.words import with_unit

MOST_DISKS = 500_000_000
"""Largest number of disks of a scene: the ends of their contacts, 4.4 each, are numbered with 32 bits."""

Extent = tuple[Annotated[float, Field(gt=0.0)], Annotated[float, Field(gt=0.0)]]
Count = tuple[Annotated[int, Field(ge=1, le=MOST_DISKS)], Annotated[int, Field(ge=1, le=MOST_DISKS)]]

TYPED = 5e-6
"""Relative difference allowed between a size and whole bricks: sizes may have six digits, as 5.19615 m for 3√3 m."""

MOST_IN_BRICK = 1_000_000
"""Largest number of disks of a random brick, which takes hours to pack; scenes are made of many bricks."""

# Confining stress over contact modulus if the case gives none: 4.5 contacts per disk, and eight times the stress ρcv of
# a wave of 0.5 m/s at 1000 m/s.
PRESSURE = 8e-3
# Below, overlaps are 1e-5 of the diameter and the packing is as loose as frictionless disks can be; above, overlaps
# reach a tenth of the diameter and are no longer contacts.
PRESSURES = (1e-5, 0.1)

# Equal disks form crystals, which fall apart along their edges when the pressure falls.
LOOSEST_EQUAL, LEAST_RATIO = 5e-4, 1.1

SIZE = "size of a particle"
"""Meaning of keys that are sizes of disks."""

SOLID, CONTACTS, MOST_CONTACTS = 0.85, 2.23, 3.0
"""Solid fraction and contacts for each disk of random packings; between neighbours in a plane there are at most three.
"""


class Packing(Table, ABC):
    """The disks, in whole bricks that fill a rectangle; its extent is given by `size` or by `bricks`.

    Attributes
    ----------
    is_lattice : whether all disks are equal and have the same surroundings, so that they represent the ground, as disks
    of other sizes do; else, as for random packings, the packing is one of many of the same ground.
    packed_under_stress : whether a brick is packed under stress, which needs contacts with a stiffness.
    regular_sides : sides (left, right, bottom, top) whose disks form one row, so that they can be half cells.
    """

    is_lattice: ClassVar[bool] = False
    packed_under_stress: ClassVar[bool] = False
    regular_sides: ClassVar[tuple[str, ...]] = ()

    pattern: str
    size: Extent | None = quantity(None, unit="m", means="length")
    """width and height of the scene, whole bricks"""
    bricks: Count | None = quantity(None, means="count")
    """number of bricks along x and y, instead of size"""
    origin: tuple[float, float] = quantity((0.0, 0.0), unit="m", means="place")
    """lower left corner of the disks; all places of a case are in these coordinates"""
    radius: float = quantity(unit="m", means=SIZE, gt=0.0)
    """radius, mean of a random packing"""

    @property
    @abstractmethod
    def brick_size(self) -> tuple[float, float]:
        """Width and height of one brick in metres."""

    @abstractmethod
    def pack(self, contact_modulus: float) -> Brick:
        """The brick, packed for disks of contact modulus E_c (Pa), see `Brick`."""

    @property
    def copies(self) -> tuple[int, int]:
        """Number of bricks along x and y."""
        if self.bricks is not None:
            return self.bricks
        assert self.size is not None
        width, height = (round(whole / part) for whole, part in zip(self.size, self.brick_size, strict=True))
        return width, height

    @property
    def expected_disks(self) -> float:
        """Number of disks expected, to compute the RAM of a case: random ones fill 0.85 of the area, see `first_count`.

        Disks that close a frame are not counted.
        """
        width, height = self.extent
        return SOLID * width * height / (math.pi * self.radius**2)

    @property
    def expected_contacts(self) -> float:
        """Contacts per disk expected, to compute the RAM of a case."""
        return CONTACTS

    @property
    def extent(self) -> tuple[float, float]:
        """Width and height of the scene in metres."""
        if self.size is not None:
            return self.size
        (across, up), (width, height) = self.copies, self.brick_size
        return across * width, up * height

    @property
    def span(self) -> float:
        """The larger of width and height of the scene in metres, see `edges.includes`."""
        return max(self.extent)

    @property
    def box(self) -> Box:
        """Left, bottom, right and top of the disks' box in metres."""
        (left, bottom), (width, height) = self.origin, self.extent
        return left, bottom, left + width, bottom + height

    def gaps(self, ground: Box) -> dict[str, float]:
        """Distance (m) by which the ground goes on beyond each side of the box, without sides at its end."""
        (left, bottom, right, top), own = ground, self.box
        gaps = {"left": own[0] - left, "right": right - own[2], "bottom": own[1] - bottom, "top": top - own[3]}
        return {side: gap for side, gap in gaps.items() if gap > TYPED * max(right - left, top - bottom)}

    def about(self, extent: tuple[float, float]) -> float:
        """Number of disks in a rectangle of this width and height (m), within some per cent."""
        return extent[0] / (2.0 * self.radius) * (extent[1] / (2.0 * self.radius))

    def apart(self, axis: int, place: float) -> float:
        """Distance (m) of a wall across an axis from the nearest plane between disks; 0 beyond the box.

        place : of the wall along the axis, m. By default half a diameter on a lattice, which may have no such planes;
        walls in random packings are assumed to be between disks.
        """
        inside = self.box[axis] < place < self.box[2 + axis]
        return self.radius if self.is_lattice and inside else 0.0

    def scaled(self, factor: float) -> dict[str, float]:
        """The keys for disks of another size, with their values: all sizes of particles times a factor."""
        return {key: factor * value for key, value in self.given().items() if self.described(key).get("means") == SIZE}

    def reseeded(self, by: int) -> Self | None:
        """Another random packing of the same ground, with a seed larger by `by`; None, the default, for others."""
        return None

    def with_copies(self, across: int, up: int) -> Self:
        """The packing with other numbers of bricks along x and y."""
        return self.model_copy(update={"size": None, "bricks": (across, up)})

    def larger(self, factor: float) -> dict[str, Any]:
        """The keys of the packing with disks larger by a factor, in the same extent."""
        packing: dict[str, Any] = {key: value for key, value in self.given().items() if key != "bricks"}
        sizes = {key: float(f"{length:.15g}") for key, length in self.scaled(factor).items()}
        return packing | {"size": [round(length, 10) for length in self.extent], **sizes}

    def mistakes(self) -> Iterator[str]:
        """An extent that is not given once, or is not of whole bricks, or too many disks."""
        if (self.size is None) == (self.bricks is None):
            yield "must have exactly one of size (m) and bricks (numbers), the extent of the scene"
            return
        if (count := self.about(self.extent)) > MOST_DISKS:
            key = "bricks" if self.size is None else "size"
            yield f"{key}: holds {count:.3g} disks of this radius, must hold at most {MOST_DISKS:,}"
            return
        for whole, part in zip(self.extent, self.brick_size, strict=True):
            number = whole / part
            if number < 1.0 - TYPED or abs(number - round(number)) > TYPED * number:
                below, above = part * int(number), part * (int(number) + 1)
                would = f"{below:.10g} or {above:.10g}" if below > 0.0 else f"{above:.10g}"
                yield f"size: {whole:.10g} m is not a whole number of bricks of {part:.10g} m; {would} would be"


class DensePacking(Packing):
    """A random dense packing in a periodic brick, packed under an isotropic pressure."""

    packed_under_stress: ClassVar[bool] = True

    radius_ratio: float = quantity(means="ratio of radii", ge=1.0, le=4.0)
    """largest over smallest radius"""
    brick: Extent = quantity(unit="m", means="length")
    """width and height of the periodic brick"""
    seed: int = quantity(0, means="count", ge=0, le=LARGEST_WHOLE)
    """seed of the random start"""
    confining_stress: float | None = quantity(None, unit="Pa", means="stress", gt=0.0)
    """pressure of packing, 1e-5 to 0.1 of the contact modulus; absent: 8e-3 of it"""
    bond_gap: float = quantity(0.0, unit="m", means="length", ge=0.0)
    """gaps up to this are contacts, too"""

    @property
    def brick_size(self) -> tuple[float, float]:
        """Width and height of one brick in metres."""
        return self.brick

    @property
    def expected_disks(self) -> float:
        """Expected number of disks whose radii are uniform within their range."""
        smallest, largest = radius_range(self.radius, self.radius_ratio)
        return super().expected_disks * self.radius**2 * 3.0 / (smallest**2 + smallest * largest + largest**2)

    @property
    def expected_contacts(self) -> float:
        """Contacts per disk expected: more where gaps are bonded."""
        return MOST_CONTACTS if self.bond_gap > 0.0 else CONTACTS

    @property
    def largest_radius(self) -> float:
        """Radius of the largest disk in metres."""
        return radius_range(self.radius, self.radius_ratio)[1]

    def reseeded(self, by: int) -> Self:
        """The packing with a seed larger by a number."""
        return self.model_copy(update={"seed": self.seed + by})

    def recipe(self, contact_modulus: float) -> Recipe:
        """All parameters of the brick, for disks of contact modulus E_c (Pa).

        Raises CaseError when the confining stress is outside 1e-5 … 0.1 of the contact modulus, or below 5e-4 of it
        for nearly equal disks.
        """
        low, high = PRESSURES
        pressure = PRESSURE if self.confining_stress is None else self.confining_stress / contact_modulus
        if not low <= pressure <= high:
            given, least, most, modulus = (
                with_unit(share * contact_modulus, "Pa") for share in (pressure, low, high, 1.0)
            )
            what = f"packing.confining_stress: {given} is {pressure:.2g} of the contact modulus {modulus}"
            raise CaseError([f"{what}; {low:g} to {high:g} of it ({least} to {most}) can be packed"])
        if pressure < LOOSEST_EQUAL and self.radius_ratio < LEAST_RATIO:
            must = f"must be at least {LEAST_RATIO:g} for a confining stress below {LOOSEST_EQUAL:g}"
            reason = "of the contact modulus: nearly equal disks form crystals, which fall apart"
            raise CaseError([f"packing.radius_ratio: is {self.radius_ratio:g}, {must} {reason}"])
        return Recipe(
            size=self.brick,
            radius=self.radius,
            radius_ratio=self.radius_ratio,
            pressure=pressure,
            bond_gap=self.bond_gap,
            seed=self.seed,
        )

    def mistakes(self) -> Iterator[str]:
        """A brick that is too large or too small, or gaps that are too wide."""
        yield from super().mistakes()
        if (count := self.about(self.brick)) > MOST_IN_BRICK:
            yield f"brick: holds {count:.3g} disks of this radius, must hold at most {MOST_IN_BRICK:,}"
        # below four diameters a disk could touch another one through two faces at once
        least = 8.0 * self.largest_radius
        if min(self.brick) < least:
            yield f"brick: {min(self.brick):g} m is too small, {least:.4g} m is the least for these disks"
        if self.bond_gap > self.radius:
            yield f"bond_gap: {self.bond_gap:g} m is larger than the mean radius {self.radius:g} m"
