"""The brick: a small periodic body of disks in force equilibrium, and its contacts."""

from __future__ import annotations

from dataclasses import dataclass
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


def contact_vectors(positions: np.ndarray, pairs: np.ndarray, images: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Vectors (b, 2) m from disk i to the touching image of disk j: x_j + images·box − x_i."""
    first, second = pairs.T
    return positions[second] + images * box - positions[first]


def contact_stress(vectors: np.ndarray, overlaps: np.ndarray, box: np.ndarray) -> np.ndarray:
    """Mean stress (3,) xx, yy, xy over the box, per unit contact modulus, compression negative.

    σ_ab = −Σ overlap · d_a d_b / |d| / (box area), with vectors d (b, 2) and overlaps (b,) in metres; a
    negative overlap is a gap and carries no force.
    """
    pull = -np.maximum(overlaps, 0.0) / np.hypot(*vectors.T) / np.prod(box)
    x, y = vectors.T
    return np.array([np.sum(pull * x * x), np.sum(pull * y * y), np.sum(pull * x * y)])


@dataclass(frozen=True, eq=False)
class Brick:
    """A periodic box of disks with its contacts; copies of it fit together without a seam.

    A pair may occur more than once with different images, and a disk may touch its own image: the one-disk
    brick of pattern A has the pairs (0, 0) with images (1, 0) and (0, 1).

    Attributes
    ----------
    size : (2,) m, the periodic box.
    positions : (n, 2) m, disk centres in [0, size).
    radii : (n,) m.
    pairs : (b, 2) int64, contacts i → j, each once.
    images : (b, 2) int64, the contact vector is ``positions[j] + images * size - positions[i]``.
    edge_rows : (n, 2) bool, member of the regular row on x = 0 (column 0) or on y = 0 (column 1).
    stress : (3,) xx, yy, xy of the packed state over the contact modulus E_c, compression negative.
    residual_ratio : mean |unbalanced force| / mean contact force, over the disks not held on a row.
    """

    size: np.ndarray
    positions: np.ndarray
    radii: np.ndarray
    pairs: np.ndarray
    images: np.ndarray
    edge_rows: np.ndarray
    stress: np.ndarray
    residual_ratio: float

    def check(self) -> None:
        """Raise ValueError if shapes, numbers or indices are not valid for a brick."""
        count, contacts = len(self.radii), len(self.pairs)
        shapes = {
            "size": (2,),
            "positions": (count, 2),
            "radii": (count,),
            "pairs": (contacts, 2),
            "images": (contacts, 2),
            "edge_rows": (count, 2),
            "stress": (3,),
        }
        if wrong := [name for name, shape in shapes.items() if getattr(self, name).shape != shape]:
            raise ValueError(f"{', '.join(wrong)} of a brick must be of other shapes")
        numbers = np.concatenate([self.size, self.positions.ravel(), self.radii, self.stress, [self.residual_ratio]])
        if not np.isfinite(numbers).all() or not (self.radii > 0.0).all() or not (self.size > 0.0).all():
            raise ValueError("a brick must have finite numbers, and positive radii and sizes")
        if contacts and not 0 <= self.pairs.min() <= self.pairs.max() < count:
            raise ValueError("pairs of a brick must be indices of its disks")

    @property
    def mass_offset(self) -> np.ndarray:
        """Centre of mass (2,) m less the centre of the box.

        Bricks side by side act on long waves like a uniform body of their extent that is shifted by so much.
        """
        return np.average(self.positions, axis=0, weights=self.radii**2) - 0.5 * self.size

    @property
    def row_widths(self) -> np.ndarray:
        """Widths (2,) m of uniform strips of the mass of the regular rows on x = 0 and on y = 0; 0 for none."""
        area = self.radii**2
        return self.size * (area @ self.edge_rows) / area.sum()

    @property
    def vectors(self) -> np.ndarray:
        """Contact vectors (b, 2) m, from the centre of i to the centre of j."""
        return contact_vectors(self.positions, self.pairs, self.images, self.size)

    @property
    def gaps(self) -> np.ndarray:
        """Gap of every contact (b,) m; negative where the disks overlap."""
        return np.hypot(*self.vectors.T) - self.radii[self.pairs].sum(axis=1)

    @property
    def solid_fraction(self) -> float:
        """Area of the disks over the area of the box (overlaps counted twice)."""
        return float(np.pi * np.sum(self.radii**2) / np.prod(self.size))

    @property
    def coordination(self) -> float:
        """Mean number of contacts per disk, 2b/n."""
        return 2.0 * len(self.pairs) / len(self.radii)

    @property
    def mean_diameter(self) -> float:
        """Mean disk diameter in metres, row disks included."""
        return float(2.0 * np.mean(self.radii))
