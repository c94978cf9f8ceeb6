"""What every method for bars can answer."""

from abc import ABC, abstractmethod

import numpy as np

from dembound.methods.bonds import Bonds, Rod
from dembound.table import Table


class Method(Table, ABC):
    """How the nodes of a bar are bonded, and what becomes of the bonds when they are stretched."""

    @property
    @abstractmethod
    def name(self) -> str:
        """What the method does at first, for reports."""

    @property
    @abstractmethod
    def largest_horizon(self) -> int:
        """The largest horizon (in spacings) it ever uses; 1 for local springs."""

    @abstractmethod
    def begin(self, rod: Rod) -> Bonds:
        """The bonds it begins with."""

    def stages(self, rod: Rod) -> list[Bonds]:
        """Bonds of the whole bar at each stage it may come to: what the time step must be stable for."""
        return [self.begin(rod)]

    def answer(self, bonds: Bonds, u: np.ndarray, before: np.ndarray, step: int) -> tuple[float, str]:
        """Answer springs that have asked in step `step`, at displacements u (n,) m, those a step ago being `before`.

        Returns the energy (J) that breaking took, and what the method does from now on, for reports.
        """
        return bonds.break_springs(u, before, step), self.name
