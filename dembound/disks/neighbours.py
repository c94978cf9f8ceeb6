"""Pairs of disks with small gaps, also through periodic sides."""

from itertools import product

import numpy as np


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
    used.
    """
    from scipy.spatial import cKDTree

    reach = 2.0 * radii.max() + skin
    period = np.array([length or 0.0 for length in periods])
    tree = cKDTree(positions)
    inside = tree.query_pairs(reach, output_type="ndarray").astype(np.int64)
    found = [(inside, np.zeros_like(inside))]
    for way in _half_of_the_images(periods):
        across = tree.sparse_distance_matrix(cKDTree(positions + way * period), reach, output_type="ndarray")
        met = np.column_stack([across["i"], across["j"]]).astype(np.int64)
        found.append((met, np.broadcast_to(way, met.shape)))
    pairs = np.concatenate([listed for listed, _ in found])
    image = np.concatenate([images for _, images in found])
    gap = np.hypot(*(positions[pairs[:, 1]] + image * period - positions[pairs[:, 0]]).T) - radii[pairs].sum(axis=1)
    near = gap <= skin
    return pairs[near], image[near]


def _half_of_the_images(periods: tuple[float | None, float | None]) -> list[np.ndarray]:
    """Neighbouring images of a periodic scene; of two opposite images only one, as both give the same pairs."""
    steps = [(-1, 0, 1) if period else (0,) for period in periods]
    return [np.array(image) for image in product(*steps) if image > (0, 0)]
