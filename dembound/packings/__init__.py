"""Where the disks are: one table and one file per pattern, and the tiling that makes a scene of a brick.

A new pattern is one file and its class's name in the list below; another package registers its own under the entry
point group ``dembound.packings``.
"""

from typing import TYPE_CHECKING

from dembound.packings.base import Packing
from dembound.packings.edged_brick import EdgedBrick
from dembound.packings.random_brick import RandomBrick
from dembound.packings.square import Square
from dembound.table import one_of, with_registered

TYPES = with_registered("dembound.packings", Packing, (Square, RandomBrick, EdgedBrick))
"""All patterns."""

if TYPE_CHECKING:
    PackingTable = Packing
else:
    PackingTable = one_of("pattern", TYPES)

__all__ = ["TYPES", "EdgedBrick", "Packing", "PackingTable", "RandomBrick", "Square"]
