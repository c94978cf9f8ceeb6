"""Cases of bonded disks: their tables."""

from dembound.casefile.disks.model import DiskCase
from dembound.casefile.disks.schema import SCHEMA

__all__ = ["SCHEMA", "DiskCase"]
