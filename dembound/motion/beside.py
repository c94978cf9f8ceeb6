"""Nodes of a scene that are recorded separately from its particles, such as those of a continuum round a body."""

from abc import ABC, abstractmethod

import numpy as np


class Beside(ABC):
    """The m nodes of a scene that are recorded separately.

    Attributes
    ----------
    nodes : their range among the nodes of the scene.
    """

    nodes: slice

    @property
    @abstractmethod
    def columns(self) -> dict[str, tuple[np.ndarray, str]]:
        """Data of these nodes for the record, by name: values (m, …) and unit."""

    @abstractmethod
    def motion(self, values: np.ndarray, of: str, time: float) -> dict[str, np.ndarray]:
        """Motion (m, 3) of these nodes by prefix of its name, from the motion of all nodes (n, 3) of the scene.

        The prefix "" is the total motion. of : "displacement" or "velocity"; time : of the values, s.
        """
