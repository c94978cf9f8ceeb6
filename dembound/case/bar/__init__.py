"""Cases of a bar: their tables."""

from dembound.case.bar.model import BarCase
from dembound.case.bar.schema import SCHEMA
from dembound.case.bar.starter import STARTER

__all__ = ["SCHEMA", "STARTER", "BarCase"]
