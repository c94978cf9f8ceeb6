"""The free-field column of a body: one brick wide and periodic sideways, so that it represents the ground.

Under waves that arrive vertically, all bricks of the infinite tiling at the same height have the same motion. A column
one brick wide and periodic sideways has this motion too. The force of the ground beyond a side of the body in that
motion is the force on the column's own particles across the same seam (Z eq. 21).
"""

from dataclasses import dataclass, replace

import numpy as np

from dembound.errors import PackingError
from dembound.packings.brick import Brick
from dembound.packings.cut import cut_contacts
from dembound.packings.tiling import Assembly, Column, tile
from dembound.places import nearest

TYPED = 1e-9
"""Part of a height by which places may be beyond its ends."""

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


def with_column(
    brick: Brick,
    body: Assembly,
    sides: tuple[str, ...],
    rows: tuple[int, int] | None = None,
    beside: tuple[float, float] | None = None,
) -> tuple[Assembly, Seam]:
    """A body and its free-field column in one assembly, the column first and to the left, and the seam between them.

    sides : at which the column represents the ground.
    rows : first row of bricks of the body in the column, and the number of rows of the column; None: it is as high as
    the body. beside : lower left corner (m) of the region it stands beside, by default of the body.

    Raises PackingError when a disk of the body has no twin in the column.
    """
    first, height = (0, body.copies[1]) if rows is None else rows
    column = tile(brick, (1, height), (True, False))
    place = column.tile.astype(np.int64)
    numbers = np.full((place[:, 1].max() + 1, len(brick.radii)), -1, dtype=np.int64)
    numbers[place[:, 1], column.brick_particle] = np.arange(len(place))
    where = body.tile.astype(np.int64)
    level = first + where[:, 1]
    there = (level >= 0) & (level < len(numbers))
    twin = np.where(there, numbers[np.where(there, level, 0), body.brick_particle], -1)
    if (twin < 0).any():
        raise PackingError(f"{np.count_nonzero(twin < 0)} disks of the body have no twin in the free-field column")
    count = len(column.radii)
    width = float(brick.size[0])
    left, bottom = body.origin.tolist() if beside is None else beside
    corner = np.array([left - width - APART * brick.mean_diameter, bottom])
    seam = _seam(brick, body, first, numbers, sides)
    joint = replace(
        body,
        positions=np.vstack([column.positions + corner, body.positions]),
        radii=np.concatenate([column.radii, body.radii]),
        brick_particle=np.concatenate([column.brick_particle, body.brick_particle]),
        tile=np.vstack([column.tile, body.tile]),
        pairs=np.vstack([column.pairs, body.pairs + np.int32(count)]),
        contact_type=np.concatenate([column.contact_type, body.contact_type]),
        column=Column(count, column.copies, column.size, column.extent, corner),
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
    brick: Brick, body: Assembly, first: int, numbers: np.ndarray, sides: tuple[str, ...]
) -> dict[str, np.ndarray]:
    """Contacts of the body's disks with neighbours beyond its sides, sorted by disk, then contact, (e,) each.

    first : row of bricks of the column at the body's lowest one. numbers (tile y, disk) are the column's particles, −1
    where there is none: contacts with the ground below the column are not among them.
    """
    cut = cut_contacts(brick, body, sides)
    height = first + cut.tile[:, 1]
    standing = (height >= 0) & (height < len(numbers))
    near = np.where(standing, numbers[np.where(standing, height, 0), cut.other], -1)
    columns = {
        "node": cut.node,
        "neighbour": near,
        "contact_type": cut.contact_type,
        "twin_is_second": cut.is_second,
        "image": cut.image[:, 0],
    }
    return {name: values[near >= 0] for name, values in columns.items()}


def nearest_in_column(joint: Assembly, places: np.ndarray) -> np.ndarray:
    """The disk (k,) of a column nearest to places (k, 2) m of the ground, modulo the column's width.

    joint : a body with its column. −1 for places below the column's bottom, or above its top.
    """
    column = joint.column
    assert column is not None
    width, height = column.size
    disks = joint.positions[: column.disks] - column.origin
    images = np.concatenate([disks + np.array([shift, 0.0]) for shift in (-width, 0.0, width)])
    local = places - [joint.origin[0], column.origin[1]]
    found = nearest(images, np.column_stack([local[:, 0] % width, local[:, 1]]))
    over = 0.5 * (column.extent[1] - height) + TYPED * height
    return np.where((local[:, 1] >= -over) & (local[:, 1] <= height + over), found % column.disks, -1)
