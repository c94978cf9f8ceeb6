"""Skins of disks: gaps of pairs are listed up to the sum of both, and the list holds while disks move less."""

import numpy as np

from dembound.kernels.listing import ahead_of_others
from dembound.kernels.tables.contacts import Cells

SKIN, MOVING = 0.05, 0.25
"""Skins of two disks together over the mean diameter: at the start, and once disks move."""

AHEAD = 20.0
"""Steps for whose motion, beyond that of the disks around it, the skin of a fast disk is enough."""

SLOW = 0.7
"""Share of its skin that a disk may move in so many steps and not count as fast."""

WIDEST = 0.5
"""Largest skin over the mean diameter."""


def skins_of(velocity: np.ndarray, begin: int, cells: Cells, time_step: float, diameter: float) -> np.ndarray:
    """Skins (slots,) m of disks: wider for those faster than others in their cell.

    velocity : (3, …) m/s, those of the disks from slot `begin` on; diameter : m, the mean one.
    """
    base = 0.5 * MOVING * diameter
    ahead = ahead_of_others(velocity, begin, cells, AHEAD * time_step, base)
    found: np.ndarray = np.minimum(base + np.maximum(ahead - SLOW * base, 0.0), WIDEST * diameter)
    return found
