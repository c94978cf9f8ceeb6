"""Contacts between disks in a periodic box."""

import numpy as np

from dembound.packings.brick import contact_vectors


def wrap(positions: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Positions (n, 2) m moved by whole boxes (2,) m into [0, box)."""
    inside = np.mod(positions, box)
    return np.where(inside >= box, 0.0, inside)  # mod rounds −1e-17 up to the box itself


def near_pairs(
    positions: np.ndarray, radii: np.ndarray, box: np.ndarray, reach: float
) -> tuple[np.ndarray, np.ndarray]:
    """All pairs of disks whose gap is at most `reach` (m), through the periodic faces too.

    positions (n, 2) in [0, box), radii (n,), box (2,) in metres. The box must be wider than
    2·(largest diameter + reach), so that a pair can touch at one image only. Returns pairs (b, 2) int64 with i < j,
    sorted, and images (b, 2) int64: the contact vector is x_j + images·box − x_i.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(positions, boxsize=box)
    pairs = tree.query_pairs(2.0 * radii.max() + reach, output_type="ndarray").astype(np.int64)
    pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
    first, second = pairs.T
    images = -np.rint((positions[second] - positions[first]) / box).astype(np.int64)
    vectors = contact_vectors(positions, pairs, images, box)
    near = np.hypot(*vectors.T) - radii[first] - radii[second] <= reach
    return pairs[near], images[near]


def strip_order(positions: np.ndarray, width: float) -> np.ndarray:
    """The order (n,) of disks strip after strip along x, upwards within a strip.

    positions (n, 2) and the strip width in metres. Neighbours in space are then neighbours in memory.
    """
    return np.lexsort((positions[:, 1], np.floor(positions[:, 0] / width)))
