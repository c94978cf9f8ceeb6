"""Viscous (Lysmer) boundaries for disks: absorbing, and absorbing with a wave that enters; rock beyond them."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import Field

from dembound.boundaries.boundary import Boundary, Driven
from dembound.boundaries.edge import BoundaryMedium, Edge, Factor, Motion
from dembound.boundaries.platen import Keeping
from dembound.boundaries.support import SupportBuilder, Waves
from dembound.table import Table, quantity


class Rock(Table):
    """The rock of a half-space, whose dashpots ρ_r c_r replace those of the ground; right at normal incidence."""

    density: float = quantity(unit="kg/m³", gt=0.0)
    """density ρ of the rock"""
    p_wave_speed: float = quantity(unit="m/s", means="wave speed", gt=0.0)
    """speed of its P waves"""
    s_wave_speed: float = quantity(unit="m/s", means="wave speed", gt=0.0)
    """speed of its S waves"""

    def mistakes(self) -> Iterator[str]:
        """Speeds of no solid."""
        if not self.s_wave_speed < self.p_wave_speed:
            yield "s_wave_speed: must be below p_wave_speed, as in every elastic solid"

    def factors(self, edge: Edge, medium: BoundaryMedium) -> dict[Motion, float]:
        """β = ρ_r c_r/(ρc)·H/ΣD of an edge, with ρ and c of the medium; 1 where it has no such waves."""
        pairs = ((self.p_wave_speed, medium.p_wave_speed), (self.s_wave_speed, medium.s_wave_speed))
        times = self.density / medium.density / edge.diameter_sum_ratio
        p, s = (times * own / given if given > 0.0 else 1.0 for own, given in pairs)
        return {"p": p, "s": s}

    @property
    def shear_modulus(self) -> float:
        """G = ρc_s² in Pa."""
        return self.density * self.s_wave_speed**2


Given = Annotated[float, Field(ge=0.0)] | Literal["matched"]
"""A factor β in a case file."""


class Dashpots(Keeping):
    """A side with dashpots: their two calibration factors, and whether the particles have half their mass."""

    may_halve: ClassVar[bool] = True

    beta_p: Given = quantity("matched", means="factor of dashpots")
    """factor β of the dashpots along the side's normal; "matched": that of the impedance of the packing"""
    beta_s: Given = quantity("matched", means="factor of dashpots")
    """factor β of the dashpots across the side's normal"""
    rock: Rock | None = quantity(None)
    """rock beyond the side: density, p_wave_speed and s_wave_speed; gives both β"""
    half_mass: bool = quantity(False)
    """the particles are half cells; sides of disks in one row, not free_field"""

    def mistakes(self) -> Iterator[str]:
        """Factors that are given twice."""
        yield from super().mistakes()
        if self.rock is not None and (given := sorted({"beta_p", "beta_s"} & self.model_fields_set)):
            yield f"rock: gives the factors of both waves; leave out {' and '.join(given)}"

    @property
    def factors(self) -> Mapping[Motion, Factor]:
        """The factors of P and of S waves as given; those of rock are known at an edge only."""
        return {"p": self.beta_p, "s": self.beta_s}

    def factors_at(self, edge: Edge, medium: BoundaryMedium) -> dict[Motion, float]:
        """The factors as numbers, those of the rock if there is one."""
        return super().factors_at(edge, medium) if self.rock is None else self.rock.factors(edge, medium)

    def with_factors(self, factors: Mapping[Motion, Factor]) -> Self:
        """The side with other factors, and no rock."""
        return super().with_factors(factors).model_copy(update={"rock": None})

    @property
    def is_interface(self) -> bool:
        """Whether there is rock beyond the side."""
        return self.rock is not None

    @property
    def is_artificial(self) -> bool:
        """Whether dashpots stand in for the same medium beyond; other rock belongs to the problem."""
        return self.rock is None

    @property
    def half_cells(self) -> bool:
        """The value of the key ``half_mass``."""
        return self.half_mass

    def with_half_cells(self, half: bool) -> Self:
        """The side with this value of ``half_mass``."""
        return self.model_copy(update={"half_mass": half}) if self.may_halve else self

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Half cells on a side whose particles do not form one row."""
        yield from super().problems(side, tables)
        packing = tables.get("packing")
        if self.half_mass and packing and side not in packing.regular_sides:
            has = f"has such {' and '.join(packing.regular_sides)}" if packing.regular_sides else "has none"
            yield f"boundary.{side}.half_mass: needs a side of disks in one row; pattern {packing.pattern} {has}"
        if self.rock is not None and "bar" in tables:
            yield f"boundary.{side}.rock: is for sides of disks; give beta_p, the impedance beyond over that of the bar"

    def describe(self, edge: Edge, medium: BoundaryMedium) -> dict[str, Any]:
        """The factors, whether masses are halved, and the impedance of the rock over that of the ground."""
        found = {**super().describe(edge, medium), "half_mass": self.half_mass}
        for motion in self.factors if self.rock is not None else ():
            matched = found[f"matched_{motion}"]
            found[f"rock_{motion}"] = found[f"beta_{motion}"] / matched if matched else None
        return found

    def dampings(self, edge: Edge, medium: BoundaryMedium) -> np.ndarray:
        """Dashpot constants βρcD (2, k) in N·s/m of the edge's particles along x and y (Z eq. 4); D : their widths."""
        factors = self.factors_at(edge, medium)
        return np.outer(medium.impedances(factors["p"], factors["s"], edge.axis), edge.widths)


