"""The contacts of the infinite tiling that the sides of a body or a hole cut."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Protocol

import numpy as np

from dembound.packings.brick import Brick
from dembound.packings.tiling import Assembly

BEYOND = (("left", "right"), ("bottom", "top"))
"""The sides at low and at high coordinates, along x and along y."""

NO_TOPS: Mapping[str, float] = MappingProxyType({})


class Hole(Protocol):
    """A removed region: a test of positions (k, 2) m in a scene of a size, m, and the rectangle around it, m."""

    def takes(self, positions: np.ndarray, span: float) -> np.ndarray:
        """Mask (k,) of positions (k, 2) m that lie in the hole."""

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Left, bottom, right and top, m."""


@dataclass(frozen=True, eq=False)
class CutContacts:
    """Contacts between disks of a body and disks beyond its sides, sorted by the body's disk, then by contact.

    Attributes
    ----------
    node : (e,) int64, disk of the body.
    contact_type : (e,) int64, the contact of the brick.
    is_second : (e,) bool, whether the body's disk is the contact's second one.
    other : (e,) int64, the disk of the brick of which the one beyond is a copy.
    tile : (e, 2) int64, in which copy of the brick it is, counted as in the body.
    image : (e, 2) int64, that copy less the one of the body's disk.
    side : (e,) int64, the side it lies beyond: 0 left, 1 right, 2 bottom, 3 top; of two the first; −1 in a hole.
    """

    node: np.ndarray
    contact_type: np.ndarray
    is_second: np.ndarray
    other: np.ndarray
    tile: np.ndarray
    image: np.ndarray
    side: np.ndarray

    def only(self, chosen: np.ndarray) -> CutContacts:
        """Some of the contacts, chosen (e,) bool."""
        return CutContacts(**{name: values[chosen] for name, values in vars(self).items()})

    def vectors(self, brick: Brick) -> np.ndarray:
        """Vectors (e, 2) m from the body's disk to the one beyond."""
        return brick.vectors[self.contact_type] * np.where(self.is_second, -1.0, 1.0)[:, None]


def cut_contacts(
    brick: Brick,
    body: Assembly,
    sides: Collection[str],
    periodic: tuple[bool, bool] = (False, False),
    tops: Mapping[str, float] = NO_TOPS,
) -> CutContacts:
    """The contacts of a body with disks beyond some sides; for a disk beyond two sides both must be among them.

    periodic : whether the body is periodic along x and along y, so that nothing is beyond its sides there. tops : by
    side, the height (m) above which no disks are beyond; absent: they are as high as the body.
    """
    where = body.tile.astype(np.int64)
    # images are ±1 at most where bricks are as wide as two disks, so only the outer tiles have contacts beyond
    reach = np.abs(brick.images).max(axis=0, initial=1)
    outer = ((where < reach) | (where >= np.array(body.copies) - reach)).any(axis=1)
    found = _ends_at(brick, body, np.flatnonzero(outer), periodic)
    out = _beyond(found.tile, brick.edge_rows[found.other], body.copies)
    found = replace(found, side=np.argmax(out, axis=1))
    allowed = np.array([side in sides for axis in BEYOND for side in axis])
    there = np.array([tops.get(side, np.inf) for axis in BEYOND for side in axis])[found.side] > _heights(
        found, brick, body
    )
    return found.only(there & out.any(axis=1) & ~(out & ~allowed).any(axis=1))  # a body has no disks beyond its sides


def contacts_into(brick: Brick, body: Assembly, hole: Hole) -> CutContacts:
    """The contacts of a body with disks that a hole has removed; their side is −1."""
    x0, y0, x1, y1 = hole.box
    reach = np.abs(brick.vectors).max(axis=0)
    near = ((body.positions >= np.array([x0, y0]) - reach) & (body.positions <= np.array([x1, y1]) + reach)).all(axis=1)
    found = _ends_at(brick, body, np.flatnonzero(near))
    found = found.only(hole.takes(body.positions[found.node] + found.vectors(brick), float(body.size.max())))
    never_there = _beyond(found.tile, brick.edge_rows[found.other], body.copies).any(axis=1)
    return found.only(_is_absent(found, brick, body, near) & ~never_there)


def _ends_at(
    brick: Brick, body: Assembly, disks: np.ndarray, periodic: tuple[bool, bool] = (False, False)
) -> CutContacts:
    """All contacts of some disks (k,) of a body, cut or not; periodic : where numbers of copies wrap around."""
    contact, second, owner = _ends(brick)
    first_of, last_of = (np.searchsorted(owner, body.brick_particle[disks], way) for way in ("left", "right"))
    many = last_of - first_of
    entry = np.repeat(first_of, many) + np.arange(many.sum()) - np.repeat(np.cumsum(many) - many, many)
    node, contact_type, is_second = np.repeat(disks, many), contact[entry], second[entry]
    other = np.where(is_second, brick.pairs[contact_type, 0], brick.pairs[contact_type, 1])
    image = np.where(is_second[:, None], -brick.images[contact_type], brick.images[contact_type])
    place = body.tile[node].astype(np.int64) + image
    place = np.where(periodic, place % body.copies, place)
    return CutContacts(node, contact_type, is_second, other, place, image, np.full(len(node), -1))


def _is_absent(found: CutContacts, brick: Brick, body: Assembly, near: np.ndarray) -> np.ndarray:
    """Mask (e,) of contacts whose other disk is not in the body; near : (n,) bool, its disks that may be the other."""
    where = body.tile[near].astype(np.int64)
    return ~np.isin(_key(found.tile, found.other, brick), _key(where, body.brick_particle[near], brick))


def _heights(found: CutContacts, brick: Brick, body: Assembly) -> np.ndarray:
    """Heights (e,) m of the other disks of contacts."""
    return body.positions[found.node, 1] + found.vectors(brick)[:, 1]


def _beyond(tile: np.ndarray, closing: np.ndarray, copies: tuple[int, int]) -> np.ndarray:
    """Mask (e, 4) of disks that lie beyond each of the sides of `BEYOND`.

    tile : (e, 2) in which copies of the brick they are; closing : (e, 2) bool, whether they are of its regular rows,
    which close the frame of a body, and so belong to it beyond its last bricks.
    """
    last = np.array(copies) - 1 + closing
    return np.stack([tile < 0, tile > last], axis=2).reshape(len(tile), 4)


def _ends(brick: Brick) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ends of the brick's contacts sorted by disk: contact (2b,), whether it is the second end (2b,), disk (2b,)."""
    count = len(brick.pairs)
    contact = np.tile(np.arange(count), 2)
    second = np.repeat([False, True], count)
    owner = brick.pairs.T.ravel()
    order = np.lexsort((second, contact, owner))
    return contact[order], second[order], owner[order]


def _key(where: np.ndarray, particle: np.ndarray, brick: Brick) -> np.ndarray:
    """One number for each disk of each tile; tiles (k, 2) from −2¹⁵ on."""
    shift, tall = 2**15, 2**31
    return ((where[:, 0] + shift) * tall + where[:, 1] + shift) * len(brick.radii) + particle
