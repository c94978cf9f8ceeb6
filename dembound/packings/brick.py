"""The brick: a small periodic body of disks in force equilibrium, its contacts, and packed bricks kept on disk.

A brick depends only on its parameters, so a file is never out of date. It ends with a digest of all bytes before it;
a damaged file, or one without a valid brick, is packed again and replaced, with a line in the log.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import json
import logging
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from filelock import Timeout

from dembound.errors import RecordError
from dembound.files import DAMAGED, arrays_of, content_of, lock_of, replacing
from dembound.interrupts import look
from dembound.machine import private_folder, user_cache

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


LOGGER = logging.getLogger(__name__)

FORMAT = 3  # raise it whenever the packing procedure or the file layout changes

LOOK = 0.5
"""Seconds between two checks for a request to end, while another process packs."""

LARGEST, EXPANDED = 2**29, 16
"""Largest size (bytes) of a file that is read, and of its arrays over the file: numbers are hardly compressed."""

DIGEST = hashlib.sha256
"""Computes the digest at the end of a file, which is still a valid NPZ file."""


def cache_folder() -> Path:
    """Folder of the bricks: the environment variable DEMBOUND_CACHE, else the user's cache folder.

    It is a private temporary one where that cannot be written.
    """
    chosen = os.environ.get("DEMBOUND_CACHE")
    return Path(chosen) if chosen else (user_cache() or private_folder()) / "bricks"


def load_or_pack(key_params: Mapping[str, Any], pack: Callable[[], Brick]) -> Brick:
    """The brick with these parameters, from the cache, else packed and written to it.

    key_params contains all parameters of the brick, as JSON values; pack() makes it. If another process is packing the
    same brick, this call waits for it. If a brick cannot be written (no space, no permission), it is still returned.
    """
    path = cache_folder() / f"brick-{_digest(key_params)}.npz"
    if (brick := _load(path)) is not None:
        return brick
    with _alone(path.with_suffix(".lock")) as waited:
        if not waited or (brick := _load(path)) is None:
            brick = pack()
            _save(brick, path)
    return brick


@contextlib.contextmanager
def _alone(path: Path) -> Iterator[bool]:
    """Inside, no other process holds this lock; yields whether another one had to be waited for.

    If no lock can be made, as in a folder without permission to write, it does not wait.
    """
    lock, waited = None, False
    with contextlib.suppress(OSError, NotImplementedError, RecordError):
        path.parent.mkdir(parents=True, exist_ok=True)
        lock = lock_of(path)
        try:
            lock.acquire(blocking=False)
        except Timeout:
            waited = True
            while not lock.is_locked:
                look()
                with contextlib.suppress(Timeout):
                    lock.acquire(timeout=LOOK)
    try:
        yield waited
    finally:
        if lock is not None and lock.is_locked:
            with contextlib.suppress(OSError):  # Windows keeps a file that is open
                path.unlink()
            lock.release()


def clear() -> int:
    """Delete all cached bricks and return their number."""
    files = list(cache_folder().glob("brick-*.npz"))
    for path in files:
        path.unlink(missing_ok=True)
    return len(files)


def _digest(key_params: Mapping[str, Any]) -> str:
    text = json.dumps({"format": FORMAT, **key_params}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def _load(path: Path) -> Brick | None:
    """The brick of a file; None if there is no file or it is damaged, in which case it is logged."""
    size = DIGEST().digest_size
    try:
        content = content_of(path, LARGEST)
    except OSError:
        return None
    except RecordError:  # a link, or what cannot be a brick
        content = b""
    if content and DIGEST(content[:-size]).digest() == content[-size:]:
        with contextlib.suppress(*DAMAGED):  # written by something else
            arrays = arrays_of(io.BytesIO(content), EXPANDED * len(content))
            brick = Brick(**{**arrays, "residual_ratio": float(arrays["residual_ratio"])})
            brick.check()
            return brick
    LOGGER.info("the cached brick %s is damaged, it is packed again", path)
    return None


def _save(brick: Brick, path: Path) -> None:
    content = io.BytesIO()
    np.savez_compressed(content, **asdict(brick))
    with contextlib.suppress(OSError, RecordError):  # without a cache only time is lost
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as file:
            file.write(content.getvalue() + DIGEST(content.getvalue()).digest())
