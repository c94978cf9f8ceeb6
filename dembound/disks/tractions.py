"""The target stress of a static stage, applied as tractions on the sides of the body."""

import numpy as np

from dembound.disks.balance import mean_rotations
from dembound.disks.constants import limits_of
from dembound.disks.scene import DiskScene
from dembound.kernels.contacts import UPDATED

RIM = 4.0
"""Width, in mean diameters, of the rim that is left out of the mean stress."""

CLOSE = 5e-3
"""Error of the mean stress, over its largest component, below which the target is reached."""

CORRECTIONS = 5
"""Largest number of corrections of the tractions; each reduces the error to a few per cent of it."""


class Tractions:
    """Forces on the sides of a body under a mean stress, corrected until the stress inside has this value.

    The outer disks of a cut packing have fewer bonds and carry less than their share of the stress. With tractions σ·n
    the stress inside is therefore some per cent larger.

    Parameters
    ----------
    scene : the body.
    stress : (3,) target xx, yy, xy in Pa, tension positive.
    applied : (3,) Pa, tractions found before an excavation, which keep their value; None: the target stress.

    Attributes
    ----------
    applied : (3,) Pa, the stress of the tractions.
    corrections_left : how often they may still be corrected.
    """

    def __init__(self, scene: DiskScene, stress: tuple[float, float, float], applied: np.ndarray | None = None) -> None:
        self.scene = scene
        self.asked = np.array(stress)
        self.applied = self.asked.copy() if applied is None else applied.copy()
        self.corrections_left = CORRECTIONS if applied is None and _is_wide(scene) else 0
        self._follow = limits_of(scene.case.material).geometry == UPDATED

    def forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces (3, n) N at displacements (3, n), by the share of the particles' widths in their side's diameters.

        With the updated geometry they rotate with their side. Small additional forces cancel the torque that results
        from uneven and strained sides.
        """
        moved = displacement if self._follow else np.zeros_like(displacement)
        force = np.zeros_like(displacement)
        xx, yy, xy = self.applied
        rotations = mean_rotations(self.scene, moved)
        for side, edge in self.scene.edges.items():
            angle = rotations.get(side, 0.0)
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            sign = 1.0 if side in ("right", "top") else -1.0
            pull = turn @ np.array([xx, xy] if edge.axis == 0 else [xy, yy]) * sign * edge.length
            force[:2, edge.nodes] += pull[:, None] * edge.widths / edge.diameters.sum()
        loaded = np.unique(np.concatenate([edge.nodes for edge in self.scene.edges.values()]))
        return _without_torque(force, self.scene.assembly.positions + moved[:2].T, loaded)

    def correct(self, stress: np.ndarray) -> bool:
        """Add the error of the mean stress (3,) Pa inside to the tractions; returns whether there was an error."""
        lacking = self.asked - stress
        largest = np.abs(self.asked).max()
        if self.corrections_left == 0 or largest == 0.0 or np.abs(lacking).max() <= CLOSE * largest:
            return False
        self.corrections_left -= 1
        self.applied += lacking
        return True


def mean_stress(scene: DiskScene, stress: np.ndarray) -> np.ndarray:
    """Mean stress (3,) inside a body, away from its sides; holes count as zero. stress (n, 3) of each particle.

    The mean is taken over the area of the particles, or with a hole over the whole rectangle inside the rim.
    """
    inside = _inside(scene)
    area = (scene.assembly.radii**2 * scene.cell_fraction)[inside]
    mean = np.average(stress[inside], axis=0, weights=area)
    if not scene.case.hole or inside.all():
        return mean
    whole = np.prod(scene.assembly.size - 2.0 * RIM * scene.ground.brick.mean_diameter)
    return mean * min(1.0, np.pi * float(area.sum()) / scene.ground.brick.solid_fraction / whole)


def _is_wide(scene: DiskScene) -> bool:
    """Whether half the width and height of a body are inside the rim; otherwise the mean has too few particles."""
    width = [scene.assembly.size[axis] for axis, low in enumerate(("left", "bottom")) if low in scene.edges]
    return all(length >= 4.0 * RIM * scene.ground.brick.mean_diameter for length in width)


def _inside(scene: DiskScene) -> np.ndarray:
    """Particles (n,) bool inside the rim along the sides; all of a small scene."""
    depth = RIM * scene.ground.brick.mean_diameter
    inside = np.ones(scene.disk_count, dtype=bool)
    for axis, low in enumerate(("left", "bottom")):
        if low in scene.edges:
            place = scene.assembly.positions[:, axis] - scene.assembly.origin[axis]
            inside &= (place > depth) & (place < scene.assembly.size[axis] - depth)
    return inside if inside.any() else np.ones(scene.disk_count, dtype=bool)


def _without_torque(force: np.ndarray, positions: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """Forces (3, n) without torque, by small additional forces on the loaded particles (k,); positions (n, 2) m."""
    arm = positions - positions[loaded].mean(axis=0)
    torque = np.sum(arm[:, 0] * force[1] - arm[:, 1] * force[0])
    turn = np.stack([-arm[loaded, 1], arm[loaded, 0]])
    if (size := np.sum(turn**2)) > 0.0:  # a single disk has no arm
        force[:2, loaded] -= torque / size * turn
    return force
