"""Bond-based peridynamics all through (L eq. 8)."""

from typing import Literal

import numpy as np

from dembound.methods.bonds import Bonds, Rod
from dembound.methods.method import Method
from dembound.table import quantity


class Peridynamics(Method):
    """Every node is bonded to all others within the horizon δ = mΔx; a bond breaks at the critical stretch.

    Near an end the family is cut, and the bar is softer there. Corrected ends give back what is missing: local springs
    carry the share of the stress that bonds leave.
    """

    type: Literal["peridynamics"]
    horizon: int = quantity(..., unit="1", help="horizon m in spacings: δ = mΔx", ge=1)
    corrected_ends: bool = quantity(False, unit="1", help="whether local springs repair the bar's soft ends")

    @property
    def name(self) -> str:
        """What the method does at first, for reports."""
        return f"peridynamics, m = {self.horizon}"

    @property
    def largest_horizon(self) -> int:
        """The horizon m."""
        return self.horizon

    @property
    def soft_ends(self) -> bool:
        """Where they are not corrected."""
        return not self.corrected_ends

    def begin(self, rod: Rod) -> Bonds:
        """All bonds, and the springs of corrected ends."""
        bonds = Bonds(rod, self.horizon, complement=self.corrected_ends)
        bonds.add_zone(0, rod.count)
        return bonds

    def on_trigger(self, bonds: Bonds, u: np.ndarray) -> str:
        """No spring triggers: those of corrected ends break at the critical stretch."""
        return self.name
