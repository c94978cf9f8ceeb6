"""The intervals into which the power diagram of disks cuts a line: one face of a joint for each disk beside it."""

import numpy as np

REACH = 2.0
"""Largest distance from the foot of a disk's centre to an end of its interval, over the largest radius."""

ALONE = 1.0
"""The same, over its own radius, at an end beyond which no other disk has a part of the line within `REACH`."""


def intervals(along: np.ndarray, height: np.ndarray, radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper end (k,) m of the part of a line that lies in each disk's cell; nan where there is none.

    A point belongs to the disk of the smallest power, distance² − R² (Aurenhammer 1987). On a line the power of a disk
    at s along it is s² − 2 s_i s + s_i² + h_i² − R_i², so that the cells of two disks meet where two straight lines
    cross. along, height : (k,) m, of the centres along the line and from it.
    """
    power = along**2 + height**2 - radius**2
    apart = along[None, :] - along[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        meet = (power[None, :] - power[:, None]) / (2.0 * apart)
    high = np.where(apart > 0.0, meet, np.inf).min(axis=1, initial=np.inf)
    low = np.where(apart < 0.0, meet, -np.inf).max(axis=1, initial=-np.inf)
    behind = ((apart == 0.0) & (power[None, :] < power[:, None])).any(axis=1)
    reach, alone = REACH * radius.max(initial=0.0), ALONE * radius
    low = np.where(low < along - reach, along - alone, low)
    high = np.where(high > along + reach, along + alone, high)
    there = (high > low) & ~behind
    return np.where(there, low, np.nan), np.where(there, high, np.nan)
