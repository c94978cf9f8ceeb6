"""The contacts of the elastic law for its kernel: a row per particle, with a table of constants of the brick."""

from collections.abc import Callable

import numpy as np

from dembound.disks.material.packed_material import PackedMaterial
from dembound.kernels.tables import NeighbourTable
from dembound.laws import Stiffness
from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly

Springs = Callable[[tuple[int, int]], Stiffness]
"""Constants of the brick's contacts between two zones, see `PackedMaterial.stiffness_of`."""


def contact_rows(
    assembly: Assembly, ground: PackedMaterial, begin: int = 0, springs: Springs | None = None
) -> NeighbourTable:
    """Sort the contacts into one row per particle, with a table of the constants of the brick's contacts.

    begin : number of the assembly's first particle in the scene. springs : in place of those of the ground.

    The rows of the table are in the order in which the particles use them, so that a loop over particles reads the
    table in order as well, and it stays in the cache of the core.
    """
    constants, row_of = elastic_constants(ground, springs)
    i, j = assembly.pairs.T
    owner = np.concatenate([i, j])
    neighbour = np.concatenate([j, i])
    contact_type = row_of[np.concatenate([2 * assembly.contact_type, 2 * assembly.contact_type + 1])]
    order = np.lexsort((neighbour, owner))
    start = np.zeros(begin + len(assembly.radii) + 1, dtype=np.uint32)
    np.cumsum(np.bincount(owner, minlength=len(assembly.radii)), out=start[begin + 1 :])
    return NeighbourTable(
        begin, start, (begin + neighbour[order]).astype(np.uint32), contact_type[order].astype(np.uint32), constants
    )


def elastic_constants(ground: PackedMaterial, springs: Springs | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Constants (4b, 6), and the row in them of contact k for its first (2k) and second disk (2k + 1).

    Contacts from number b on are those of the brick with half their stiffness, for sides of half cells; those of other
    pairings of zones follow in a layered ground.
    """
    found, rows, springs = [], [], springs or ground.stiffness_of
    for number, pairing in enumerate(ground.pairings):
        constants, row_of = _constants_of(ground.brick, springs(pairing))
        found.append(constants)
        rows.append(row_of + number * len(row_of))
    return np.vstack(found), np.concatenate(rows)


def _constants_of(brick: Brick, law: Stiffness) -> tuple[np.ndarray, np.ndarray]:
    """Constants and rows, as of `elastic_constants`, of the brick's contacts with these stiffnesses."""
    vectors = brick.vectors
    n = vectors / np.hypot(*vectors.T)[:, None]
    root_n, root_s = np.sqrt(law.normal), np.sqrt(law.shear)
    ratio = np.divide(root_s, root_n, out=np.zeros_like(root_n), where=root_n > 0.0)  # a gap without bond has neither
    common = [root_n * n[:, 0], root_n * n[:, 1], ratio]
    directed = np.empty((len(vectors), 2, 6))
    directed[:, 0] = np.stack([*common, root_s * law.arm_i, root_s * law.arm_j, law.bending], axis=1)
    directed[:, 1] = np.stack([*common, -root_s * law.arm_j, -root_s * law.arm_i, law.bending], axis=1)
    flat = directed.reshape(-1, 6)
    order = np.lexsort((brick.pairs[:, ::-1].ravel(), brick.pairs.ravel()))
    row_of = np.empty(len(order), dtype=np.int64)
    row_of[order] = np.arange(len(order))
    half = flat[order] * [np.sqrt(0.5), np.sqrt(0.5), 1.0, np.sqrt(0.5), np.sqrt(0.5), 0.5]
    return np.vstack([flat[order], half]), np.concatenate([row_of, row_of + len(order)])
