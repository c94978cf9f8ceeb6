"""The base of all methods for bars."""

from abc import ABC, abstractmethod

import numpy as np

from dembound.methods.bonds import Bonds, Rod
from dembound.table import Table


class Method(Table, ABC):
    """How the nodes of a bar are bonded, and what becomes of the bonds when they are stretched."""

    type: str

    @property
    @abstractmethod
    def name(self) -> str:
        """What the method does at first, for reports."""

    @property
    @abstractmethod
    def largest_horizon(self) -> int:
        """The largest horizon (in spacings) it ever uses; 1 for local springs."""

    @property
    def soft_ends(self) -> bool:
        """Whether the bar is ever softer near its ends than elsewhere."""
        return False

    @abstractmethod
    def begin(self, rod: Rod) -> Bonds:
        """The bonds it begins with."""

    def stages(self, rod: Rod) -> list[Bonds]:
        """Bonds of the whole bar at each stage it may come to: what the time step must be stable for."""
        return [self.begin(rod)]

    @abstractmethod
    def on_trigger(self, bonds: Bonds, u: np.ndarray) -> str:
        """Change the bonds where springs are triggered at displacements u (n,) m, so that these are triggered no more.

        Returns what the method does from now on, for reports.
        """
