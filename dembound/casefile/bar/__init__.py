"""Cases of a bar: their tables."""

from dembound.casefile.bar.model import BarCase
from dembound.casefile.bar.schema import SCHEMA
from dembound.casefile.bar.starter import STARTER

__all__ = ["SCHEMA", "STARTER", "BarCase"]
