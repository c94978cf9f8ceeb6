"""The ``[bar]`` table, a straight bar that moves along its axis, and its ``[[bar.range]]`` tables."""

import math
from collections.abc import Iterator
from typing import Any, Literal

from pydantic import ValidationError, model_validator

from dembound.methods.rod import Fracture
from dembound.table import LARGEST, SMALLEST, FileName, Table, quantity


class BarRange(Table):
    """A part of a bar with its own length, spacing and material; keys that are left out have the value in `[bar]`.

    A contact at an interface opens where it would have to pull.
    """

    name: FileName = quantity()
    """name in messages and results"""
    length: float = quantity(unit="m", means="length", gt=0.0)
    """length of the range"""
    spacing: float | None = quantity(None, unit="m", means="length", gt=0.0)
    """distance of its nodes; its length is a whole number of them, two or more"""
    section: float | None = quantity(None, unit="m²", gt=0.0)
    """area of its cross-section"""
    diameter: float | None = quantity(None, unit="m", means="thickness", gt=0.0)
    """diameter of a round range, instead of section"""
    density: float | None = quantity(None, unit="kg/m³", gt=0.0)
    """density ρ"""
    wave_speed: float | None = quantity(None, unit="m/s", means="wave speed", gt=0.0)
    """speed c of its waves"""
    youngs_modulus: float | None = quantity(None, unit="Pa", means="modulus", gt=0.0)
    """Young's modulus E, instead of wave_speed"""
    strength: float | None = quantity(None, unit="Pa", means="strength", gt=0.0)
    """tensile strength σ_t"""
    critical_stretch: float | None = quantity(None, means="strain", gt=0.0)
    """stretch s₀ at which a bond breaks, instead of strength"""
    fracture_energy: float | None = quantity(None, unit="J/m²", gt=0.0)
    """fracture energy G_f of its cracks"""
    strength_per_decade: float | None = quantity(None, unit="Pa", means="strength", gt=0.0)
    """rise of its strength for a tenfold strain rate"""
    strength_rates: tuple[float, float] | None = quantity(None, unit="1/s")
    """strain rates [slowest, fastest] between which the strength rises"""
    attenuation: float | None = quantity(None, unit="1/m", ge=0.0)
    """α of its attenuation"""
    velocity: float = quantity(0.0, unit="m/s", means="velocity")
    """velocity at the start, positive to the right, as of a striker"""
    interface: Literal["bonded", "contact"] = quantity("bonded")
    """interface with the range on its left; a contact bears no tension"""
    gap: float = quantity(0.0, unit="m", means="gap", ge=0.0)
    """opening of the contact on its left at the start"""

    def mistakes(self) -> Iterator[str]:
        """A gap of ranges that are bonded."""
        if self.gap > 0.0 and self.interface != "contact":
            yield 'gap: is only allowed with interface = "contact"'


PAIRS = (("section", "diameter"), ("wave_speed", "youngs_modulus"), ("strength", "critical_stretch"))
"""Pairs of keys of which a bar may have only one."""

OF_RANGES = {"name", "velocity", "interface", "gap"}
"""Keys of a range that a uniform bar does not have."""

MOST_CELLS = 2_000_000
"""Largest number of cells: more is a mistake, and computing the stability limit alone would take minutes."""

COARSEST = 0.2
"""Largest spacing over the characteristic length EG_f/σ_t².

A spring then bears no more than a tenth of its elongation at the end, w_c, when it begins to open.
"""

ROUNDING = 1e-9
"""Tolerance of the comparison with the largest spacing, which is allowed."""


