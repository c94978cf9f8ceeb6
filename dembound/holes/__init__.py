"""Holes: the TOML table of each shape computes which positions lie in it.

A new shape is a class, in shapes.py or a file of its own, and its name in `TYPES`; another package registers its own,
see casefile/types.py.
"""

from dembound.holes.hole import Hole
from dembound.holes.shapes import Circle, Ellipse, Polygon, Rectangle

TYPES = (Circle, Ellipse, Rectangle, Polygon)
"""All shapes."""

__all__ = ["TYPES", "Circle", "Ellipse", "Hole", "Polygon", "Rectangle"]
