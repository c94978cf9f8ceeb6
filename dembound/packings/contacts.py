"""Contacts between disks in a periodic box."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from dembound.kernels import pack


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
    from dembound.kernels import near

    pairs, images = near.near_pairs(positions, radii, reach, box)
    return pairs.astype(np.int64), images.astype(np.int64)


def listed(
    positions: np.ndarray, radii: np.ndarray, box: np.ndarray, reach: float
) -> tuple[np.ndarray, np.ndarray, pack.Pairs]:
    """The pairs (b, 2) and images (b, 2) of `near_pairs`, and as a table for the kernels."""
    from dembound.kernels import pack

    pairs, images = near_pairs(positions, radii, box, reach)
    first, second = np.ascontiguousarray(pairs.T, dtype=np.uint32)
    shift_x, shift_y = np.ascontiguousarray((images * box).T)
    return pairs, images, pack.Pairs(first, second, shift_x, shift_y, radii[first] + radii[second])


def strip_order(positions: np.ndarray, width: float) -> np.ndarray:
    """The order (n,) of disks strip after strip along x, upwards within a strip.

    positions (n, 2) and the strip width in metres. Neighbours in space are then neighbours in RAM.
    """
    return np.lexsort((positions[:, 1], np.floor(positions[:, 0] / width)))
