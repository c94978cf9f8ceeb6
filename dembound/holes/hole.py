"""The base of all holes: a name, a stage, and the particles to remove."""

from abc import ABC, abstractmethod
from typing import Literal, Self

import numpy as np

from dembound.holes.outline import Outline
from dembound.table import Box, FileName, Table, quantity


class Hole(Table, ABC):
    """An area without particles: those centred in it are removed, and also those that this separates from the body."""

    type: str
    name: FileName = quantity(..., unit="1", help="name of the hole in messages")
    stage: Literal["before", "after"] = quantity(
        "before",
        unit="1",
        help="whether the body is built with the hole or it is excavated after the static stage, which then goes on",
    )

    @abstractmethod
    def contains(self, positions: np.ndarray) -> np.ndarray:
        """Which positions (k, 2) m lie in it, (k,) bool."""

    @abstractmethod
    def shifted(self, by: tuple[float, float]) -> Self:
        """The hole shifted by (x, y) m."""

    @property
    @abstractmethod
    def box(self) -> Box:
        """The smallest rectangle around it: x0, y0, x1, y1 in m."""

    @property
    def outline(self) -> Outline | None:
        """The rim of the hole, which a pressure on its wall needs; None unless it is a simple closed curve."""
        return None
