"""Viscoelastic boundaries for disks: viscous ones with springs to the ground, which prevent drift.

Z eqs 13-18. For waves that spread from a source at distance L, the medium beyond is represented by the dashpots and by
springs of α_n G/L along the normal and α_s G/L across it. G follows from a given modulus, or is that of the medium.
"""

import math
from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal, Self

import numpy as np

from dembound.boundaries.boundary import Boundary, Driven, Place
from dembound.boundaries.edge import normal_axis, plane_of
from dembound.boundaries.support import BoundaryMedium, Edge, SupportBuilder, Waves
from dembound.boundaries.viscous import Dashpots, Rock, Viscous, ViscousInput
from dembound.errors import CaseError
from dembound.table import Box, quantity


class Springs(Boundary):
    """A side with springs: stiffness α·G/L·D per edge particle of diameter D (Z eqs 14, 17)."""

    beyond_dashpots: ClassVar[str] = "viscoelastic sides without their springs"

    alpha_n: float = quantity(1.0, means="factor of springs", ge=0.0)
    """factor α_n of the springs along the side's normal"""
    alpha_s: float = quantity(0.5, means="factor of springs", ge=0.0)
    """factor α_s of the springs across the side's normal"""
    young_modulus: float | None = quantity(None, unit="Pa", means="modulus", gt=0.0)
    """E of the springs' G = E/(2(1 + ν)); absent: G = ρc_s² of the dashpots' medium, or of rock"""
    poisson_ratio: float | None = quantity(None, means="Poisson's ratio", gt=-1.0, le=0.5)
    """ν of the springs' G; absent: 0 where young_modulus is given"""
    distance: float | None = quantity(None, unit="m", means="length", gt=0.0)
    """distance L from the source of the waves; give this or source"""
    source: tuple[float, float] | None = quantity(None, unit="m", means="place")
    """place [x, y] the waves come from; L is each particle's own distance from there"""

    def mistakes(self) -> Iterator[str]:
        """A modulus or a distance that is not known."""
        yield from super().mistakes()
        if self.poisson_ratio is not None and self.young_modulus is None:
            yield "poisson_ratio: needs young_modulus; without it G is that of the medium"
        if (self.distance is None) == (self.source is None):
            yield "must have exactly one of distance and source, which give the distance L"

    def describe(self, edge: Edge, medium: BoundaryMedium) -> dict[str, Any]:
        """Adds the factors α, the modulus G (Pa) and the distances L (m) of the springs."""
        distances = self.distances(edge)
        return super().describe(edge, medium) | {
            "alpha_n": self.alpha_n,
            "alpha_s": self.alpha_s,
            "shear_modulus": self.shear_modulus(medium),
            "distance_min": distances.min(),
            "distance_max": distances.max(),
        }

    def stiffnesses(self, edge: Edge, medium: BoundaryMedium) -> np.ndarray:
        """Spring constants αGD/L (2, k) in N/m of the edge's particles along x and y; D : their widths.

        Raises CaseError when the source lies in one of these particles.
        """
        along_normal, across = self.alpha_n, self.alpha_s
        factors = [along_normal, across] if edge.axis == 0 else [across, along_normal]
        return np.outer(factors, self.shear_modulus(medium) * edge.widths / self.distances(edge))

    def equal_supports(self, own: Place, other: Place) -> Self:
        """The side with factors α that give springs as strong per length as those at another place."""
        mine, theirs = (self.shear_modulus(medium) * edge.diameter_sum_ratio for edge, medium in (own, other))
        ratio = theirs / mine
        return self.model_copy(update={"alpha_n": self.alpha_n * ratio, "alpha_s": self.alpha_s * ratio})

    def stiffest(self, side: str, box: Box) -> Boundary:
        """The side with the source's distance from its nearest point everywhere, where springs are stiffest."""
        if self.source is None:
            return self
        nearest = [min(max(place, box[axis]), box[2 + axis]) for axis, place in enumerate(self.source)]
        nearest[normal_axis(side)] = plane_of(side, box)
        distance = math.dist(self.source, nearest)
        return self.model_copy(update={"source": None, "distance": distance}) if distance > 0.0 else self

    def shear_modulus(self, medium: BoundaryMedium) -> float:
        """G in Pa: as given, of the rock beyond the side, or of the medium."""
        if self.young_modulus is None:
            rock: Rock | None = getattr(self, "rock", None)
            return medium.shear_modulus if rock is None else rock.shear_modulus
        return self.young_modulus / (2.0 * (1.0 + (self.poisson_ratio or 0.0)))

    def distances(self, edge: Edge) -> np.ndarray:
        """Distances L (k,) in m of the edge's particles from the source; errors as of `stiffnesses`."""
        if self.source is None:
            return np.full(len(edge.nodes), self.distance)
        distances = np.hypot(*(edge.positions - self.source).T)
        if (distances < 0.5 * edge.diameters).any():
            raise CaseError([f"boundary.{edge.side}.source: lies in a particle of this side, must lie away from it"])
        return distances


class HoldingDashpots(Dashpots, Springs):
    """A side with dashpots and springs."""

    def support(self, edge: Edge, medium: BoundaryMedium, waves: Waves, supports: SupportBuilder) -> None:
        """One dashpot and one spring per edge particle and direction, with the forces that introduce a wave."""
        dampings, stiffnesses = self.dampings(edge, medium), self.stiffnesses(edge, medium)
        for component, name in enumerate(self.waves_by_axis(edge.axis)):
            damping, stiffness = dampings[component], stiffnesses[component]
            incident = waves[name].velocity if name else None
            supports.add(edge.nodes, component, damping=damping, stiffness=stiffness, incident=incident)
            if name:
                supports.add(edge.nodes, component, drive=stiffness, signal=waves[name].displacement)


class Viscoelastic(HoldingDashpots):
    """Absorbs and holds: F = −βρcD·v − K·D·u, K = α_n G/L along the normal and α_s G/L across it (Z eq. 17)."""

    type: Literal["viscoelastic"]

    def dashpots_alone(self) -> Viscous:
        """The side without its springs."""
        return Viscous(type="viscous", **self.own_keys(Dashpots))


class ViscoelasticInput(HoldingDashpots, Driven):
    """Absorbs, holds and transmits an incident wave: F = −βρcD·v − K·D·u + 2βρcD·v_i + K·D·u_i (Z eq. 18).

    v_i and u_i are velocity and displacement of the incident wave.
    """

    type: Literal["viscoelastic_input"]

    def problems(self, side: str, tables: Mapping[str, Any]) -> Iterator[str]:
        """Springs that differ along a bottom or top side that also supports a free-field column."""
        yield from super().problems(side, tables)
        beside = [name for name, table in tables["boundary"].items() if table and table.needs_column]
        if beside and normal_axis(side) == 1 and self.source is not None:
            yield (
                f"boundary.{side}.source: makes springs differ along the side, and those of the column at "
                f"boundary.{beside[0]} differ from them; give distance"
            )

    def dashpots_alone(self) -> ViscousInput:
        """The side without its springs."""
        return ViscousInput(type="viscous_input", **self.own_keys(Dashpots, Driven))
