"""Holes: each file holds one shape's TOML table and says which positions lie in it.

A new shape is one file and its class's name in the list below.
"""

from typing import Annotated

from pydantic import Field

from dembound.holes.circle import Circle
from dembound.holes.ellipse import Ellipse
from dembound.holes.hole import Hole
from dembound.holes.polygon import Polygon
from dembound.holes.rectangle import Rectangle

HoleTable = Annotated[Circle | Ellipse | Rectangle | Polygon, Field(discriminator="type")]
"""Any hole of a case file, told apart by its ``type``."""

__all__ = ["Circle", "Ellipse", "Hole", "HoleTable", "Polygon", "Rectangle"]
