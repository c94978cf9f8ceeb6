"""Holes: each file holds one shape's TOML table and says which positions lie in it.

A new shape is one file and its class's name in the list below; another package registers its own under the entry point
group ``dembound.holes``.
"""

from typing import TYPE_CHECKING

from dembound.holes.circle import Circle
from dembound.holes.ellipse import Ellipse
from dembound.holes.hole import Hole
from dembound.holes.polygon import Polygon
from dembound.holes.rectangle import Rectangle
from dembound.table import one_of, with_registered

TYPES = with_registered("dembound.holes", Hole, (Circle, Ellipse, Rectangle, Polygon))
"""All shapes."""

if TYPE_CHECKING:
    HoleTable = Hole
else:
    HoleTable = one_of("type", TYPES)

__all__ = ["TYPES", "Circle", "Ellipse", "Hole", "HoleTable", "Polygon", "Rectangle"]
