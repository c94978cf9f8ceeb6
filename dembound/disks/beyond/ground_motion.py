"""The ground's motion without the body at the nodes of a continuum, from the motion of the free-field column.

Beside a column the continuum has the scattered motion only. The ground's motion depends on the height alone, as waves
come from straight below: it is interpolated between the means of the column's disks in bands one diameter high, on a
lattice its rows. In random packings the means differ from the motion of the equivalent continuum by the mean of the
correctors (material/homogenise.py) in a band, some per cent of a diameter times the strain.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np


class _Bands(NamedTuple):
    """Bands of disks: band (c,) of each disk, share (c,) of each in the mass of its band, height (b,) m of each."""

    band: np.ndarray
    share: np.ndarray
    height: np.ndarray


class GroundMotion:
    """Motion at some heights, from the motion of the disks of a column.

    Parameters
    ----------
    up : (c,) m, heights of the column's disks. mass : (c,) kg. diameter : m, height of a band. heights : (m,) m.
    """

    def __init__(self, up: np.ndarray, mass: np.ndarray, diameter: float, heights: np.ndarray) -> None:
        self._up, self._mass, self._diameter, self._heights = up, mass, diameter, heights

    @cached_property
    def _bands(self) -> _Bands:
        """The bands that have disks."""
        row = np.floor((self._up - self._up.min()) / self._diameter + 0.5).astype(np.int64)
        _, band = np.unique(row, return_inverse=True)
        share = self._mass / np.bincount(band, self._mass)[band]
        return _Bands(band, share, np.bincount(band, share * self._up))

    def at_heights(self, values: np.ndarray) -> np.ndarray:
        """Displacements or velocities (m, 3) from those of the column's disks (c, 3); rotations are zero.

        Constant beyond the first and last bands.
        """
        band, share, height = self._bands
        motion = np.zeros((len(self._heights), 3))
        for axis in (0, 1):
            motion[:, axis] = np.interp(self._heights, height, np.bincount(band, share * values[:, axis]))
        return motion
