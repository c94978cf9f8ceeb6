"""Nodes that are recorded besides particles, and the motion of places between nodes."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass

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


@dataclass(frozen=True, eq=False)
class Between:
    """A place whose motion is a sum over nodes, plus, if any, a motion that is known in advance.

    Attributes
    ----------
    place : (2,) m.
    node : (k,) int64. share : (k, 3, 3); displacement and velocity of the place are Σ share @ those of the nodes, by
    components x, y, rotation. known : times (s,) s -> displacement and velocity (s, 6) to be added; None: nothing.
    """

    place: np.ndarray
    node: np.ndarray
    share: np.ndarray
    known: Callable[[np.ndarray], np.ndarray] | None = None

    def at(self, times: np.ndarray, record: np.ndarray) -> np.ndarray:
        """Displacement and velocity (s, 6) in steps at times (s,) s, from those of its nodes (s, k, 6)."""
        return self.motion(record) if self.known is None else self.motion(record) + self.known(times)

    def motion(self, record: np.ndarray) -> np.ndarray:
        """The weighted sum (s, 6) over its nodes' displacements and velocities (s, k, 6) in s steps.

        Sums are in the order of the nodes, so that they have the same bits for any number of steps.
        """
        each = record.reshape(len(record), len(self.node), 2, 3)
        moved = np.zeros((len(record), 2, 3))
        for k, component in np.argwhere(self.share.any(axis=1)):
            moved += each[:, k, :, component, None] * self.share[k, :, component]
        return moved.reshape(-1, 6)
