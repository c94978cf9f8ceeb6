"""Skins of disks: gaps of pairs are listed up to the sum of both, and the list holds while disks move less."""

import numpy as np

from dembound.kernels.tables.contacts import Cells

SKIN, MOVING = 0.05, 0.12
"""Skins of two disks together over the mean diameter: at the start, and once disks move."""

AHEAD = 20.0
"""Steps for whose motion, beyond that of the disks around it, the skin of a fast disk is enough."""

SLOW = 0.7
"""Share of its skin that a disk may move in so many steps and not count as fast."""

WIDEST = 0.5
"""Largest skin over the mean diameter: wider ones make the cells of the search too wide."""


def cell_of(cells: Cells) -> np.ndarray:
    """Number of the cell of each of the disks (n,)."""
    found = np.zeros(int(cells.member.max(initial=-1)) + 1, dtype=np.int64)
    found[cells.member] = np.repeat(np.arange(len(cells.start) - 1), np.diff(cells.start))
    return found


def skins_of(way: np.ndarray, cell: np.ndarray, diameter: float) -> np.ndarray:
    """Skins (m,) m of disks that move by way (2, m) m in a step: wider for those faster than others in their cell.

    cell : (m,) numbers; diameter : m, the mean one.
    """
    base, usual = 0.5 * MOVING * diameter, np.ones(len(cell))
    for _ in range(2):  # the second mean is without the fast ones
        weight = np.maximum(np.bincount(cell, usual), 1e-300)
        mean = np.array([np.bincount(cell, usual * each) / weight for each in way])
        ahead = AHEAD * np.hypot(*(way - mean[:, cell]))
        usual = (ahead <= np.median(ahead) + base).astype(float)
    found: np.ndarray = np.minimum(base + np.maximum(ahead - SLOW * base, 0.0), WIDEST * diameter)
    return found
