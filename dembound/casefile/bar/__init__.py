"""Cases of a bar: their tables."""

from dembound.casefile.bar.model import BarCase
from dembound.casefile.bar.schema import SCHEMA

__all__ = ["SCHEMA", "BarCase"]
