"""The mirror line of a scene, its middle line along x or y, and the images of its disks."""

import numpy as np

from dembound.disks.scene import DiskScene

ROUNDING = 1e-9
"""Distance over radius up to which a disk is at the place of another one's image."""


def middle(scene: DiskScene, axis: int) -> float:
    """The coordinate (m) of the mirror line across an axis."""
    along = scene.positions[:, axis]
    return 0.5 * float(along.min() + along.max())


def mirror_line(scene: DiskScene, axis: int) -> str:
    """The mirror line across an axis in words."""
    return f"{'xy'[axis]} = {middle(scene, axis):g} m"


def not_mirrored(scene: DiskScene, axis: int, what: str) -> str:
    """In words, that something in the plural has no mirror images across an axis."""
    return f"the {what} are not mirror-symmetric about {mirror_line(scene, axis)}"


def signs_of_images(axis: int, antisymmetric: bool) -> np.ndarray:
    """Factors (3,) of the motion of an image, by component."""
    signs = np.array([1.0, 1.0, -1.0])
    signs[axis] = -1.0
    return -signs if antisymmetric else signs


def disks_at_images(scene: DiskScene, axis: int) -> np.ndarray | None:
    """The disk (n,) at the place of each one's image, itself on the line; None if one has none of the same radius."""
    from scipy.spatial import cKDTree

    images, radii = scene.positions.copy(), scene.assembly.radii
    images[:, axis] = 2.0 * middle(scene, axis) - images[:, axis]
    distance, mirrored = cKDTree(scene.positions).query(images)
    far = distance > ROUNDING * radii
    unlike = np.abs(radii - radii[mirrored]) > ROUNDING * radii
    return None if (far | unlike).any() else mirrored
