"""Viscous (Lysmer) boundaries for disks: absorbing, and absorbing while a wave comes in.

Z eqs 3-6. A dashpot of constant βρcD per edge particle of diameter D stands for the medium beyond: c = c_p with
β_P along the normal, c = c_s with β_S across it. β repairs what uneven disks do to ΣD; `dembound calibrate` finds it.
"""

from collections.abc import Mapping
from typing import Literal

from dembound.boundaries.driven import Driven
from dembound.boundaries.support import Edge, Medium, Signal, SupportBuilder
from dembound.table import Table, quantity


class Dashpots(Table):
    """The two calibration factors of a side with dashpots."""

    beta_p: float = quantity(1.0, unit="1", help="factor of the P dashpots, along the side's normal", ge=0.0)
    beta_s: float = quantity(1.0, unit="1", help="factor of the S dashpots, across the side's normal", ge=0.0)


class Viscous(Dashpots):
    """Absorbs: F = −βρcD·v (Z eq. 4)."""

    type: Literal["viscous"]

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Signal], supports: SupportBuilder) -> None:
        """One dashpot per edge particle and direction."""
        for component, impedance in enumerate(medium.impedances(self.beta_p, self.beta_s, edge.axis)):
            supports.add(edge.nodes, component, damping=impedance * edge.diameters)


class ViscousInput(Dashpots, Driven):
    """Absorbs and lets a wave in: F = −βρcD·v + 2βρcD·v_i (Z eq. 6), v_i the incident wave's velocity."""

    type: Literal["viscous_input"]

    def support(self, edge: Edge, medium: Medium, waves: Mapping[str, Signal], supports: SupportBuilder) -> None:
        """The absorbing dashpots, plus the force that makes the incident wave pass."""
        names = self.waves_by_axis(edge.axis)
        for component, impedance in enumerate(medium.impedances(self.beta_p, self.beta_s, edge.axis)):
            name = names[component]
            dashpots = impedance * edge.diameters
            supports.add(
                edge.nodes,
                component,
                damping=dashpots,
                drive=2.0 * dashpots if name else 0.0,
                signal=waves[name] if name else None,
            )
