"""Bond-based peridynamics in the whole bar (L eq. 8)."""

from typing import Literal

import numpy as np

from dembound.methods.bonds import Bonds
from dembound.methods.method import Peridynamic
from dembound.methods.rod import Rod
from dembound.table import quantity


class Peridynamics(Peridynamic):
    """Every node is bonded to all within the horizon δ = mΔx (L eq. 8); a bond breaks at the critical stretch.

    Near an end the family is cut, and the bar is softer there. Corrected ends restore the stiffness: local springs
    carry the share of the stress that bonds do not carry.
    """

    type: Literal["peridynamics"]
    corrected_ends: bool = quantity(False)
    """whether local springs repair the bar's soft ends"""

    @property
    def name(self) -> str:
        """Name of the method at the start, for reports."""
        return f"peridynamics, m = {self.horizon}"

    @property
    def horizon_beyond(self) -> int:
        """The horizon m: bonds reach beyond the ends as if the bar went on."""
        return self.horizon

    @property
    def soft_ends(self) -> bool:
        """True unless they are corrected."""
        return not self.corrected_ends

    def begin(self, rod: Rod) -> Bonds:
        """All bonds, and the springs of corrected ends."""
        bonds = Bonds(rod, self.horizon, complement=self.corrected_ends)
        bonds.add_zone(0, rod.count)
        return bonds

    def on_trigger(self, bonds: Bonds, u: np.ndarray) -> str:
        """Never called: no spring triggers, and springs of corrected ends break at the critical stretch."""
        return self.name
