"""Central finite differences: local springs between neighbours (L eq. 17)."""

from typing import Literal

import numpy as np

from dembound.methods.bonds import Bonds
from dembound.methods.method import Method
from dembound.methods.rod import Rod


class FiniteDifference(Method):
    """Springs EA/Δx between neighbours, central differences (L eq. 17); they break at the critical stretch."""

    type: Literal["finite_difference"]

    @property
    def name(self) -> str:
        """Name of the method at the start, for reports."""
        return "finite differences"

    @property
    def largest_horizon(self) -> int:
        """1: local springs."""
        return 1

    def begin(self, rod: Rod) -> Bonds:
        """Intact local springs, which trigger at the critical stretch."""
        return Bonds(rod, horizon=0)

    def on_trigger(self, bonds: Bonds, u: np.ndarray) -> str:
        """After the first break springs break one by one at the critical stretch, without calling the method."""
        bonds.stop_triggering()
        return self.name
