"""The base of all methods for bars, and of those that change when something is about to break."""

from abc import ABC, abstractmethod

import numpy as np

from dembound.methods.bonds import Bonds
from dembound.methods.rod import Rod
from dembound.table import Table, quantity

WIDEST = 1000
"""Largest horizon in spacings: the time to compute the step limit grows with its square, to minutes."""


class Method(Table, ABC):
    """How the nodes of a bar are bonded, and how bonds change when they are stretched."""

    type: str

    @property
    @abstractmethod
    def name(self) -> str:
        """Name of the method at the start, for reports."""

    @property
    @abstractmethod
    def largest_horizon(self) -> int:
        """The largest horizon (in spacings) of all its stages; 1 for local springs."""

    @property
    def horizon_beyond(self) -> int:
        """The horizon (in spacings) of the bonds in layers beyond the ends, at all stages; 1 for local springs."""
        return 1

    @property
    def soft_ends(self) -> bool:
        """Whether in some stage the bar is softer near its ends than elsewhere."""
        return False

    @abstractmethod
    def begin(self, rod: Rod) -> Bonds:
        """The first bonds."""

    def stages(self, rod: Rod) -> list[Bonds]:
        """Bonds of the whole bar at each possible stage; the time step must be stable for all of them."""
        return [self.begin(rod)]

    @abstractmethod
    def on_trigger(self, bonds: Bonds, u: np.ndarray) -> str:
        """Change the bonds where springs are triggered at displacements u (n,) m, so that they no longer trigger.

        Returns the name of the method from now on, for reports.
        """


class Peridynamic(Method):
    """A method with bonds of several lengths, in the whole bar or in parts of it, from the beginning or later."""

    horizon: int = quantity(means="count", ge=1, le=WIDEST)
    """horizon m in spacings, at most half of those in the bar"""

    @property
    def largest_horizon(self) -> int:
        """The horizon m."""
        return self.horizon


class Triggered(Peridynamic):
    """Local springs until a stretch reaches `trigger` of the critical one, peridynamics of some kind from then on."""

    trigger: float = quantity(0.9, means="share", gt=0.0, le=1.0)
    """share of the critical stretch at which peridynamics begins"""
