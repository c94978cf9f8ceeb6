"""Finite differences everywhere, peridynamics only where and when something is about to break."""

from typing import Literal

import numpy as np

from dembound.methods.bonds import Bonds, Rod
from dembound.methods.triggered import Triggered
from dembound.table import quantity


class Patch(Triggered):
    """Zones of peridynamics that appear where a stretch reaches `trigger` of the critical one, and grow as needed.

    Around a zone local springs carry the share of the stress that its bonds leave (complement springs): forces stay in
    pairs, so that momentum is kept, and neither rest nor uniform strain is disturbed at the seam.
    """

    type: Literal["patch"]
    reach: int = quantity(4, unit="1", help="horizons that a zone extends beyond what made it", ge=1)

    @property
    def name(self) -> str:
        """What the method does at first, for reports."""
        return "finite differences"

    def begin(self, rod: Rod) -> Bonds:
        """Local springs that trigger the method at its share of the critical stretch."""
        return Bonds(rod, self.horizon, complement=True, trigger_ratio=self.trigger)

    def stages(self, rod: Rod) -> list[Bonds]:
        """No zone, one in the middle, one at each end, and one all over."""
        width = min(rod.count, 2 * self.reach * self.horizon + 2)
        middle = (rod.count - width) // 2
        stages = [self.begin(rod)]
        for first, last in ((middle, middle + width), (0, width), (rod.count - width, rod.count), (0, rod.count)):
            stages.append(self.begin(rod))
            stages[-1].add_zone(first, last)
        return stages

    def on_trigger(self, bonds: Bonds, u: np.ndarray) -> str:
        """Lay a zone around every triggered spring; a zone that grows does so by half, so that it seldom has to."""
        zones = bonds.zones  # those before any of them grows: what one spring makes does not depend on the others
        for k in bonds.triggered(u):
            grown = max((last - first for first, last in zones if first <= k + 1 and k < last), default=0)
            beyond = max(self.reach * self.horizon, grown // 2)
            bonds.add_zone(int(k) - beyond, int(k) + 2 + beyond)
        return f"finite differences and peridynamics, m = {self.horizon}"
