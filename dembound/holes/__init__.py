"""Holes: each file contains the TOML table of one shape and computes which positions lie in it.

A new shape is one file and its class's name in `TYPES`; another package registers its own, see casefile/types.py.
"""

from dembound.holes.circle import Circle
from dembound.holes.ellipse import Ellipse
from dembound.holes.hole import Hole
from dembound.holes.polygon import Polygon
from dembound.holes.rectangle import Rectangle

TYPES = (Circle, Ellipse, Rectangle, Polygon)
"""All shapes."""

__all__ = ["TYPES", "Circle", "Ellipse", "Hole", "Polygon", "Rectangle"]
