"""Boundary types: each file holds one type's TOML table and its recipe for the support table.

A new type is one file and its class's name in the list below; another package registers its own under the entry point
group ``dembound.boundaries``.
"""

from typing import TYPE_CHECKING

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.fixed import Fixed
from dembound.boundaries.free import Free
from dembound.boundaries.free_field import FreeField
from dembound.boundaries.periodic import Periodic
from dembound.boundaries.roller import Roller
from dembound.boundaries.sides import OPPOSITE, SIDES, Motion, axis_of_motion, normal_axis
from dembound.boundaries.symmetry import Symmetry
from dembound.boundaries.velocity import Velocity
from dembound.boundaries.viscoelastic import Viscoelastic, ViscoelasticInput
from dembound.boundaries.viscous import Viscous, ViscousInput
from dembound.table import one_of, with_registered

TYPES: tuple[type[Boundary], ...] = with_registered(
    "dembound.boundaries",
    Boundary,
    (
        Free,
        Fixed,
        Roller,
        Symmetry,
        Velocity,
        Periodic,
        Viscous,
        ViscousInput,
        Viscoelastic,
        ViscoelasticInput,
        FreeField,
    ),
)
"""All types of sides."""

if TYPE_CHECKING:
    BoundaryTable = Boundary
    BarEndTable = Boundary
else:
    BoundaryTable = one_of("type", TYPES)
    BarEndTable = one_of("type", [table for table in TYPES if table.for_bars])

__all__ = [
    "OPPOSITE",
    "SIDES",
    "TYPES",
    "BarEndTable",
    "Boundary",
    "BoundaryTable",
    "Fixed",
    "Free",
    "FreeField",
    "Motion",
    "Periodic",
    "Roller",
    "Symmetry",
    "Velocity",
    "Viscoelastic",
    "ViscoelasticInput",
    "Viscous",
    "ViscousInput",
    "axis_of_motion",
    "normal_axis",
]
