"""Cases of bonded disks: their tables."""

from dembound.case.disks.model import DiskCase
from dembound.case.disks.schema import SCHEMA
from dembound.case.disks.starter import STARTER

__all__ = ["SCHEMA", "STARTER", "DiskCase"]
