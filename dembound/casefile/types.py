"""All types of tables in a case file: those of this package and those that other packages register.

Another package registers its types under the entry point groups below; its modules may import from the packages of the
same names and from `dembound.table`.
"""

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

from dembound import boundaries, holes, laws, methods, packings, waves
from dembound.boundaries import Boundary
from dembound.holes import Hole
from dembound.laws import Law
from dembound.methods import Method
from dembound.packings import Packing
from dembound.table import UnusableTypeWarning, one_of, with_registered
from dembound.waves import Wave

BOUNDARIES = with_registered("dembound.boundaries", Boundary, boundaries.TYPES)
HOLES = with_registered("dembound.holes", Hole, holes.TYPES)
METHODS = with_registered("dembound.methods", Method, methods.TYPES)
PACKINGS = with_registered("dembound.packings", Packing, packings.TYPES)
WAVES = with_registered("dembound.waves", Wave, waves.TYPES)


def _usable(found: Mapping[str, Law]) -> dict[str, Law]:
    """Laws by name, without those with a history that name no law of the same stiffness without one."""
    usable = {
        name: law for name, law in found.items() if (at_rest := found.get(law.linear)) and not at_rest.has_history
    }
    for name, law in found.items():
        if name not in usable:
            said = (
                f'dembound.laws: "{name}" names "{law.linear}" as its linear law, which must be a law without history'
            )
            warnings.warn(said, UnusableTypeWarning, stacklevel=2)
    return usable


LAWS = _usable({law.name: law() for law in with_registered("dembound.laws", Law, laws.TYPES)})
"""Name in a case file -> law."""

BoundaryTable, HoleTable, MethodTable = one_of("type", BOUNDARIES), one_of("type", HOLES), one_of("type", METHODS)
PackingTable, WaveTable = one_of("pattern", PACKINGS), one_of("type", WAVES)
BarEndTable = one_of("type", [table for table in BOUNDARIES if table.for_bars])

if TYPE_CHECKING:
    StaticSide = Boundary
    LawName = str
else:
    StaticSide = one_of("type", [table for table in BOUNDARIES if table.for_static])
    LawName = Literal[tuple(LAWS)]
