"""Where disks and cracks are drawn: at the start, or where they have moved to; the frame round them."""

from collections.abc import Iterable, Mapping

import h5py
import numpy as np

from dembound.plot.disks import Window

FROM = 0.1
"""Displacement in mean diameters from which disks are drawn where they are."""

FRAMED = 0.999
"""Share of the disks, counted from either end along x and y, that a frame of moved disks has at least."""

FARTHEST = 1.0
"""Distance from the scene at the start, over its longer side, beyond which disks are out of the frame."""

PARTED = 1.3
"""Distance of two disks, over the sum of their radii, from which the crack between them is drawn no more."""


def exaggeration(file: h5py.File, groups: Iterable[h5py.Group], asked: float | None) -> float:
    """The factor of the displacements shown: as asked for, else 1 if some exceeds `FROM` diameters, or 0.

    groups : the snapshots of an open record.
    """
    if asked is not None:
        return asked
    least = FROM * 2.0 * float(file["particles/radius"][:].mean())
    return float(any(bool((np.abs(displacement_of(group)) > least).any()) for group in groups))


def displacement_of(snapshot: h5py.Group, name: str = "displacement") -> np.ndarray:
    """Displacement (n, 2) m in a snapshot, zero where it has none."""
    if name in snapshot:
        return np.asarray(snapshot[name][:, :2])
    return np.zeros((len(snapshot["velocity"]), 2))


def framed(scene: Window, positions: np.ndarray, radii: np.ndarray, moves: Iterable[np.ndarray]) -> Window:
    """The window of a scene with its disks, of positions (n, 2) and radii (n,) m, after each of some moves (n, 2) m.

    It leaves out the outermost disks, beyond `FRAMED` of all, and those farther than `FARTHEST` from the scene.
    """
    reach = FARTHEST * scene.size.max()
    window = scene
    for moved in moves:
        places = positions + moved
        ends = np.quantile(places, (1.0 - FRAMED, FRAMED), axis=0, method="inverted_cdf")
        low = np.maximum(ends[0] - radii.max(), scene.corner - reach)
        high = np.minimum(ends[1] + radii.max(), scene.corner + scene.size + reach)
        window = window.with_other(Window(low, high - low))
    return window


def crack_lines(
    cracks: Mapping[str, np.ndarray], positions: np.ndarray, radii: np.ndarray, moved: np.ndarray, factor: float
) -> np.ndarray:
    """Ends (k, 2, 2) m of the broken bonds, across the line between their disks, as wide as the smaller one.

    Where the disks have parted, by more than `PARTED`, the ends are not numbers.

    Parameters
    ----------
    cracks
        columns as by `cracks_until`.
    positions (n, 2), radii (n,)
        of the disks at the start, m.
    moved
        displacements (n, 2) of the disks, m.
    factor
        of the displacements in the picture.
    """
    first, second = cracks["particles"].T
    place = cracks["position"]
    along = place - positions[first]  # from the first disk to the contact: right for pairs across periodic sides, too
    contact = radii[first] + radii[second]
    along *= (contact / np.maximum(np.hypot(*along.T), 1e-300))[:, None]
    opening = moved[second] - moved[first]
    parted = np.hypot(*(along + opening).T) > PARTED * contact
    now = along + factor * opening
    across = np.stack([-now[:, 1], now[:, 0]], axis=1)
    across *= (np.minimum(radii[first], radii[second]) / np.maximum(np.hypot(*now.T), 1e-300))[:, None]
    middle = place + factor * 0.5 * (moved[first] + moved[second])
    ends = np.stack([middle - across, middle + across], axis=1)
    ends[parted] = np.nan
    return ends
