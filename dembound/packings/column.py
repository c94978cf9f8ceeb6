"""The free-field column of a body: one brick wide and periodic sideways, so that it represents the ground.

Under waves that arrive vertically, all bricks of the infinite tiling at the same height have the same motion. A column
one brick wide and periodic sideways has this motion too. The force of the ground beyond a side of the body in that
motion is the force on the column's own particles across the same seam (Z eq. 21).
"""

from dataclasses import dataclass, replace

import numpy as np

from dembound.errors import PackingError
from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly, tile

APART = 2.0
"""Gap between column and body in mean diameters; it is only used in pictures."""


@dataclass(frozen=True, eq=False)
class Seam:
    """The contacts of the column across the sides of the body; particles are those of the joint assembly.

    Attributes
    ----------
    count : number of the column's particles, which come first in the assembly.
    width : m, of the column, its period.
    twin : (n,) int64, the column's particle at the same place of the brick; particles of the column are their own
        twins.
    node : (k,) int64, particles of the body that have contacts beyond a side, sorted.
    start : (k + 1,) uint32: the contacts of node[s] are start[s]:start[s + 1] of the next three.
    neighbour : (e,) int64, the column's particle in the place of the neighbour.
    contact_type : (e,) int64, the contact of the brick.
    twin_is_second : (e,) bool, whether the node's twin is the contact's second disk.
    image : (e,) int64, periods of the column from the twin to that neighbour.
    """

    count: int
    width: float
    twin: np.ndarray
    node: np.ndarray
    start: np.ndarray
    neighbour: np.ndarray
    contact_type: np.ndarray
    twin_is_second: np.ndarray
    image: np.ndarray

    @property
    def contact_counts(self) -> np.ndarray:
        """Number (k,) of each node's contacts."""
        return self.start[1:].astype(np.int64) - self.start[:-1].astype(np.int64)

    def pairs(self, brick: Brick) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """First and second particle (e,) of the column and vectors (e, 2) m of the nodes' contacts."""
        owner = np.repeat(self.twin[self.node], self.contact_counts)
        vectors = brick.vectors[self.contact_type % len(brick.pairs)]
        return owner, self.neighbour, vectors * np.where(self.twin_is_second, -1.0, 1.0)[:, None]


def with_column(brick: Brick, body: Assembly, sides: tuple[str, ...]) -> tuple[Assembly, Seam]:
    """A body and its free-field column in one assembly, the column first and to the left, and the seam between them.

    sides : left, right or both, the sides at which the column represents the ground.

    Raises PackingError when a disk of the body has no twin in the column.
    """
    column = tile(brick, (1, body.copies[1]), (True, False))
    place = column.tile.astype(np.int64)
    numbers = np.full((place[:, 1].max() + 1, len(brick.radii)), -1, dtype=np.int64)
    numbers[place[:, 1], column.brick_particle] = np.arange(len(place))
    where = body.tile.astype(np.int64)
    twin = numbers[where[:, 1], body.brick_particle]
    if (twin < 0).any():
        raise PackingError(f"{np.count_nonzero(twin < 0)} disks of the body have no twin in the free-field column")
    count = len(column.radii)
    width = float(brick.size[0])
    seam = _seam(brick, body, where, numbers, sides)
    joint = replace(
        body,
        positions=np.vstack([column.positions - [width + APART * brick.mean_diameter, 0.0], body.positions]),
        radii=np.concatenate([column.radii, body.radii]),
        brick_particle=np.concatenate([column.brick_particle, body.brick_particle]),
        tile=np.vstack([column.tile, body.tile]),
        pairs=np.vstack([column.pairs, body.pairs + np.int32(count)]),
        contact_type=np.concatenate([column.contact_type, body.contact_type]),
        loose=column.loose + body.loose,
    )
    node, start = np.unique(seam["node"], return_index=True)
    return joint, Seam(
        count=count,
        width=width,
        twin=np.concatenate([np.arange(count), twin]),
        node=node + count,
        start=np.append(start, len(seam["node"])).astype(np.uint32),
        neighbour=seam["neighbour"],
        contact_type=seam["contact_type"],
        twin_is_second=seam["twin_is_second"],
        image=seam["image"],
    )


def _seam(
    brick: Brick, body: Assembly, where: np.ndarray, numbers: np.ndarray, sides: tuple[str, ...]
) -> dict[str, np.ndarray]:
    """Contacts of the body's disks with neighbours beyond its sides, sorted by disk, then contact, (e,) each.

    where (n, 2) are the body's tiles; numbers (tile y, disk) the column's particles, −1 where there is none.
    """
    edge = np.flatnonzero((where[:, 0] == 0) | (where[:, 0] >= body.copies[0] - 1))
    contact, second, owner = _incident(brick)
    first_of, last_of = (np.searchsorted(owner, body.brick_particle[edge], way) for way in ("left", "right"))
    many = last_of - first_of
    node = np.repeat(edge, many)
    entry = np.repeat(first_of, many) + np.arange(many.sum()) - np.repeat(np.cumsum(many) - many, many)
    contact_type, second = contact[entry], second[entry]
    other = np.where(second, brick.pairs[contact_type, 0], brick.pairs[contact_type, 1])
    image = np.where(second[:, None], -brick.images[contact_type], brick.images[contact_type])
    tile_there = where[node] + image
    height = tile_there[:, 1]
    standing = (height >= 0) & (height < len(numbers))
    near = np.where(standing, numbers[np.where(standing, height, 0), other], -1)
    out = {"left": tile_there[:, 0] < 0, "right": tile_there[:, 0] >= body.copies[0]}
    absent = ~np.isin(_key(tile_there, other, brick), _key(where, body.brick_particle, brick))
    beyond = (near >= 0) & absent & np.logical_or.reduce([out[side] for side in sides])
    columns = {
        "node": node,
        "neighbour": near,
        "contact_type": contact_type,
        "twin_is_second": second,
        "image": image[:, 0],
    }
    return {name: values[beyond] for name, values in columns.items()}


def _incident(brick: Brick) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ends of the brick's contacts sorted by disk: contact (2b,), whether it is the second end (2b,), disk (2b,)."""
    count = len(brick.pairs)
    contact = np.tile(np.arange(count), 2)
    second = np.repeat([False, True], count)
    owner = brick.pairs.T.ravel()
    order = np.lexsort((second, contact, owner))
    return contact[order], second[order], owner[order]


def _key(where: np.ndarray, particle: np.ndarray, brick: Brick) -> np.ndarray:
    """One number for each disk of each tile; tiles (k, 2) from −1 on."""
    tall = 2**31
    return ((where[:, 0] + 1) * tall + where[:, 1] + 1) * len(brick.radii) + particle
