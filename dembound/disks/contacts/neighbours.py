"""Pairs of disks with small gaps, also through periodic sides."""

import numpy as np

from dembound.kernels import near
from dembound.kernels.tables import Cells

CELL = 4.0
"""Least side of a cell over the largest diameter.

In wider cells disks move apart more, in narrower ones disks of cells that do not touch may meet sooner.
"""


def pair_keys(first: np.ndarray, second: np.ndarray, image: np.ndarray, count: int) -> np.ndarray:
    """One number per pair, the same for either order of the two particles."""
    turned = (first > second) | ((first == second) & ((image[:, 0] < 0) | ((image[:, 0] == 0) & (image[:, 1] < 0))))
    low = np.where(turned, second, first).astype(np.int64)
    high = np.where(turned, first, second).astype(np.int64)
    image = np.where(turned[:, None], -image, image)
    return ((low * count + high) * 3 + image[:, 0] + 1) * 3 + image[:, 1] + 1


def near_pairs(
    positions: np.ndarray, radii: np.ndarray, skin: float, periods: tuple[float | None, float | None]
) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (b, 2) of disks with gaps up to skin (m), and the periods (b, 2) between them, each pair once.

    positions (n, 2), radii (n,) in m. Particles may have moved out of the period, as only differences of positions are
    used. Periods between a pair are never negative along x, nor along y alone.
    """
    lengths = np.array([length or 0.0 for length in periods])
    pairs, images = near.near_pairs(np.ascontiguousarray(positions), radii, skin, lengths)
    turned = (images[:, 0] < 0) | ((images[:, 0] == 0) & (images[:, 1] < 0))
    pairs[turned] = pairs[turned, ::-1]
    images[turned] *= -1
    return pairs, images


@np.errstate(over="ignore", invalid="ignore")  # of motion without bound, which ends the run
def cells_of(
    positions: np.ndarray, radii: np.ndarray, numbers: np.ndarray, periods: tuple[float | None, float | None]
) -> Cells:
    """Cells of disks at positions (n, 2) m with radii (n,) m, by their numbers (n,) in kernels."""
    low, diameter = positions.min(axis=0), 2.0 * float(radii.max())
    wraps = np.array([length is not None for length in periods])
    extent = np.array([np.ptp(x) if length is None else length for x, length in zip(positions.T, periods, strict=True)])
    side = max(CELL * diameter, float(np.sqrt(extent.prod() / len(radii))))  # not many more cells than disks
    count = np.clip(np.floor(extent / side), 1, len(radii)).astype(np.int64)
    width = np.where(extent > 0.0, extent / count, 1.0)
    place = np.floor((positions - low) / width).astype(np.int64)
    place = np.where(wraps, place % count, np.clip(place, 0, count - 1))
    cell = place[:, 1] * count[0] + place[:, 0]
    start = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=count.prod()))])
    # between cells that do not touch there is at least one cell
    split = count > np.where(wraps, 3, 2)
    reach = 0.5 * (float(width[split].min()) - diameter) if split.any() else np.inf
    return Cells(start, numbers[np.argsort(cell, kind="stable")], count, wraps, reach)
