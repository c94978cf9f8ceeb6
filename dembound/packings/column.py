"""The free-field columns of a body: one brick wide and periodic sideways, so that each represents the ground.

Under waves that arrive vertically, all bricks of the infinite tiling at the same height have the same motion. A column
one brick wide and periodic sideways has this motion too. The force of the ground beyond a side of the body in that
motion is the force on the column's own particles across the same seam (Z eq. 21). Where the ground left and right
differs each side has a column of its own.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

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
    """The contacts of a column across sides of the body; particles are those of the joint assembly.

    Attributes
    ----------
    disks : the range of the column's particles in the assembly.
    sides, top : at which the column represents the ground, and where it ends, see `Standing`.
    width : m, of the column, its period.
    twin : (n,) int64, the column's particle at the same place of the brick; of particles without one, and of those of
        columns, themselves.
    node : (k,) int64, particles of the body that have contacts beyond a side, sorted.
    start : (k + 1,) uint32: the contacts of node[s] are start[s]:start[s + 1] of the next three.
    neighbour : (e,) int64, the column's particle in the place of the neighbour.
    contact_type : (e,) int64, the contact of the brick.
    twin_is_second : (e,) bool, whether the node's twin is the contact's second disk.
    image : (e,) int64, periods of the column from the twin to that neighbour.
    """

    disks: slice
    sides: tuple[str, ...]
    top: float | None
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


def columns_end(seams: Sequence[Seam]) -> int:
    """Number of the particles of columns, which come first."""
    return seams[-1].disks.stop if seams else 0


class Standing(NamedTuple):
    """A column to be built.

    sides : at which it represents the ground. top : height y (m) above which it has no disks; None: it is whole.
    """

    sides: tuple[str, ...]
    top: float | None = None

    def tiled(self, brick: Brick, height: int, origin: tuple[float, float], bottom: float | None = None) -> Assembly:
        """The column of `height` bricks by itself, its lower left corner at an origin, m.

        bottom : height y (m) at which it will stand; None: that of the origin.
        """
        column = tile(brick, (1, height), (True, False), origin)
        if self.top is None:
            return column
        above = 0.0 if bottom is None else bottom - origin[1]
        return column.without(column.positions[:, 1] + above > self.top)[0]


def with_columns(
    brick: Brick,
    body: Assembly,
    standing: Sequence[Standing],
    rows: tuple[int, int] | None = None,
    beside: tuple[float, float, float] | None = None,
) -> tuple[Assembly, tuple[Seam, ...]]:
    """A body and its free-field columns in one assembly, the columns first, and the seams between them and the body.

    A whole column has a twin of every disk of the body, another one of those with contacts beyond its sides.

    standing : the columns; the first stands left of the body, another one right of it.
    rows : first row of bricks of the body in the columns, and the number of rows of a column; None: it is as high as
    the body. beside : left, bottom and right end (m) of the region they stand beside, by default of the body.

    Raises PackingError when a disk has no twin.
    """
    first, height = (0, body.copies[1]) if rows is None else rows
    width, gap = float(brick.size[0]), APART * brick.mean_diameter
    own = *body.origin.tolist(), float(body.origin[0] + body.extent[0])
    left, bottom, right = own if beside is None else beside
    places = left - width - gap, right + gap
    built = [each.tiled(brick, height, (0.0, 0.0), bottom) for each in standing]
    count = sum(len(each.radii) for each in built)
    columns, seams, begin = [], [], 0
    for each, column, x in zip(standing, built, places, strict=False):
        disks, corner = slice(begin, begin + len(column.radii)), np.array([x, bottom])
        columns.append(Column(disks, column.copies, column.size, column.extent, corner))
        seams.append(_seam_of(brick, body, each, column, first, disks, count))
        begin = disks.stop
    parts, begins = [*built, body], [*(of.disks.start for of in columns), count]
    shifted = [own.positions + of.origin for own, of in zip(built, columns, strict=True)]
    joint = replace(
        body,
        positions=np.vstack([*shifted, body.positions]),
        radii=np.concatenate([each.radii for each in parts]),
        brick_particle=np.concatenate([each.brick_particle for each in parts]),
        tile=np.vstack([each.tile for each in parts]),
        pairs=np.vstack([each.pairs + np.int32(first) for each, first in zip(parts, begins, strict=True)]),
        contact_type=np.concatenate([each.contact_type for each in parts]),
        columns=tuple(columns),
        loose=sum(each.loose for each in parts),
    )
    return joint, tuple(seams)


def _seam_of(
    brick: Brick, body: Assembly, standing: Standing, column: Assembly, first: int, disks: slice, count: int
) -> Seam:
    """The seam between a body and a column, the disks of which have these numbers.

    first : row of bricks of the column at the body's lowest one. count : number of disks of all columns.
    """
    place = column.tile.astype(np.int64)
    numbers = np.full((place[:, 1].max() + 1, len(brick.radii)), -1, dtype=np.int64)
    numbers[place[:, 1], column.brick_particle] = np.arange(disks.start, disks.stop)
    twin = _at(numbers, first + body.tile[:, 1].astype(np.int64), body.brick_particle)
    contacts = _contacts(brick, body, first, numbers, standing.sides)
    needed = np.arange(len(twin)) if standing.top is None else np.unique(contacts["node"])
    if lost := np.count_nonzero(twin[needed] < 0):
        raise PackingError(f"{lost} disks of the body have no twin in the free-field column")
    node, start = np.unique(contacts["node"], return_index=True)
    own = np.arange(count + len(twin))
    return Seam(
        disks=disks,
        sides=standing.sides,
        top=standing.top,
        width=float(brick.size[0]),
        twin=np.concatenate([own[:count], np.where(twin < 0, own[count:], twin)]),
        node=node + count,
        start=np.append(start, len(contacts["node"])).astype(np.uint32),
        neighbour=contacts["neighbour"],
        contact_type=contacts["contact_type"],
        twin_is_second=contacts["twin_is_second"],
        image=contacts["image"],
    )


def _at(numbers: np.ndarray, level: np.ndarray, particle: np.ndarray) -> np.ndarray:
    """Disks (k,) of a column with numbers (rows, disks of the brick), at rows and places in the brick; −1 for none."""
    there = (level >= 0) & (level < len(numbers))
    return np.where(there, numbers[np.where(there, level, 0), particle], -1)


def _contacts(
    brick: Brick, body: Assembly, first: int, numbers: np.ndarray, sides: tuple[str, ...]
) -> dict[str, np.ndarray]:
    """Contacts of the body's disks with neighbours beyond its sides, sorted by disk, then contact, (e,) each.

    first : row of bricks of the column at the body's lowest one. numbers (tile y, disk) are the column's particles, −1
    where there is none: contacts with the ground below the column are not among them.
    """
    cut = cut_contacts(brick, body, sides)
    near = _at(numbers, first + cut.tile[:, 1], cut.other)
    columns = {
        "node": cut.node,
        "neighbour": near,
        "contact_type": cut.contact_type,
        "twin_is_second": cut.is_second,
        "image": cut.image[:, 0],
    }
    return {name: values[near >= 0] for name, values in columns.items()}


def nearest_in_column(joint: Assembly, places: np.ndarray, number: int = 0) -> np.ndarray:
    """The disk (k,) of a column, by its number, nearest to places (k, 2) m of the ground, modulo the column's width.

    joint : a body with its columns. −1 for places below the column's bottom, or above its top.
    """
    column = joint.columns[number]
    width, height = column.size
    own = joint.positions[column.disks]
    images = np.concatenate([own - column.origin + np.array([shift, 0.0]) for shift in (-width, 0.0, width)])
    local = places - [joint.origin[0], column.origin[1]]
    found = nearest(images, np.column_stack([local[:, 0] % width, local[:, 1]]))
    over = 0.5 * (column.extent[1] - height) + TYPED * height
    there = (local[:, 1] >= -over) & (local[:, 1] <= height + over)
    return np.where(there, column.disks.start + found % len(own), -1)
