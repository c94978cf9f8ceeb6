"""What the loop asks of an engine, the way in which a scene is stepped."""

from abc import ABC, abstractmethod

import numpy as np

from dembound.contacts import Cracks
from dembound.kernels.tables import Body, Log, Supports


class Engine(ABC):
    """Moves the nodes of a scene.

    Attributes
    ----------
    name : what the reports call its law or method.
    ended : whether another engine has to go on from here.
    """

    name: str
    ended = False

    @abstractmethod
    def advance(
        self, u: np.ndarray, spare: np.ndarray, v: np.ndarray, number: int, body: Body, supports: Supports, log: Log
    ) -> int:
        """Advance by the steps of supports.drive, or as far as it can; returns the steps done.

        u, spare, v : (3, n) displacement now, room for the next one, velocity half a step ago; number : the first
        step's; the bundles are explained in kernels/tables.py.
        """

    @abstractmethod
    def stored(self, displacement: np.ndarray) -> tuple[float, float]:
        """Strain energy (J) at displacements (3, n): in contacts and in bonds, of a bar in springs and in bonds."""

    @abstractmethod
    def take_cracks(self, steps: int) -> Cracks:
        """The bonds that broke since this was last called; steps: those done by now."""

    def blown_up(self, velocity: np.ndarray) -> int | None:
        """The node at which the run gains energy from nothing, as far as the engine can tell; velocity (3, n) m/s."""
        return None

    def snapshot(self, displacement: np.ndarray) -> dict[str, tuple[np.ndarray, str]]:
        """What it knows of every node at displacements (3, n), by name: values (n, …) and unit."""
        return {}
