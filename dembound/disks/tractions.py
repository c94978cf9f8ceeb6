"""The target stress of a static stage, applied by forces on the sides of the body."""

import numpy as np

from dembound.disks.balance import mean_rotations
from dembound.disks.block_stress import RIM
from dembound.disks.constants import limits_of
from dembound.disks.scene import DiskScene
from dembound.disks.side_forces import side_forces
from dembound.kernels.contacts import UPDATED

CLOSE = 5e-3
"""Error of the mean stress, over its largest component, below which the target is reached."""

CORRECTIONS = 5
"""Largest number of corrections of the tractions; each reduces the error to a few per cent of it."""


class Tractions:
    """Forces on the sides of a body under a mean stress, corrected until the stress inside has this value.

    They are those of the packing beyond (`side_forces`), under which an elastic body has the target stress everywhere.
    Where contacts slide or open, or strains are large, the stress inside may differ by some per cent.

    Parameters
    ----------
    scene : the body.
    stress : (3,) target xx, yy, xy in Pa, tension positive.
    applied : (3,) Pa, tractions found before an excavation, which keep their value; None: the target stress.

    Attributes
    ----------
    applied : (3,) Pa, the stress of the tractions.
    corrections_left : how often they may still be corrected.
    nodes : (k,) disks on which they act, ascending.
    """

    def __init__(self, scene: DiskScene, stress: tuple[float, float, float], applied: np.ndarray | None = None) -> None:
        self.scene = scene
        self.asked = np.array(stress)
        self.applied = self.asked.copy() if applied is None else applied.copy()
        self.corrections_left = CORRECTIONS if applied is None and _is_wide(scene) else 0
        self._follow = limits_of(scene.case.material).geometry == UPDATED
        self._sides = side_forces(scene)
        self.nodes = np.unique(np.concatenate([each.node for each in self._sides.values()]))

    def forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, n) N and N·m at displacements (3, n).

        With the updated geometry the forces rotate with their side. Small additional forces cancel the torque that
        results from strained sides.
        """
        moved = displacement if self._follow else np.zeros_like(displacement)
        force = np.zeros_like(displacement)
        rotations = mean_rotations(self.scene, moved)
        for side, each in self._sides.items():
            angle = rotations.get(side, 0.0)
            turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            pull = each.under(self.applied)
            for component, values in zip(force, (*(turn @ pull[:2]), pull[2]), strict=True):
                np.add.at(component, each.node, values)
        return _without_torque(force, self.scene.assembly.positions + moved[:2].T, self.nodes)

    def correct(self, stress: np.ndarray) -> bool:
        """Add the error of the mean stress (3,) Pa inside to the tractions; returns whether there was an error."""
        lacking = self.asked - stress
        largest = np.abs(self.asked).max()
        if self.corrections_left == 0 or largest == 0.0 or np.abs(lacking).max() <= CLOSE * largest:
            return False
        self.corrections_left -= 1
        self.applied += lacking
        return True


def _is_wide(scene: DiskScene) -> bool:
    """Whether half the width and height of a body are inside the rim; otherwise the mean has too few particles."""
    width = [scene.assembly.size[axis] for axis, low in enumerate(("left", "bottom")) if low in scene.edges]
    return all(length >= 4.0 * RIM * scene.ground.brick.mean_diameter for length in width)


def _without_torque(force: np.ndarray, positions: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """Forces (3, n) without torque, by small additional forces on the loaded particles (k,); positions (n, 2) m."""
    arm = positions - positions[loaded].mean(axis=0)
    torque = np.sum(arm[:, 0] * force[1] - arm[:, 1] * force[0]) + np.sum(force[2])
    turn = np.stack([-arm[loaded, 1], arm[loaded, 0]])
    if (size := np.sum(turn**2)) > 0.0:  # a single disk has no arm
        force[:2, loaded] -= torque / size * turn
    return force
