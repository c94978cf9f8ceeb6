"""Places between disks and of loads: motion between the disks of a lattice, and where loads start waves."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.load import Load
from dembound.disks.scene import DiskScene
from dembound.disks.supports import forces_of
from dembound.places import nearest

NINE = np.array([(across, up) for across in (-1, 0, 1) for up in (-1, 0, 1)])
"""Columns and rows of a patch, counted from its middle."""

PATCHES = (NINE, NINE[NINE[:, 0] == 0], NINE[NINE[:, 1] == 0], np.zeros((1, 2), dtype=int))
"""Columns and rows of patches, of which the first is taken that is all disks; in bodies two disks wide the second."""

ROUNDED = 1e-6
"""Distance from the rim of a hole, over the diameter, within which a disk may be in it after rounding."""

FARTHEST = 2.0
"""Cells from the middle of a patch up to which its polynomials are followed: one beyond its disks."""


def patch_around(scene: DiskScene, place: np.ndarray) -> np.ndarray:
    """Places (k, 2) m of the patch of disks whose middle is nearest to a place (2,) m, in the order of `PATCHES`.

    Nine disks, or three in a column or row where nine are not available, or only the nearest disk. Disks on the rim of
    a hole are left out: where the scene is moved, rounding may put them into the hole.
    """
    first, cell = scene.column_count, scene.ground.brick.mean_diameter
    disks = scene.positions[first : scene.disk_count]
    disks = disks[~_on_rims(scene.case, disks, ROUNDED * cell)]
    own = disks[nearest(disks, place[None])[0]]
    cells = np.rint((disks - own) / cell).astype(int)
    near = np.flatnonzero((np.abs(cells) <= 2).all(axis=1))
    disk_of = {tuple(cells[disk].tolist()): disk for disk in near}
    for patch in PATCHES:
        middles = [shift for shift in NINE if all(tuple(each) in disk_of for each in (patch + shift).tolist())]
        if middles:
            break
    middle = middles[nearest(own + cell * np.array(middles), place[None])[0]]
    return np.asarray(disks[[disk_of[tuple(each)] for each in (middle + patch).tolist()]])


def _on_rims(case: DiskCase, disks: np.ndarray, within: float) -> np.ndarray:
    """Mask (k,) of disks at (k, 2) m that are at most a distance (m) from a hole."""
    beside = (disks[:, None] + within * NINE).reshape(-1, 2)
    found = np.zeros(len(disks), dtype=bool)
    for hole in case.holes:
        found |= hole.takes(beside, case.packing.span).reshape(-1, len(NINE)).any(axis=1)
    return found


def weights_at(patch: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Interpolation weights (k,) at a place (2,) m of the motion of a patch of disks (k, 2) m.

    Exact for quadratic motion: Lagrange's polynomials through three places along x, times those along y, or one of them
    where a patch is one disk wide or high. Beyond `FARTHEST` cells they are constant, as in a continuum beyond the
    disks.
    """
    middle = patch[len(patch) // 2]
    weights = []
    for away, cell in zip(place - middle, patch[-1] - middle, strict=True):
        s = float(np.clip(away / cell, -FARTHEST, FARTHEST)) if cell > 0.0 else 0.0
        polynomials = np.array([-s * (1.0 - s) / 2.0, 1.0 - s * s, s * (1.0 + s) / 2.0])
        weights.append(polynomials if cell > 0.0 else np.ones(1))
    return np.outer(*weights).ravel()


class LoadPlace(NamedTuple):
    """A load as a source: force-weighted middle of its disks and requested middle, both (2,) m; its force, N."""

    middle: np.ndarray
    asked: np.ndarray
    force: float


def middle_of_loads(scene: DiskScene) -> np.ndarray | None:
    """The force-weighted middle (2,) m of the loads that start waves; None if waves enter through sides."""
    if not (found := places_of_loads(scene)):
        return None
    return np.average([each.middle for each in found], axis=0, weights=[each.force for each in found])


def places_of_loads(scene: DiskScene) -> list[LoadPlace]:
    """The places of the loads that start waves; none if they enter through sides.

    A load without a wave starts them by its sudden beginning, but not after a static stage.
    """
    case = scene.case
    if case.driving and not any(load.wave for load in case.load):
        return []
    found: list[LoadPlace] = []
    for load in case.load:
        if (load.wave is None and case.static is not None) or load.sides is not None:
            continue
        if load.pressure is not None:
            left, bottom, right, top = next(hole.box for hole in case.holes if hole.name == load.hole)
            middle = np.array([0.5 * (left + right), 0.5 * (bottom + top)])
            found.append(LoadPlace(middle, middle, abs(load.pressure) * (right - left + top - bottom)))
        elif not load.is_everywhere:
            middle, force = middle_of_forces(load, scene)
            found.append(LoadPlace(middle, _asked(load, scene), force))
    return found


def _asked(load: Load, scene: DiskScene) -> np.ndarray:
    """The place (2,) m of a force, or the middle of the part of its region that is in the scene."""
    if load.position is not None:
        return np.array(load.position)
    assert load.region is not None
    left, bottom, right, top = scene.case.packing.box
    corners = np.clip(np.reshape(load.region, (2, 2)), (left, bottom), (right, top))
    return np.asarray(corners.mean(axis=0))


def middle_of_forces(load: Load, scene: DiskScene) -> tuple[np.ndarray, float]:
    """The force-weighted middle (2,) m of the disks on which a load acts, and its total force, N."""
    nodes, forces = forces_of(load, scene)
    strength = np.hypot(*forces[:, :2].T)
    return np.average(scene.positions[nodes], axis=0, weights=strength), float(strength.sum())
