"""Mean stress in blocks of a body, from the forces across its contacts, and its deviation from a given one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields
from typing import Self

import numpy as np

from dembound.disks.contacts.forces import Piece, pieces
from dembound.disks.scene import DiskScene
from dembound.disks.side_forces import packing_pieces
from dembound.disks.stepping.system import DiskSystem
from dembound.kernels.contacts import UPDATED
from dembound.motion.state import Arrays
from dembound.packings.cut import BEYOND

RIM = 4.0
"""Width, in mean diameters, of the rim along the sides that no block includes; a quarter of narrower bodies."""

BLOCK = 10.0
"""Least width of a block in mean diameters, where the body is as wide."""


@dataclass(frozen=True, eq=False)
class Blocks:
    """Rectangles of equal size that fill a body inside its rim.

    Attributes
    ----------
    low, size : (2,) m, lower left corner of the first one, and the size of each. count : (2,) along x and y. wraps :
    (2,) bool, whether the body is periodic along the axis; it then has no rim. diameter : m, mean of the disks.
    """

    low: np.ndarray
    size: np.ndarray
    count: np.ndarray
    wraps: np.ndarray
    diameter: float

    @classmethod
    def of(cls, scene: DiskScene, moved: np.ndarray | None = None) -> Blocks:
        """The blocks of a body as built, or with its sides moved by displacements (3, n)."""
        diameter, wide = scene.ground.brick.mean_diameter, scene.assembly.size
        wraps = np.array(scene.case.periodic)
        rim = np.where(wraps, 0.0, np.minimum(RIM * diameter, 0.25 * wide))
        inside = wide - 2.0 * rim
        count = np.maximum(1, np.floor(inside / (BLOCK * diameter) * (1.0 + 1e-9))).astype(np.int64)
        low, high = rim.copy(), wide - rim
        for axis, sides in enumerate(BEYOND):
            if moved is not None and sides[0] in scene.edges:
                shift, further = (float(moved[axis, scene.edges[side].nodes].mean()) for side in sides)
                low[axis], high[axis] = (
                    x + shift + x / wide[axis] * (further - shift) for x in (low[axis], high[axis])
                )
        return cls(scene.assembly.origin + low, (high - low) / count, count, wraps, diameter)

    def stress(self, found: Iterable[Piece], positions: np.ndarray) -> np.ndarray:
        """Mean stress (nx, ny, 3) xx, yy, xy in Pa of each block, tension positive; xy averages both shear stresses.

        It is Σ w f_a l_b over the block's area: with the force f on the first disk of a contact, the vector l from its
        centre to that of the second, and the part w, inside the block, of a square of a mean diameter round the middle
        of l. With this square, rows of a lattice count the same wherever a block ends between them. Holes and pores
        add nothing. positions : (n, 2) m of the disks.
        """
        nx, ny = self.count.tolist()
        total = np.zeros((3, nx * ny))
        for piece in found:
            (x, y), (pull_x, pull_y) = piece.vector, piece.force
            dyads = np.stack([pull_x * x, pull_y * y, 0.5 * (pull_x * y + pull_y * x)])
            middle = positions[piece.first].T + 0.5 * piece.vector
            for column, part_x in self._shares(middle[0], 0):
                for row, part_y in self._shares(middle[1], 1):
                    inside = (column >= 0) & (column < nx) & (row >= 0) & (row < ny)
                    block = (column * ny + row)[inside]
                    for component, dyad in enumerate(dyads * part_x * part_y):
                        total[component] += np.bincount(block, dyad[inside], nx * ny)
        return (total / np.prod(self.size)).T.reshape(nx, ny, 3)

    def _shares(self, middle: np.ndarray, axis: int) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """The two columns or rows of blocks (k,) that a square round each place (k,) m may touch, and its parts."""
        size, begin = float(self.size[axis]), middle - self.low[axis] - 0.5 * self.diameter
        first = np.floor(begin / size).astype(np.int64)
        beyond = np.clip(1.0 + (begin - (first + 1) * size) / self.diameter, 0.0, 1.0)
        for number, part in ((first, 1.0 - beyond), (first + 1, beyond)):
            yield (number % self.count[axis] if self.wraps[axis] else number), part

    @property
    def middles(self) -> np.ndarray:
        """Middle (nx, ny, 2) m of each block."""
        at = np.stack(np.meshgrid(*(np.arange(count) for count in self.count), indexing="ij"), axis=-1)
        middles: np.ndarray = self.low + (at + 0.5) * self.size
        return middles

    def near(self, box: tuple[float, float, float, float]) -> np.ndarray:
        """Mask (nx, ny) of blocks within the width of the rim of a box left, bottom, right, top, m."""
        low, high = np.array(box[:2]) - RIM * self.diameter, np.array(box[2:]) + RIM * self.diameter
        half = 0.5 * self.size
        there: np.ndarray = np.asarray(((self.middles + half > low) & (self.middles - half < high)).all(axis=-1))
        return there


def block_stress(scene: DiskScene, system: DiskSystem, displacement: np.ndarray) -> np.ndarray:
    """Stress (nx, ny, 3) in the blocks of a body at displacements (3, n), see `Blocks.stress`; without its column."""
    part = system.disks.parts[-1]
    found = pieces(scene.layout, part.stressed_pairs, displacement, part.geometry)
    if part.geometry != UPDATED:
        return Blocks.of(scene).stress(found, scene.positions)
    return Blocks.of(scene, displacement).stress(found, scene.positions + displacement[:2].T)


@dataclass(frozen=True, eq=False)
class Uniformity:
    """Deviation of the stress in blocks from the requested one, over its largest principal stress.

    Attributes
    ----------
    block : (2,) m, width and height of a block. deviation : the largest of a component in a block not near a hole;
    place : (2,) m, the middle of this block. packing : the largest in the elastic packing without sides, an inherent
    property of a random one. near_holes : the largest near holes; nan without any.
    """

    block: np.ndarray
    deviation: float
    place: np.ndarray
    packing: float
    beyond: float
    near_holes: float

    @classmethod
    def of(cls, scene: DiskScene, system: DiskSystem, displacement: np.ndarray, asked: np.ndarray) -> Uniformity:
        """The uniformity of a body at displacements (3, n), for a requested stress (3,) Pa."""
        blocks, stress = Blocks.of(scene), block_stress(scene, system, displacement)
        xx, yy, xy = asked
        largest = abs(0.5 * (xx + yy)) + np.hypot(0.5 * (xx - yy), xy)
        scale = 1.0 / largest if largest > 0.0 else 0.0
        off = np.abs(stress - asked).max(axis=-1) * scale
        packing = blocks.stress(packing_pieces(scene, asked), scene.positions)
        own, beyond = (np.abs(each - packing).max(axis=-1) * scale for each in (asked, stress))
        near = np.zeros(off.shape, dtype=np.bool_)
        for hole in scene.case.hole:
            if hole.stage == "before" or scene.before is not None:
                near |= blocks.near(hole.box)
        away = np.where(near, -1.0, off)
        worst = np.unravel_index(np.argmax(away), away.shape)
        return cls(
            block=blocks.size,
            deviation=max(0.0, float(away[worst])),
            place=blocks.middles[worst],
            packing=float(own[~near].max(initial=0.0)),
            beyond=float(beyond[~near].max(initial=0.0)),
            near_holes=float(off[near].max()) if near.any() else float("nan"),
        )

    def saved_arrays(self) -> Arrays:
        """All numbers as arrays, from which `restored` restores the object."""
        return {field.name: np.array(getattr(self, field.name)) for field in fields(self)}

    @classmethod
    def restored(cls, saved: Arrays) -> Self:
        """The uniformity restored from the arrays returned by `saved_arrays`."""
        block, place = (saved[name].copy() for name in ("block", "place"))
        numbers = {name: float(saved[name]) for name in ("deviation", "packing", "beyond", "near_holes")}
        return cls(block=block, place=place, **numbers)
