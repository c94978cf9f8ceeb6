"""Cases of a bar: their tables."""

from dembound.casefile.bar.model import SCHEMA, BarCase

__all__ = ["SCHEMA", "BarCase"]
