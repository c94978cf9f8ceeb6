"""Finite differences, with peridynamics only in zones around places that are about to break."""

from typing import Literal

import numpy as np

from dembound.methods.bonds import Bonds
from dembound.methods.method import WIDEST, Triggered
from dembound.methods.rod import Rod
from dembound.table import quantity


class Patch(Triggered):
    """Finite differences, with zones of peridynamics where a stretch reaches `trigger` of the critical one.

    At the border of a zone local springs carry the share of the stress that its bonds do not carry (complement
    springs). Forces act in pairs, so momentum is conserved, and neither rest nor uniform strain is disturbed at the
    seam.
    """

    type: Literal["patch"]
    reach: int = quantity(4, means="count", ge=1, le=WIDEST)
    """horizons that a zone extends beyond what made it, on either side"""

    @property
    def name(self) -> str:
        """Name of the method at the start, for reports."""
        return "finite differences"

    def begin(self, rod: Rod) -> Bonds:
        """Local springs, which trigger the method at the share `trigger` of the critical stretch."""
        return Bonds(rod, self.horizon, complement=True, trigger_ratio=self.trigger)

    def stages(self, rod: Rod) -> list[Bonds]:
        """Bonds without a zone; then with a zone in the middle, at each end, and over the whole of every range."""
        stages = [self.begin(rod)]
        for place in range(4):
            stages.append(self.begin(rod))
            for part in rod.ranges:
                first, last, nodes = part.first, part.last + 1, part.cells + 1
                width = min(nodes, 2 * self.reach * self.horizon + 2)
                middle = first + (nodes - width) // 2
                zones = (middle, middle + width), (first, first + width), (last - width, last), (first, last)
                stages[-1].add_zone(*zones[place])
        return stages

    def on_trigger(self, bonds: Bonds, u: np.ndarray) -> str:
        """Create a zone around every triggered spring; a zone grows by half its length, so that it seldom grows.

        A zone ends where the range of the spring ends.
        """
        zones = bonds.zones  # those before any grows: the zone of one spring does not depend on the others
        for k in bonds.triggered(u):
            grown = max((last - first for first, last in zones if first <= k + 1 and k < last), default=0)
            beyond = max(self.reach * self.horizon, grown // 2)
            part = bonds.rod.range_of(int(k))
            bonds.add_zone(max(part.first, int(k) - beyond), min(part.last + 1, int(k) + 2 + beyond))
        return f"finite differences and peridynamics, m = {self.horizon}"
