"""Where the loads of a scene start waves."""

from __future__ import annotations

import numpy as np

from dembound.casefile.disks.load import Load
from dembound.disks.loads import forces_of
from dembound.disks.scene import DiskScene


def middle_of_loads(scene: DiskScene) -> np.ndarray | None:
    """The middle (2,) m of the places where loads start waves, by force; None if waves enter through sides."""
    found = middles_of_loads(scene)
    return np.average([place for place, _ in found], axis=0, weights=[size for _, size in found]) if found else None


def middles_of_loads(scene: DiskScene) -> list[tuple[np.ndarray, float]]:
    """The middle (2,) m of each load that starts waves, and its force (N); none if they enter through sides.

    A load without a wave starts them by its sudden beginning, but not if a static stage comes before.
    """
    case = scene.case
    if case.driving and not any(load.wave for load in case.load):
        return []
    found: list[tuple[np.ndarray, float]] = []
    for load in case.load:
        if load.wave is None and case.static is not None:
            continue
        if load.pressure is not None:
            left, bottom, right, top = next(hole.box for hole in case.hole if hole.name == load.hole)
            middle = np.array([0.5 * (left + right), 0.5 * (bottom + top)])
            found.append((middle, abs(load.pressure) * (right - left + top - bottom)))
        elif not load.is_everywhere:
            found.append(middle_of_forces(load, scene))
    return found


def middle_of_forces(load: Load, scene: DiskScene) -> tuple[np.ndarray, float]:
    """The middle (2,) m of the disks on which a load acts, by force, and the sum of these forces, N."""
    nodes, forces = forces_of(load, scene)
    strength = np.hypot(*forces[:, :2].T)
    return np.average(scene.positions[nodes], axis=0, weights=strength), float(strength.sum())
