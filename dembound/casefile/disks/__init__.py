"""Cases of bonded disks: their tables."""

from dembound.casefile.disks.model import DiskCase
from dembound.casefile.disks.schema import SCHEMA
from dembound.casefile.disks.starter import STARTER

__all__ = ["SCHEMA", "STARTER", "DiskCase"]
