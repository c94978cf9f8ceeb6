"""Where disks and cracks are drawn: at the start, or where they have moved to; the frame round them."""

from collections.abc import Iterable, Mapping

import h5py
import numpy as np

from dembound.plot.disks import Window

FROM = 0.1
"""Displacement in mean diameters from which disks are drawn where they are."""

BODY = 0.95
"""Share of the disks along x and along y between whose ends the body is."""

FARTHEST = 0.5
"""Distance from the body, over its longer side, beyond which disks are far from it."""

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


def are_near(places: np.ndarray, radii: np.ndarray, scene: Window) -> np.ndarray:
    """The disks (n,) in a scene or not far from the body, at places (n, 2) and of radii (n,) m."""
    share = 0.5 * (1.0 - BODY)
    low, high = np.quantile(places, (share, 1.0 - share), axis=0)
    reach = FARTHEST * (high - low).max() + 2.0 * radii.max()
    around = Window(low - reach, high - low + 2.0 * reach)
    return around.touches(places, radii) | scene.touches(places, radii)


def near_ones(file: h5py.File, snapshot: h5py.Group) -> np.ndarray:
    """The disks (n,) of a snapshot of an open record in the scene at the start or not far from the body."""
    start, radii = file["particles/position"][:], file["particles/radius"][:]
    return are_near(start + displacement_of(snapshot), radii, Window.around(start, radii))


def framed(scene: Window, positions: np.ndarray, radii: np.ndarray, moves: Iterable[np.ndarray]) -> Window:
    """The window of a scene with its disks, of positions (n, 2) and radii (n,) m, after each of some moves (n, 2) m.

    It leaves out those that are then far from the body.
    """
    window = scene
    for moved in moves:
        places = positions + moved
        near = are_near(places, radii, scene)
        window = window.with_other(Window.around(places[near], radii[near]))
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
    contact = radii[first] + radii[second]
    along, broke = positions[second] - positions[first], cracks["position"] - positions[first]
    broke *= (contact / np.maximum(np.hypot(*broke.T), 1e-300))[:, None]
    across_periodic_sides = np.hypot(*along.T) > 2.0 * contact
    along[across_periodic_sides] = broke[across_periodic_sides]
    opening = moved[second] - moved[first]
    parted = np.hypot(*(along + opening).T) > PARTED * contact
    now = along + factor * opening
    across = np.stack([-now[:, 1], now[:, 0]], axis=1)
    across *= (np.minimum(radii[first], radii[second]) / np.maximum(np.hypot(*now.T), 1e-300))[:, None]
    middle = positions[first] + factor * moved[first] + (radii[first] / contact)[:, None] * now
    ends = np.stack([middle - across, middle + across], axis=1)
    ends[parted] = np.nan
    return ends
