"""Relaxation arms of bonds, by which ground that can break is damped.

Memories of the forces on disks (damped_ground.py) would outlive a bond: a disk that is cut off would be driven by the
forces of the past. The arms of a bond break with it. Both are the same filter of the same forces, so that until a
contact opens or slides ground moves as under the elastic law with the same quality factor.
"""

import numpy as np

from dembound.damping import factors_of
from dembound.disks.body import DiskBody
from dembound.disks.contacts.contact_list import ContactList
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.stepping.damped_ground import shares_of_others
from dembound.kernels.common import CHUNKS
from dembound.kernels.contacts import LOST
from dembound.kernels.tables.laws import Arms


def arms_per_bond(scene: DiskBody) -> int:
    """Number K of relaxation arms of a bond, 0 without any."""
    counts = [each.count for each in scene.ground.mechanisms_by_layer if each is not None and scene.ground.relaxes]
    return max(counts, default=0)


def arms_of(scene: DiskBody, contacts: ContactList, time_step: float) -> Arms:
    """The arms of the bonds of a part, for steps of this length (s).

    Between layers of unlike damping a bond is two halves in series, for which weights and the logarithms of relaxation
    times are weighted by their compliance.
    """
    decay, weight = _by_layer(scene.ground, time_step)
    if len(set(scene.ground.mechanisms_by_layer)) == 1:
        return Arms(decay[:1], weight[:1], np.zeros((CHUNKS, LOST)))
    shape = contacts.own_types, decay.shape[1]
    found = Arms(np.ones(shape), np.zeros(shape), np.zeros((CHUNKS, LOST)))
    kind, at = np.unique(contacts.kind, return_index=True)
    first, second = contacts.assembly.positions[contacts.assembly.pairs[at]].swapaxes(0, 1)
    other = shares_of_others(scene.ground, first, second)
    one, two = (
        (share[:, None] * weight[layer], np.log(decay[layer]))
        for share, layer in ((1.0 - other, scene.ground.layer_of(first)), (other, scene.ground.layer_of(second)))
    )
    both = one[0] + two[0]
    rate = np.where(both > 0.0, (one[0] * one[1] + two[0] * two[1]) / np.where(both > 0.0, both, 1.0), 0.0)
    found.weight[kind], found.decay[kind] = both, np.exp(rate)
    return found


def of_all_types(arms: Arms, count: int) -> Arms:
    """Arms with rows for so many types of contacts, of which those that were not built have no bonds.

    Kernels also read the rows of pairs without bonds.
    """
    built = len(arms.decay)
    if built == 1 or built >= count:
        return arms
    more = (0, count - built), (0, 0)
    return arms._replace(decay=np.pad(arms.decay, more, constant_values=1.0), weight=np.pad(arms.weight, more))


def _by_layer(ground: PackedMaterial, time_step: float) -> tuple[np.ndarray, np.ndarray]:
    """e, and w/(1 − Σw), of the arms of each layer (layers, K); of undamped ones 1 and 0."""
    layers = ground.mechanisms_by_layer
    factors = factors_of(layers, time_step)
    decay, gain = factors[:, 0], factors[:, 1]
    damped = gain > 0.0
    weight = np.where(damped, 2.0 * gain / np.where(damped, 1.0 - decay, 1.0), 0.0)  # g = ½w(1 − e)
    relaxed = np.array([1.0 if each is None else each.relaxed for each in layers])
    return np.where(damped, decay, 1.0), weight / relaxed[:, None]