class Bearing(Table):
    """Springs of a side on the motion of its particles relative to the ground beyond, beside its dashpots.

    F = −(αG/L)D·(u − u_g), counted from rest: u_g is the motion of the particle's twin in the free-field column or, of
    a bottom without a column, its mean motion; L is the length of the side, G = ρc_s² of the dashpots' medium.
    """

    alpha_n: float = quantity(1.0, means="factor of springs", ge=0.0)
    """factor α of the springs along the normal"""
    alpha_s: float = quantity(0.5, means="factor of springs", ge=0.0)
    """factor α of the springs across the normal"""


class BearingDashpots(Dashpots):
    """Dashpots that, at the bottom and beside a free-field column, may have springs on relative motion beside them."""

    bearing: bool | Bearing | None = quantity(None)
    """whether a bottom or free-field side has springs on the motion relative to the ground beyond; or a table of their
    alpha_n and alpha_s; absent: where it has an intact zone"""

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Springs of a side beyond which no ground is known to move."""
        yield from super().problems(side, tables)
        if self.bearing not in (None, False) and ("bar" in tables or not (side == "bottom" or self.needs_column)):
            yield f"boundary.{side}.bearing: is for the bottom of disks, and for free-field sides"

    def dashpots_alone(self) -> Dashpots:
        """The side without springs."""
        return self.model_copy(update={"bearing": False}) if self.bearing not in (None, False) else self

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """One dashpot per edge particle and direction, with the force that introduces a wave if one enters."""
        names = self.waves_by_axis(edge.axis)
        for component, (damping, name) in enumerate(zip(self.dampings(edge, medium), names, strict=True)):
            supports.add(edge.nodes, component, damping=damping, incident=waves[name].velocity if name else None)


class Viscous(BearingDashpots):
    """Absorbs by dashpots: F = −βρcD·v (Z eq. 4), D the diameter of a particle; of a bar F = −βρcA·v."""

    for_bars: ClassVar[bool] = True

    type: Literal["viscous"]


class ViscousInput(BearingDashpots, Driven):
    """Absorbs and transmits an incident wave: F = −βρcD·v + 2βρcD·v_i (Z eq. 6), v_i the incident wave's velocity."""

    for_bars: ClassVar[bool] = True

    type: Literal["viscous_input"]

    def at_rest(self) -> Boundary:
        """A viscous side with the same dashpots and without a wave."""
        return Viscous(type="viscous", **self.own_keys(BearingDashpots))
