"""All types of tables in a case file: those of this package and those that other packages register.

Another package registers its types under the entry point groups below; its modules may import from the packages of the
same names and from `dembound.table`.
"""

import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Literal

from dembound import boundaries, holes, laws, methods, packings, waves
from dembound.boundaries import Boundary
from dembound.errors import CaseError
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
    """Laws by name, without history-dependent laws that name no linear law of the same stiffness."""

    def is_usable(law: Law) -> bool:
        at_rest = found.get(law.linear)
        if law.linear == law.name:
            return not law.has_history
        return at_rest is not None and at_rest.is_linear and not at_rest.has_history

    usable = {name: law for name, law in found.items() if is_usable(law)}
    for name, law in found.items():
        if name not in usable:
            said = (
                f'dembound.laws: "{name}" names "{law.linear}" as its linear law, which must be a linear law without '
                "history"
            )
            warnings.warn(said, UnusableTypeWarning, stacklevel=2)
    return usable


LAWS = _usable({law.name: law() for law in with_registered("dembound.laws", Law, laws.TYPES)})
"""Name in a case file -> law."""


def linear_law(name: str) -> str:
    """Name of the linear law that has the same stiffness at rest as a law.

    Raises CaseError for a law that is not linear and names none.
    """
    linear = LAWS[name].linear
    if not LAWS[linear].is_linear:
        raise CaseError([f'material.law: is "{name}", which is not linear, and names no linear law of its stiffness'])
    return linear


def require_linear(name: str) -> None:
    """Raise CaseError for a law that is not linear at the start, as its motion is not that of a linear medium.

    Most history-dependent laws are linear until something opens, slides or breaks, which runs detect.
    """
    if not (LAWS[name].is_linear or (LAWS[name].has_history and LAWS[name].starts_elastic)):
        raise CaseError([f'material.law: is "{name}", which is not linear; errors are known only for linear laws'])


BoundaryTable, HoleTable, MethodTable = one_of("type", BOUNDARIES), one_of("type", HOLES), one_of("type", METHODS)
PackingTable, WaveTable = one_of("pattern", PACKINGS), one_of("type", WAVES)
BarEndTable = one_of("type", [table for table in BOUNDARIES if table.for_bars])

if TYPE_CHECKING:
    StaticSide = Boundary
    LawName = str
else:
    StaticSide = one_of("type", [table for table in BOUNDARIES if table.for_static])
    LawName = Literal[tuple(LAWS)]
