"""The target stress of a static stage, applied by forces on the sides of the body."""

import numpy as np

from dembound.boundaries.sides import normal_axis
from dembound.disks.material.constants import limits_of
from dembound.disks.scene import DiskScene
from dembound.disks.side_forces import side_forces
from dembound.disks.stepping.balance import mean_rotations
from dembound.errors import CaseError
from dembound.kernels.contacts import UPDATED
from dembound.packings.cut import BEYOND


class Tractions:
    """Forces of a target stress on the sides of a body: those of the packing beyond, see `side_forces`.

    Under them an elastic body has the stress everywhere.

    Parameters
    ----------
    scene : the body.
    stress : (3,) xx, yy, xy in Pa, tension positive.

    Attributes
    ----------
    nodes : (k,) disks on which they act, ascending.

    Raises CaseError for sides without disks.
    """

    def __init__(self, scene: DiskScene, stress: tuple[float, float, float]) -> None:
        self.scene = scene
        self._follow = limits_of(scene.case.material).geometry == UPDATED
        self._sides = {side: (each.node, each.under(np.array(stress))) for side, each in side_forces(scene).items()}
        if empty := [side for side, (node, _) in self._sides.items() if len(node) == 0]:
            said = f"acts on no disk at {' and '.join(empty)}; let packing.size end at the body"
            raise CaseError([f"static.stress: {said}"])
        self.nodes = np.unique(np.concatenate([node for node, _ in self._sides.values()]))

    def forces(self, displacement: np.ndarray) -> np.ndarray:
        """Forces and moments (3, n) N and N·m at displacements (3, n).

        With the updated geometry the forces rotate with their side, and grow with its length. Small additional
        forces cancel the remaining resultant and torque of strained sides, or of sides that a hole reaches.
        """
        moved = displacement if self._follow else np.zeros_like(displacement)
        force = np.zeros_like(displacement)
        rotations, stretch = mean_rotations(self.scene, moved), self._stretch(moved)
        for side, (node, pull) in self._sides.items():
            angle, longer = rotations.get(side, 0.0), stretch[1 - normal_axis(side)]
            turn = longer * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
            force[:, node] += np.concatenate([turn @ pull[:2], longer * pull[2:]])
        return _balanced(force, self.scene.assembly.positions + moved[:2].T, self.nodes)

    def _stretch(self, moved: np.ndarray) -> list[float]:
        """Width and height at displacements (3, n) over those as built, from the distances of opposite sides."""
        edges, places = self.scene.edges, self.scene.assembly.positions
        stretch = [1.0, 1.0]
        for axis, (low, high) in enumerate(BEYOND):
            if low in edges:
                apart = places[edges[high].nodes].mean(axis=0) - places[edges[low].nodes].mean(axis=0)
                more = moved[:2, edges[high].nodes].mean(axis=1) - moved[:2, edges[low].nodes].mean(axis=1)
                stretch[axis] = float(np.hypot(*(apart + more)) / np.hypot(*apart))
        return stretch


def _balanced(force: np.ndarray, positions: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """Forces (3, n) without resultant and torque, by small additional forces on the loaded particles (k,).

    positions : (n, 2) m.
    """
    force[:2, loaded] -= force[:2].sum(axis=1, keepdims=True) / len(loaded)
    arm = positions - positions[loaded].mean(axis=0)
    torque = np.sum(arm[:, 0] * force[1] - arm[:, 1] * force[0]) + np.sum(force[2])
    turn = np.stack([-arm[loaded, 1], arm[loaded, 0]])
    if (size := np.sum(turn**2)) > 0.0:  # a single disk has no arm
        force[:2, loaded] -= torque / size * turn
    return force
