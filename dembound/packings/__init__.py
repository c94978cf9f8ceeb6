"""Where the disks are: one table and one file per pattern, and the tiling that makes a scene of a brick."""

from typing import Annotated

from pydantic import Field

from dembound.packings.edged_brick import EdgedBrick
from dembound.packings.random_brick import RandomBrick
from dembound.packings.square import Square

PackingTable = Annotated[Square | RandomBrick | EdgedBrick, Field(discriminator="pattern")]

__all__ = ["EdgedBrick", "PackingTable", "RandomBrick", "Square"]
