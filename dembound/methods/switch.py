"""One method until something is about to break, peridynamics everywhere from then on (L section 3.1 and 3.3)."""

from typing import Literal

import numpy as np

from dembound.methods.bonds import Bonds
from dembound.methods.method import Triggered
from dembound.methods.rod import Rod
from dembound.table import quantity


class Switch(Triggered):
    """One method until a stretch reaches `trigger` of the critical one, peridynamics everywhere from then on.

    The first method is finite differences or peridynamics with m = 1: L's FDM–PD3 and PD1–PD3.
    """

    type: Literal["switch"]
    before: Literal["finite_difference", "peridynamics"] = quantity("finite_difference")
    """method before; "peridynamics" is that with m = 1"""
    corrected_ends: bool = quantity(False)
    """whether local springs repair the bar's soft ends"""

    @property
    def name(self) -> str:
        """Name of the method at the start, for reports."""
        return "finite differences" if self.before == "finite_difference" else "peridynamics, m = 1"

    @property
    def soft_ends(self) -> bool:
        """True unless they are corrected."""
        return not self.corrected_ends

    def begin(self, rod: Rod) -> Bonds:
        """Local springs that trigger the switch; with m = 1 those of the ends are half as stiff."""
        bonds = Bonds(rod, self.horizon, complement=self.corrected_ends, trigger_ratio=self.trigger)
        if self.before == "peridynamics" and not self.corrected_ends:
            bonds.soften_ends()
        return bonds

    def stages(self, rod: Rod) -> list[Bonds]:
        """The bonds before and after the switch."""
        after = self.begin(rod)
        after.add_zone(0, rod.count)
        return [self.begin(rod), after]

    def on_trigger(self, bonds: Bonds, u: np.ndarray) -> str:
        """Change to peridynamics everywhere."""
        bonds.add_zone(0, bonds.rod.count)
        return f"peridynamics, m = {self.horizon}"
