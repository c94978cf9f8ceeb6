"""Copies of a brick, side by side, as one body."""

from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from dembound.errors import PackingError
from dembound.packings.brick import Brick


class Column(NamedTuple):
    """A column of bricks beside a body: the range of its disks, and attributes with the names of an assembly's."""

    disks: slice
    copies: tuple[int, int]
    size: np.ndarray
    extent: np.ndarray
    origin: np.ndarray


@dataclass(frozen=True, eq=False)
class Assembly:
    """The disks and contacts of a whole scene; the constants of contacts are stored once, in the brick.

    Attributes
    ----------
    positions : (n, 2) m.
    radii : (n,) m.
    brick_particle : (n,) int32, the disk of the brick that this one is a copy of (its twin).
    tile : (n, 2) int32, number of its copy of the brick along x and y; one more in a row that closes the frame.
    pairs : (b, 2) int32, contacts i → j, sorted by i, then by contact_type.
    contact_type : (b,) int32, the contact of the brick that this one is a copy of: its vector points from i to j.
    copies : number of bricks along x and y.
    size : (2,) m, the scene: copies · brick size.
    extent : (2,) m, the body: as `size`, plus the row that closes the frame if there is one. origin : (2,) m, the lower
    left corner of its first brick. columns : of bricks beside the body, whose disks come first, see column.py. loose :
    number of disks left out because the cut at an open edge, or a hole, removed all their connections to the body.
    """

    positions: np.ndarray
    radii: np.ndarray
    brick_particle: np.ndarray
    tile: np.ndarray
    pairs: np.ndarray
    contact_type: np.ndarray
    copies: tuple[int, int]
    size: np.ndarray
    extent: np.ndarray
    origin: np.ndarray = field(default_factory=lambda: np.zeros(2))
    columns: "tuple[Column, ...]" = ()
    loose: int = 0

    def part(self, disks: slice) -> "Assembly":
        """A range of the disks as a separate assembly, without contacts to other disks; itself for all disks."""
        if disks == slice(0, len(self.radii)):
            return self
        chosen = (self.pairs[:, 0] >= disks.start) & (self.pairs[:, 0] < disks.stop)
        of = next((each for each in self.columns if disks.stop <= each.disks.stop), self)
        return replace(
            self,
            copies=of.copies,
            size=of.size,
            extent=of.extent,
            origin=of.origin,
            columns=(),
            positions=self.positions[disks],
            radii=self.radii[disks],
            brick_particle=self.brick_particle[disks],
            tile=self.tile[disks],
            pairs=self.pairs[chosen] - np.int32(disks.start),
            contact_type=self.contact_type[chosen],
            loose=0,
        )

    def without(self, removed: np.ndarray) -> tuple["Assembly", np.ndarray]:
        """The assembly without some disks, removed (n,) bool, and without disks that this separates from the body.

        Returns it and the indices (m,) of its disks, in order. Raises PackingError when no disk remains.
        """
        kept = _body(self, ~removed)
        if not kept.any():
            raise PackingError("no disk is left of the body")
        if kept.all():
            return self, np.arange(len(kept))
        loose = self.loose + int(np.count_nonzero(~removed & ~kept))
        return replace(self.only(kept), loose=loose), np.flatnonzero(kept)

    def only(self, kept: np.ndarray) -> "Assembly":
        """Some of its disks, kept (n,) bool, with the contacts between them."""
        number = np.cumsum(kept, dtype=np.int32) - 1
        contacts = kept[self.pairs].all(axis=1)
        return replace(
            self,
            positions=self.positions[kept],
            radii=self.radii[kept],
            brick_particle=self.brick_particle[kept],
            tile=self.tile[kept],
            pairs=number[self.pairs[contacts]],
            contact_type=self.contact_type[contacts],
        )


