"""The types of the contacts of a body that differ from its brick's: in half cells along sides, and across layers."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dembound.boundaries.half_mass import half_contacts
from dembound.boundaries.support import Edge
from dembound.casefile.disks import DiskCase
from dembound.disks.material.packed_material import PackedMaterial
from dembound.packings.brick import Brick
from dembound.packings.column import Seam
from dembound.packings.tiling import Assembly


def with_half_contacts(
    case: DiskCase, brick: Brick, assembly: Assembly, seam: Seam | None, edges: Mapping[str, Edge]
) -> tuple[Assembly, Seam | None]:
    """Replace contacts along sides of half cells, also across a seam, by types with half the stiffness."""
    vectors, whole = brick.vectors, len(brick.pairs)

    def halved(contact_type: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        plain = contact_type % whole
        half = half_contacts(first, second, vectors[plain], edges, case.boundary)
        return plain + whole * half.astype(contact_type.dtype)

    assembly = replace(assembly, contact_type=halved(assembly.contact_type, *assembly.pairs.T))
    if seam is not None:
        owner = np.repeat(seam.twin[seam.node], seam.contact_counts)
        seam = replace(seam, contact_type=halved(seam.contact_type, owner, seam.neighbour))
    return assembly, seam


def with_layers(ground: PackedMaterial, assembly: Assembly, seam: Seam | None) -> tuple[Assembly, Seam | None]:
    """Replace the contacts of a layered ground, also across a seam, by types with the springs of their zones."""
    if not ground.is_layered:
        return assembly, seam
    up, types = assembly.positions[:, 1], 2 * len(ground.brick.pairs)
    pairing = ground.pairing_of(*up[assembly.pairs].T)
    assembly = replace(assembly, contact_type=(assembly.contact_type + types * pairing).astype(np.int32))
    if seam is not None:
        owner = up[np.repeat(seam.twin[seam.node], seam.contact_counts)]
        other = up[seam.neighbour]
        pairing = ground.pairing_of(*np.where(seam.twin_is_second, [other, owner], [owner, other]))
        seam = replace(seam, contact_type=seam.contact_type + types * pairing)
    return assembly, seam
