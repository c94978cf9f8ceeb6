"""The bar itself, without nodes and steps, at single frequencies: rods in which waves obey the equation of motion.

Of a motion e^{st} in a rod of the length L and the section A, ρ(s² + γs) u = E u″, the forces on its ends follow from
their velocities,

    F₁ = Z (v₁ coth kL − v₂/sinh kL),    F₂ = Z (v₂ coth kL − v₁/sinh kL),

    k = (s/c) √(1 + γ/s),    Z = ρcA √(1 + γ/s),

with γ = 2αc for attenuation α. An absorbing end is a dashpot Z, which reflects nothing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.accuracy.of_bars.blocks import Link, velocities
from dembound.casefile.bar import BarCase
from dembound.methods.rod import Range, Rod

RIGID = 1e12
"""Dashpot at an end whose velocity is prescribed, over the impedance of the rod."""

EQUAL = 1e-9
"""Distance of places that are one, over the length of the bar."""


@dataclass(frozen=True)
class Rods:
    """A bar of bonded ranges, cut at its ends, its interfaces and given places.

    places : (k,) m. s : (f,) rad/s.
    """

    case: BarCase
    rod: Rod
    places: np.ndarray
    s: np.ndarray

    @cached_property
    def cuts(self) -> np.ndarray:
        """All places (q,) m at which the bar is cut, from end to end."""
        end = self.rod.ranges[-1].end
        cuts = np.unique([*self.places, *(part.start for part in self.rod.ranges), end])
        return cuts[np.concatenate([[True], np.diff(cuts) > EQUAL * end])]

    @cached_property
    def parts(self) -> list[Range]:
        """The range between each cut and the next one (q − 1)."""
        middles = 0.5 * (self.cuts[1:] + self.cuts[:-1])
        return [next(part for part in self.rod.ranges if place <= part.end) for place in middles]

    @cached_property
    def links(self) -> list[Link]:
        """The link between each cut and the next one (q − 1)."""
        return [self._link(part, length) for part, length in zip(self.parts, np.diff(self.cuts), strict=True)]

    def motion(
        self, forces: Mapping[str, np.ndarray], waves: Mapping[str, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Velocities (f, k) m/s and stresses (f, k) Pa, tension positive, at the places.

        forces : by side (f,) N to the right on ends. waves : by side (f,) m/s, the velocity of the wave that enters at
        an end, or the prescribed velocity of an end.
        """
        own = [np.zeros((len(self.s), 1, 1), dtype=complex) for _ in self.cuts]
        force = np.zeros((len(self.s), len(self.cuts), 1), dtype=complex)
        for side, k in (("left", 0), ("right", -1)):
            impedance, end = self._impedance(self.rod.end(side)), self.case.side(side)
            force[:, k, 0] += forces.get(side, 0.0)
            if end.is_artificial:
                own[k][:, 0, 0] = impedance
                force[:, k, 0] += 2.0 * impedance * waves.get(side, 0.0)
            elif 0 in end.prescribed(0):
                own[k][:, 0, 0] = RIGID * impedance
                force[:, k, 0] = RIGID * impedance * waves.get(side, 0.0)
        moved = velocities(own, self.links, force)[:, :, 0]
        stress = np.stack([self._stress(moved, k) for k in range(len(self.cuts))], axis=1)
        nearest = np.abs(self.cuts - self.places[:, None]).argmin(axis=1)
        return moved[:, nearest], stress[:, nearest]

    def _stress(self, moved: np.ndarray, k: int) -> np.ndarray:
        """Stress (f,) at a cut; between different sections the force over the mean section."""
        section = np.mean([part.section for part in self.parts[max(0, k - 1) : k + 1]])
        if k < len(self.links):
            link = self.links[k]
            force = -(link.a[:, 0, 0] * moved[:, k] + link.b[:, 0, 0] * moved[:, k + 1])
        else:
            link = self.links[-1]
            force = link.c[:, 0, 0] * moved[:, k - 1] + link.d[:, 0, 0] * moved[:, k]
        return np.asarray(force / section)

    def _impedance(self, part: Range) -> np.ndarray:
        """Impedance Z (f,) N·s/m of a range."""
        return part.density * part.section * part.speed * self._root(part)

    def _root(self, part: Range) -> np.ndarray:
        return np.sqrt(1.0 + part.drag_rate / self.s)

    def _link(self, part: Range, length: float) -> Link:
        """The link of a rod of a length (m)."""
        way, impedance = self.s * self._root(part) * (length / part.speed), self._impedance(part)
        faded = -np.expm1(-2.0 * way)
        diagonal = (impedance * (2.0 - faded) / faded)[:, None, None]
        across = (-2.0 * impedance * np.exp(-way) / faded)[:, None, None]
        return Link(diagonal, across, across, diagonal)