class Bar(Table):
    """A straight bar that moves along its axis, with nodes at x = 0, Δx, … L, and its material.

    The two nodes at the ends have half a volume. Without a strength or critical stretch nothing breaks.

    A bar with ranges is a row of uniform bars, for which its own keys are defaults.
    """

    length: float = quantity(None, unit="m", means="length", gt=0.0)
    """length L; with ranges it may be left out"""
    spacing: float = quantity(unit="m", means="length", gt=0.0)
    """distance Δx from node to node; L is a whole number of them, two or more"""
    section: float | None = quantity(None, unit="m²", gt=0.0)
    """area of the cross-section; absent: 1 m²"""
    diameter: float | None = quantity(None, unit="m", means="thickness", gt=0.0)
    """diameter of a round bar, instead of section"""
    density: float = quantity(unit="kg/m³", gt=0.0)
    """density ρ"""
    wave_speed: float | None = quantity(None, unit="m/s", means="wave speed", gt=0.0)
    """speed c of waves along the bar"""
    youngs_modulus: float | None = quantity(None, unit="Pa", means="modulus", gt=0.0)
    """Young's modulus E = ρc², instead of wave_speed; one of them is needed"""
    strength: float | None = quantity(None, unit="Pa", means="strength", gt=0.0)
    """tensile strength σ_t; absent: unbreakable"""
    critical_stretch: float | None = quantity(None, means="strain", gt=0.0)
    """stretch s₀ = σ_t/E at which a bond breaks, instead of strength"""
    fracture_energy: float | None = quantity(None, unit="J/m²", gt=0.0)
    """fracture energy G_f of cracks; absent: bonds break at once"""
    strength_per_decade: float | None = quantity(None, unit="Pa", means="strength", gt=0.0)
    """rise of the strength for a tenfold strain rate; needs fracture_energy"""
    strength_rates: tuple[float, float] | None = quantity(None, unit="1/s")
    """strain rates [slowest, fastest] between which it rises"""
    attenuation: float = quantity(0.0, unit="1/m", ge=0.0)
    """α: high frequencies fade by exp(−αx) over a distance x (L eq. 19)"""
    range: tuple[BarRange, ...] = quantity(())
    """parts of a bar of several materials, from left to right"""

    def mistakes(self) -> Iterator[str]:
        """Keys that are given twice or lack others, and mistakes of ranges."""
        for first, second in PAIRS:
            if getattr(self, first) is not None and getattr(self, second) is not None:
                yield f"{second}: is not allowed together with {first}"
        stiffness = list(self._problems_with_stiffness())
        yield from stiffness
        yield from self._problems_with_ranges() if self.range else self._problems_with_spacing()
        if not self.range and not stiffness:
            yield from list(self._problems_with_rates()) or self._problems_with_cracks()

    @model_validator(mode="after")
    def _as_long_as_its_ranges(self) -> "Bar":
        if self.range and "length" not in self.model_fields_set:
            self.__dict__["length"] = self._whole_length
        return self

    def _problems_with_stiffness(self) -> Iterator[str]:
        """No stiffness, or one outside the range of floating-point numbers."""
        key = "youngs_modulus" if self.wave_speed is None else "wave_speed"
        if self.wave_speed is None and self.youngs_modulus is None:
            yield "wave_speed: is missing; give either wave_speed or youngs_modulus"
        elif not SMALLEST < self.modulus < LARGEST or not SMALLEST < self.modulus / self.density < LARGEST:
            yield f"{key}: is {getattr(self, key):g}, with density {self.density:g} beyond any material"

    def _problems_with_spacing(self) -> Iterator[str]:
        """A spacing that does not divide the length, or too many cells."""
        if self.length is None:
            return  # which bar_problems reports, also beside other mistakes
        cells = self.length / self.spacing
        if cells > MOST_CELLS:
            yield f"spacing: is {self.spacing:g}, must cut the length, {self.length:g} m, into {MOST_CELLS:,} or less"
        elif cells < 1.5 or abs(cells - round(cells)) > 1e-6 * cells:
            yield (
                f"spacing: is {self.spacing:g}, must divide the length, {self.length:g} m, into two or more equal parts"
            )

    def _problems_with_rates(self) -> Iterator[str]:
        """Incomplete laws of strength over strain rate."""
        keys = ("strength_per_decade", "strength_rates")
        given = [key for key in keys if getattr(self, key) is not None]
        if given and self.fracture_energy is None:
            yield f"{given[0]}: needs fracture_energy, too"
        if len(given) == 1:
            (missing,) = set(keys) - set(given)
            yield f"{missing}: is missing; strength_per_decade and strength_rates are given together"
        if self.strength_rates is not None and not 0.0 < self.strength_rates[0] < self.strength_rates[1]:
            yield f"strength_rates: is {list(self.strength_rates)}, must be two rates above 0, the slower one first"

    def _problems_with_cracks(self) -> Iterator[str]:
        """A fracture energy without a strength, and too coarse a spacing for it."""
        if self.fracture_energy is None:
            return
        if self.strength is None and self.critical_stretch is None:
            yield "fracture_energy: needs strength or critical_stretch, at which a crack begins"
        elif self.spacing > (most := COARSEST * self.characteristic_length) * (1.0 + ROUNDING):
            yield (
                f"spacing: is {self.spacing:g}, must be at most {most:.6g} m, {COARSEST:g} EG_f/σ_t² at the largest "
                "strength, for cracks with this fracture_energy"
            )

    def _problems_with_ranges(self) -> Iterator[str]:
        """Mistakes of single ranges, and between ranges and the bar's own keys."""
        first: dict[str, int] = {}
        for number, given in enumerate(self.range, start=1):
            place = f"range[{number}, {given.name}]"
            if first.setdefault(given.name, number) != number:
                yield f"{place}.name: is taken by range[{first[given.name]}]"
            if number == 1 and given.interface == "contact":
                yield f'{place}.interface: is "contact", but no range is on its left'
            try:
                Bar(**self._keys_of(given))
            except ValidationError as error:
                for line in str(error.errors()[0]["ctx"]["error"]).splitlines():
                    yield f"{place}.{line}"
        whole = self._whole_length
        if "length" in self.model_fields_set and abs(self.length - whole) > 1e-9 * whole:
            yield f"length: is {self.length:g}, must be that of all ranges and gaps, {whole:.12g} m, or left out"
        if (cells := sum(each.length / (each.spacing or self.spacing) for each in self.range)) > MOST_CELLS:
            yield f"range: makes {cells:,.0f} spacings, must be {MOST_CELLS:,} or less"

    def _keys_of(self, given: BarRange) -> dict[str, Any]:
        """The keys of a range as those of a uniform bar."""
        own = {key: value for key, value in given.given().items() if key not in OF_RANGES}
        other = {twin for pair in PAIRS for twin in pair if not own.keys().isdisjoint(pair)}
        shared = {key: value for key, value in self.given().items() if key not in {"range", "length", *other}}
        return shared | own

    @property
    def _whole_length(self) -> float:
        """Length of all ranges and gaps, m."""
        return math.fsum(each.length + each.gap for each in self.range)

    @property
    def parts(self) -> tuple["Bar", ...]:
        """The uniform bars it consists of, from left to right: its ranges, or itself."""
        return tuple(Bar(**self._keys_of(given)) for given in self.range) or (self,)

    @property
    def starts(self) -> tuple[float, ...]:
        """Place (m) of the left end of each part."""
        if not self.range:
            return (0.0,)
        widths = [each.length + each.gap for each in self.range]
        return tuple(math.fsum(widths[:k]) + each.gap for k, each in enumerate(self.range))

    @property
    def contacts(self) -> tuple[bool, ...]:
        """Whether each part is in contact with the part on its left instead of bonded to it; false for the first."""
        return tuple(each.interface == "contact" for each in self.range) or (False,)

    @property
    def least_strength(self) -> float:
        """Smallest tensile strength σ_t (Pa) of its parts; infinite for an unbreakable bar."""
        return min(part.breaking_stretch * part.modulus for part in self.parts)

    def end(self, side: str) -> "Bar":
        """The part at the "left" or the "right" end."""
        return self.parts[0 if side == "left" else -1]

    @property
    def travel_time(self) -> float:
        """Time (s) a wave takes from end to end, L/c of a uniform bar."""
        return sum(part.length / part.speed for part in self.parts)

    @property
    def cells(self) -> int:
        """Number of spacings of a bar without ranges; the number of nodes is larger by one."""
        return round(self.length / self.spacing)

    @property
    def nodes(self) -> int:
        """Number of nodes; one at a bonded interface, two at a contact."""
        return sum(part.cells for part in self.parts) + 1 + sum(self.contacts)

    @property
    def area(self) -> float:
        """Area A of the cross-section, m²."""
        if self.diameter is not None:
            return 0.25 * math.pi * self.diameter**2
        return 1.0 if self.section is None else self.section

    @property
    def modulus(self) -> float:
        """Young's modulus E in Pa."""
        if self.youngs_modulus is not None:
            return self.youngs_modulus
        assert self.wave_speed is not None
        return self.density * (self.wave_speed * self.wave_speed)  # ** would raise where it overflows

    @property
    def speed(self) -> float:
        """Wave speed c in m/s."""
        return math.sqrt(self.modulus / self.density)

    @property
    def drag_rate(self) -> float:
        """Rate 2αc (1/s) of the dashpots that attenuate, as parts of the masses (L eq. 19 as u_tt + 2αc u_t)."""
        return 2.0 * self.attenuation * self.speed

    @property
    def breaking_stretch(self) -> float:
        """Stretch s₀ at which bonds break; infinite for an unbreakable bar."""
        if self.critical_stretch is not None:
            return self.critical_stretch
        return math.inf if self.strength is None else self.strength / self.modulus

    @property
    def opens(self) -> bool:
        """Whether some part has a fracture energy."""
        return any(part.fracture_energy is not None for part in self.parts)

    @property
    def largest_strength(self) -> float:
        """Strength (Pa) at the fastest of `strength_rates`; infinite for an unbreakable bar."""
        strength = self.breaking_stretch * self.modulus
        if self.strength_per_decade is None or self.strength_rates is None:
            return strength
        return strength + self.strength_per_decade * math.log10(self.strength_rates[1] / self.strength_rates[0])

    @property
    def characteristic_length(self) -> float:
        """EG_f/σ_t² in m, at the largest strength; it needs a fracture energy."""
        assert self.fracture_energy is not None
        return self.modulus * self.fracture_energy / self.largest_strength**2

    @property
    def fracture(self) -> Fracture:
        """Fracture energy and law of rates for methods."""
        rates = self.strength_rates or (1.0, 1.0)
        return Fracture(self.fracture_energy or 0.0, self.strength_per_decade or 0.0, rates)
