"""The memories of forces of a scene whose ground is damped."""

import numpy as np

from dembound.damping.quality import Mechanisms
from dembound.disks.body import DiskBody
from dembound.disks.contacts.layout import Rows
from dembound.disks.stepping.memories import DampedTies, DiskMemories, factors_of


def layers_of(scene: DiskBody, nodes: np.ndarray) -> tuple[list[Mechanisms | None], np.ndarray]:
    """The mechanisms of every layer of the ground, None for undamped ones, and the layer (k,) of some nodes (k,)."""
    return [scene.ground.mechanisms], np.zeros(len(nodes), dtype=np.uint8)


def unrelaxed(scene: DiskBody) -> np.ndarray:
    """Unrelaxed stiffness of the ground of every disk (n,) over that of the given wave speeds."""
    layers, layer = layers_of(scene, np.arange(scene.disk_count))
    return np.array([1.0 if each is None else each.unrelaxed for each in layers])[layer]


def disk_memories(
    scene: DiskBody, nodes: slice, rows: Rows, supported: np.ndarray, time_step: float
) -> DiskMemories | None:
    """Memories of the disks of a part, for steps of this length (s); None in undamped ground.

    supported : (k,) slots of all supported nodes.
    """
    layers, layer = layers_of(scene, np.arange(nodes.start, nodes.stop))
    if not any(layers):
        return None
    return DiskMemories(factors_of(layers, time_step), layer, rows, nodes, scene.layout, supported)


def ties_remembering(scene: DiskBody, tied: np.ndarray, time_step: float) -> DampedTies | None:
    """Memories of the forces of ties on nodes (t,), some of them several times; None without ties or damping."""
    nodes = np.unique(tied)
    layers, layer = layers_of(scene, nodes)
    if len(nodes) == 0 or not any(layers):
        return None
    return DampedTies(nodes, factors_of(layers, time_step)[layer])
