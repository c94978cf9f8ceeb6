"""Viscous (Lysmer) boundaries for disks: absorbing, and absorbing while a wave comes in.

Z eqs 3-6. A dashpot of constant βρcD per edge particle of diameter D stands for the medium beyond: c = c_p with
β_P along the normal, c = c_s with β_S across it. β repairs what uneven disks do to ΣD; `dembound calibrate` finds it.
"""

from collections.abc import Mapping
from typing import Literal

import numpy as np

from dembound.boundaries.driven import Driven
from dembound.boundaries.support import Edge, Incident, Medium, SupportBuilder
from dembound.table import Table, quantity


class Dashpots(Table):
    """A side with dashpots: their two calibration factors, and how much mass they stand at."""

    beta_p: float = quantity(1.0, unit="1", help="factor of the P dashpots, along the side's normal", ge=0.0)
    beta_s: float = quantity(1.0, unit="1", help="factor of the S dashpots, across the side's normal", ge=0.0)
    half_mass: bool = quantity(False, unit="1", help="whether the side's particles are half cells")

    def dampings(self, edge: Edge, medium: Medium) -> np.ndarray:
        """Dashpot constants βρcD (2, k) in N·s/m of the edge's particles along x and y (Z eq. 4)."""
        return np.outer(medium.impedances(self.beta_p, self.beta_s, edge.axis), edge.diameters)


class Viscous(Dashpots):
    """Absorbs: F = −βρcD·v (Z eq. 4)."""

    type: Literal["viscous"]

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Incident], supports: SupportBuilder) -> None:
        """One dashpot per edge particle and direction."""
        for component, damping in enumerate(self.dampings(edge, medium)):
            supports.add(edge.nodes, component, damping=damping)


class ViscousInput(Dashpots, Driven):
    """Absorbs and lets a wave in: F = −βρcD·v + 2βρcD·v_i (Z eq. 6), v_i the incident wave's velocity."""

    type: Literal["viscous_input"]

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Incident], supports: SupportBuilder) -> None:
        """The absorbing dashpots, plus the force that makes the incident wave pass."""
        names = self.waves_by_axis(edge.axis)
        for component, damping in enumerate(self.dampings(edge, medium)):
            supports.add(edge.nodes, component, damping=damping)
            if name := names[component]:
                supports.add(edge.nodes, component, drive=2.0 * damping, signal=waves[name].velocity)
