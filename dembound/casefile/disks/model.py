"""A case of bonded disks: all tables of one file."""

from dataclasses import dataclass, field

from dembound.casefile.disks.load import Load
from dembound.casefile.disks.material import Material
from dembound.casefile.disks.monitor import Monitor
from dembound.casefile.disks.motion import Motion
from dembound.casefile.disks.outside import OutsideTable
from dembound.casefile.disks.reduce import Reduce
from dembound.casefile.disks.static import Static
from dembound.casefile.model import Case
from dembound.holes import Hole
from dembound.packings import Packing


@dataclass(frozen=True, kw_only=True)
class DiskCase(Case):
    """A case of bonded disks.

    Attributes
    ----------
    packing, material, motion, outside, reduce : the tables of these names.
    static : the table of this name; None: no static stage.
    hole : in the order of the file.
    """

    packing: Packing
    material: Material
    motion: Motion = field(default_factory=Motion)
    outside: OutsideTable = field(default_factory=OutsideTable)
    reduce: Reduce = field(default_factory=Reduce)
    static: Static | None = None
    hole: tuple[Hole, ...] = ()
    load: tuple[Load, ...] = ()
    monitor: tuple[Monitor, ...] = ()
