"""Positions of the disks: one table and one file per pattern, and the tiling of bricks to a scene.

A new pattern is one file and its class's name in `TYPES`; another package registers its own, see casefile/types.py.
"""

from dembound.packings.base import Packing
from dembound.packings.edged_brick import EdgedBrick
from dembound.packings.random_brick import RandomBrick
from dembound.packings.square import Square

TYPES = (Square, RandomBrick, EdgedBrick)
"""All patterns."""

__all__ = ["TYPES", "EdgedBrick", "Packing", "RandomBrick", "Square"]
