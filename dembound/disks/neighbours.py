"""Pairs of disks with small gaps, also through periodic sides."""

import numpy as np

from dembound.kernels import near


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
