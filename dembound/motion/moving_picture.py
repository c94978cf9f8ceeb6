"""The interface of pictures that change with time, for pages and movies."""

from typing import Protocol

import numpy as np


class MovingPicture(Protocol):
    """A body at the snapshots of its record, all with the same axes and colours.

    Attributes
    ----------
    times : (k,) of the snapshots, s.
    width, height : of each frame in inches.
    words : description of the drawn field.
    """

    times: np.ndarray
    width: float
    height: float
    words: str

    def caption(self, index: int) -> str:
        """The time of a frame, and events until then, in words."""

    def frame(self, index: int, pixels: int) -> np.ndarray:
        """One frame as a picture (rows, pixels, 3) of red, green and blue from 0 to 255."""
