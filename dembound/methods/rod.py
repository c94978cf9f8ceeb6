"""The nodes of a bar and its uniform ranges, as methods see them, and how its bonds break.

They break at once, or with a fracture energy; their strength may rise with the strain rate.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.errors import CaseError
from dembound.laws.peridynamic import families, micromodulus
from dembound.places import nearest_number


@dataclass(frozen=True)
class Fracture:
    """Fracture energy J/m², 0 for bonds that break at once, and rate dependence of the strength.

    per_decade : Pa by which the strength rises for a tenfold strain rate, between the two rates (1/s).
    """

    energy: float = 0.0
    per_decade: float = 0.0
    rates: tuple[float, float] = (1.0, 1.0)

    def opening(self, strength: float) -> float:
        """Opening w_c = 2G_f/σ_t (m) at which a crack bears no stress, for a strength in Pa."""
        return 2.0 * self.energy / strength


AT_ONCE = Fracture()
"""Bonds that break at once."""


@dataclass(frozen=True)
class Range:
    """A uniform part of a bar.

    Attributes
    ----------
    first, last : its nodes at both ends. A node that two ranges share is a bonded interface.
    start : m, place of its first node; spacing : m, of its nodes.
    section : m²; modulus : Pa, Young's; density : kg/m³; critical_stretch : 1, at which bonds break.
    drag_rate : 1/s, of dashpots that attenuate, as parts of the masses.
    gap : m, opening at rest of its contact with the range on its left, if it touches it.
    beyond : length, in spacings, of the longest bonds that reach beyond the bar's left and right end into a layer of
    nodes there (bar/layers.py), 0 for none; a node at such an end has its whole volume.
    fracture : how its bonds open.
    """

    first: int
    last: int
    start: float
    spacing: float
    section: float
    modulus: float
    density: float
    critical_stretch: float = math.inf
    drag_rate: float = 0.0
    gap: float = 0.0
    beyond: tuple[int, int] = (0, 0)
    fracture: Fracture = AT_ONCE

    @property
    def cells(self) -> int:
        """Number of spacings; the number of nodes is larger by one."""
        return self.last - self.first

    @property
    def end(self) -> float:
        """Place of its last node, m."""
        return self.start + self.cells * self.spacing

    @property
    def nodes(self) -> slice:
        """Nodes of the rod among those of the bar."""
        return slice(self.first, self.last + 1)

    @property
    def planes(self) -> slice:
        """The planes between its nodes; plane k is that between nodes k and k + 1."""
        return slice(self.first, self.last)

    @property
    def speed(self) -> float:
        """Wave speed c = √(E/ρ), m/s."""
        return math.sqrt(self.modulus / self.density)

    @property
    def spring(self) -> float:
        """Stiffness EA/Δx of a whole local spring, N/m."""
        return self.modulus * self.section / self.spacing

    @property
    def elongation(self) -> float:
        """Elongation (m) of a spring at the critical stretch."""
        return self.critical_stretch * self.spacing

    @property
    def volumes(self) -> np.ndarray:
        """Volumes (cells + 1,) m³ of its nodes; half at its ends, unless a layer follows."""
        volumes = np.full(self.cells + 1, self.section * self.spacing)
        for end, reach in zip((0, -1), self.beyond, strict=True):
            volumes[end] *= 0.5 if reach == 0 else 1.0
        return volumes

    def bond_rows(self, horizon: int, influence: np.ndarray | None = None) -> np.ndarray:
        """Stiffness (m, cells + 1) N/m of all possible peridynamic bonds: c_m V_i V_{i+p} w_p/(pΔx) (L eqs 4, 8, 9).

        Row p − 1 has the bonds between i and i + p. influence : (m,) factors of the micromodulus c_m by length of the
        bonds, scaled to keep Young's modulus; by default equal for all.

        Raises CaseError for a negative influence, and where all are zero.
        """
        rows = np.zeros((horizon, self.cells + 1))
        if horizon > 0:
            family = families(self.cells + 1, horizon)
            (first, second), apart = family.pairs.T, family.apart
            c_m = micromodulus(self.modulus, horizon * self.spacing, self.section)
            volumes = self.volumes
            rows[apart - 1, first] = c_m * (volumes[first] * volumes[second]) * family.factor / (apart * self.spacing)
        if influence is not None:
            if np.min(influence) < 0.0 or not np.max(influence) > 0.0:
                raise CaseError(["method: gives no bond a stiffness above 0, take a larger horizon"])
            rows *= np.reshape(influence, (horizon, 1)) * (1.0 / _influenced(horizon, influence))
        return rows

    def carried_share(self, rows: np.ndarray) -> np.ndarray:
        """Share (cells,) of the stress under uniform strain that bonds carry across planes; rows as `bond_rows`."""
        through = np.zeros(self.cells + 1)
        for p, row in enumerate(rows, start=1):
            through += np.convolve(row * p * self.spacing, np.ones(p))[: self.cells + 1]  # p of them cross a plane
        return through[:-1] / (self.modulus * self.section)

    def stiffness_beyond(self, side: int, influence: np.ndarray | None = None) -> np.ndarray:
        """Stiffness (b,) N/m by length of bonds that reach beyond the left (0) or right (1) end of a bar that goes on.

        They are springs where the longest has one spacing, else peridynamic bonds, see `bond_rows`.
        """
        reach = self.beyond[side]
        if reach <= 1:
            return np.full(reach, self.spring)
        longer = replace(self, first=0, last=4 * reach, beyond=(0, 0))
        return longer.bond_rows(reach, influence)[:, reach]

    def carried_beyond(self, influence: np.ndarray | None = None) -> np.ndarray:
        """Share (cells,) of the stress under uniform strain that the bonds beyond both ends carry across its planes.

        Of bonds of length p, p − 1 − k cross the k-th plane from the end.
        """
        carried = np.zeros(self.cells)
        for side, planes in enumerate((carried, carried[::-1])):
            for p, stiffness in enumerate(self.stiffness_beyond(side, influence), start=1):
                planes[: p - 1] += stiffness * p * np.arange(p - 1, 0, -1) / self.spring
        return carried


def _influenced(horizon: int, influence: np.ndarray) -> float:
    """Young's modulus over the bar's own when the micromodulus is multiplied by influence (m,)."""
    weights = np.arange(1.0, horizon + 1.0)
    weights[-1] *= 0.5  # half of an outermost node's volume lies within the horizon
    return float(np.sum(np.asarray(influence) * weights) / weights.sum())


@dataclass(frozen=True)
class Rod:
    """The n nodes of a bar: its ranges from left to right.

    A range that begins with the last node of the range before is bonded to it; one that begins with the next node only
    touches it.
    """

    ranges: tuple[Range, ...]

    @classmethod
    def uniform(
        cls,
        count: int,
        spacing: float,
        section: float,
        modulus: float,
        critical_stretch: float = math.inf,
        density: float = 1.0,
        drag_rate: float = 0.0,
    ) -> Rod:
        """A bar of one range with so many nodes, in the units of `Range`."""
        return cls((Range(0, count - 1, 0.0, spacing, section, modulus, density, critical_stretch, drag_rate),))

    def continued(self, left: int, right: int) -> Rod:
        """The bar with bonds that reach up to a number of spacings beyond its ends; see `Range.beyond`."""
        first, *others = self.ranges
        ranges = [replace(first, beyond=(left, first.beyond[1])), *others]
        ranges[-1] = replace(ranges[-1], beyond=(ranges[-1].beyond[0], right))
        return Rod(tuple(ranges))

    @property
    def count(self) -> int:
        """Number of nodes n."""
        return self.ranges[-1].last + 1

    @cached_property
    def positions(self) -> np.ndarray:
        """(n,) m."""
        positions = np.empty(self.count)
        for part in reversed(self.ranges):  # a shared node is where the range before it ends
            positions[part.nodes] = part.start + np.arange(part.cells + 1) * part.spacing
        return positions

    def nearest(self, place: float) -> int:
        """The node nearest to a place (m), half-way the left one; in the gap of a contact the one on its right."""
        part = next((part for part in self.ranges if place <= part.end), self.ranges[-1])
        return part.first + max(0, nearest_number((place - part.start) / part.spacing))

    def range_of(self, plane: int) -> Range:
        """The range of a plane, which must not be that of a contact."""
        return next(part for part in self.ranges if part.first <= plane < part.last)

    def end(self, side: str) -> Range:
        """The range at the "left" or the "right" end."""
        return self.ranges[0 if side == "left" else -1]

    @cached_property
    def volumes(self) -> np.ndarray:
        """(n,) m³; half at the ends, at bonded interfaces half of either range."""
        return self.summed(lambda part: part.volumes)

    @cached_property
    def mass(self) -> np.ndarray:
        """(n,) kg."""
        return self.summed(lambda part: part.density * part.volumes)

    @cached_property
    def drag_rate(self) -> np.ndarray:
        """(n,) 1/s of dashpots that attenuate, as parts of the masses."""
        rates = np.empty(self.count)
        for part in self.ranges:
            rates[part.nodes] = part.drag_rate
        for left, right in self.bonded:
            masses = [part.density * part.section * part.spacing for part in (left, right)]
            rates[left.last] = np.average([left.drag_rate, right.drag_rate], weights=masses)
        return rates

    @cached_property
    def springs(self) -> np.ndarray:
        """Stiffness (n − 1,) N/m of whole local springs; 0 where none joins two ranges."""
        return self._by_plane(lambda part: part.spring, 0.0)

    @cached_property
    def sections(self) -> np.ndarray:
        """(n − 1,) m², of the planes; 0 where nothing joins two ranges."""
        return self._by_plane(lambda part: part.section, 0.0)

    @cached_property
    def elongation(self) -> np.ndarray:
        """(n − 1,) m, elongation of local springs at the critical stretch; infinite where there is none."""
        return self._by_plane(lambda part: part.elongation, math.inf)

    @property
    def bonded(self) -> list[tuple[Range, Range]]:
        """The ranges on both sides of every bonded interface."""
        sides = zip(self.ranges[:-1], self.ranges[1:], strict=True)
        return [(left, right) for left, right in sides if left.last == right.first]

    @property
    def touching(self) -> list[tuple[Range, Range]]:
        """The ranges on both sides of every contact."""
        sides = zip(self.ranges[:-1], self.ranges[1:], strict=True)
        return [(left, right) for left, right in sides if left.last < right.first]

    def summed(self, of: Callable[[Range], np.ndarray]) -> np.ndarray:
        """Values (n,) of all nodes from the values of each range's nodes, which are added up at shared nodes."""
        values = np.zeros(self.count)
        for part in self.ranges:
            values[part.nodes] += of(part)
        return values

    def _by_plane(self, of: Callable[[Range], float], elsewhere: float) -> np.ndarray:
        """A value of each range at its planes, (n − 1,)."""
        values = np.full(self.count - 1, elsewhere)
        for part in self.ranges:
            values[part.planes] = of(part)
        return values

    def bond_rows(self, horizon: int, influence: np.ndarray | None = None) -> np.ndarray:
        """Stiffness (m, n) N/m of all possible peridynamic bonds, which join nodes of a range, see `Range.bond_rows`.

        Raises CaseError for a negative influence, and where all are zero.
        """
        rows = np.zeros((horizon, self.count))
        for part in self.ranges:
            rows[:, part.nodes] += part.bond_rows(horizon, influence)
        return rows
