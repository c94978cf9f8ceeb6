"""Contacts between disks at a plane of symmetry and their own mirror images."""

import numpy as np

from dembound.disks.material.packed_material import PackedMaterial
from dembound.laws import Stiffness
from dembound.packings.brick import Brick

LEVEL = 1e-6
"""Largest deviation from straight, and difference of radii, over the radius: rounding."""


def with_images(ground: PackedMaterial, axis: int, diameters: np.ndarray) -> Stiffness:
    """Constants of the contacts of disks (k,) with their images beyond a side, of diameters (k,) m.

    axis : of the side's normal. The distance of a disk from its image is that of equal disks straight across the side
    between bricks side by side, so that a lattice continues with its own contacts, touching or across a gap. Where a
    brick has no such disks, disks touch their images.
    """
    sizes, which = np.unique(diameters, return_inverse=True)
    distances = np.array([_distance(ground.brick, axis, size) for size in sizes.tolist()])[which]
    distances = np.where(np.isnan(distances), diameters, distances)
    return ground.law.stiffness(ground.moduli, 0.5 * diameters, 0.5 * diameters, distances)


def continues(brick: Brick, axis: int, diameters: np.ndarray) -> bool:
    """Whether bricks side by side have disks of all of these diameters (k,) m straight across a side."""
    return not any(np.isnan(_distance(brick, axis, each)) for each in np.unique(diameters).tolist())


def _distance(brick: Brick, axis: int, diameter: float) -> float:
    """Distance (m) of the nearest equal disks straight across a side; nan for none."""
    vectors, level = brick.vectors, 0.5 * diameter * LEVEL
    straight = (brick.images[:, axis] != 0) & (np.abs(vectors[:, 1 - axis]) <= level)
    equal = (np.abs(brick.radii[brick.pairs] - 0.5 * diameter) <= level).all(axis=1)
    distances = np.abs(vectors[straight & equal, axis])
    return float(distances.min()) if len(distances) else float("nan")