def tile(
    brick: Brick, copies: tuple[int, int], periodic: tuple[bool, bool], origin: tuple[float, float] = (0.0, 0.0)
) -> Assembly:
    """Put `copies` (along x, along y) of the brick side by side, the first one's lower left corner at origin (m).

    Along a periodic axis contacts wrap around: over one copy only, a disk may then touch its own image, and
    this self-contact (i, i) is listed too (displacement does not deform it, but rotation does). Along other axes
    contacts that would leave the scene are left out, and the regular rows of the brick, if it has any, are repeated on
    the far edge, so that they form a frame on all sides of the scene. Disks that such a cut separates from the body are
    left out.

    Disks are numbered tile after tile, tiles along the shorter side of the scene first, so that a long bar is
    numbered along its length; within a tile they keep the order of the brick.
    """
    size = brick.size * copies
    present = _present(brick.edge_rows, copies, periodic)
    # tiles in order of numbers: an axis swap makes the index along the shorter side the faster one
    swap = (0, 1, 2) if size[1] <= size[0] else (1, 0, 2)
    numbers = np.full(present.shape, -1, np.int32)
    ordered = numbers.transpose(swap)  # a view
    ordered[present.transpose(swap)] = np.arange(np.count_nonzero(present))
    slow, fast, twin = np.nonzero(present.transpose(swap))
    tiles = np.column_stack([slow, fast] if swap[0] == 0 else [fast, slow])
    pairs, contact_type = _contacts(brick, numbers, copies, periodic)
    whole = Assembly(
        positions=brick.positions[twin] + tiles * brick.size + origin,
        radii=brick.radii[twin],
        brick_particle=twin.astype(np.int32),
        tile=tiles.astype(np.int32),
        pairs=pairs,
        contact_type=contact_type,
        copies=copies,
        size=size,
        extent=size + _closing_width(brick, periodic),
        origin=np.array(origin),
    )
    return whole.without(np.zeros(len(twin), dtype=bool))[0]


def disks_around(brick: Brick, begin: np.ndarray, place: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
    """The disks of an endless tiling in the bricks round a place (m): their tiles (9, 2), places (9, m, 2) m.

    begin : (2,) m, lower left corner of tile (0, 0).
    """
    tile = np.floor((np.array(place) - begin) / brick.size)
    tiles = tile + np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)])
    return tiles, begin + brick.size * tiles[:, None] + brick.positions


def count_disks(brick: Brick, copies: tuple[int, int], periodic: tuple[bool, bool]) -> int:
    """Number of disks of `tile` with the same parameters, including disks without connection."""
    across, up = (
        count + (not wraps and bool(row.any()))
        for count, wraps, row in zip(copies, periodic, brick.edge_rows.T, strict=True)
    )
    closing = brick.edge_rows
    corner = int(np.count_nonzero(closing.all(axis=1)))
    right, top = (int(np.count_nonzero(row)) for row in closing.T)
    extra = (across - copies[0]) * copies[1] * right + (up - copies[1]) * copies[0] * top
    return copies[0] * copies[1] * len(brick.radii) + extra + (across - copies[0]) * (up - copies[1]) * corner


def _body(assembly: Assembly, present: np.ndarray) -> np.ndarray:
    """The largest connected body (n,) bool of the disks present (n,) bool; isolated groups transmit no waves."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    count = len(present)
    pairs = assembly.pairs[present[assembly.pairs].all(axis=1)]
    graph = coo_matrix((np.ones(len(pairs), np.int8), tuple(pairs.T)), shape=(count, count))
    _, body = connected_components(graph, directed=False)
    return present & (body == np.argmax(np.bincount(body, weights=present)))


def _closing_width(brick: Brick, periodic: tuple[bool, bool]) -> np.ndarray:
    """Width (2,) m that the repeated rows add along x and y: one disk, half of it beyond each outer line."""
    widths = [2.0 * float(brick.radii[row].max(initial=0.0)) for row in brick.edge_rows.T]
    return np.where(periodic, 0.0, widths)


def _present(edge_rows: np.ndarray, copies: tuple[int, int], periodic: tuple[bool, bool]) -> np.ndarray:
    """Mask (tile x, tile y, disk) of existing disks: all of the tiles, and the rows that close the frame."""
    extra = [not periodic[axis] and bool(edge_rows[:, axis].any()) for axis in range(2)]
    present = np.ones((copies[0] + extra[0], copies[1] + extra[1], len(edge_rows)), bool)
    present[copies[0] :] &= edge_rows[:, 0]
    present[:, copies[1] :] &= edge_rows[:, 1]
    return present


def _contacts(
    brick: Brick, numbers: np.ndarray, copies: tuple[int, int], periodic: tuple[bool, bool]
) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (b, 2) and contact types (b,) of all contacts whose two disks exist; numbers (tile x, tile y, disk)."""
    first, second = brick.pairs.T
    target = []
    inside = []
    for axis in range(2):
        tiles = numbers.shape[axis]
        there = np.arange(tiles)[:, None] + brick.images[:, axis]  # (tile, contact)
        inside.append(np.ones_like(there, bool) if periodic[axis] else (there >= 0) & (there < tiles))
        target.append(there % tiles)
    starts = numbers[:, :, first]
    ends = numbers[target[0][:, None, :], target[1][None, :, :], second]
    ends[~(inside[0][:, None, :] & inside[1][None, :, :])] = -1
    exists = (starts >= 0) & (ends >= 0)
    contact_type = np.nonzero(exists)[2].astype(np.int32)
    pairs = np.column_stack([starts[exists], ends[exists]])
    order = np.lexsort((contact_type, pairs[:, 0]))
    return pairs[order], contact_type[order]
