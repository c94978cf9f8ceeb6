"""Boundary types: each file holds one type's TOML table and its recipe for the support table.

A new type is one file and its class's name in the list below.
"""

from typing import Annotated

from pydantic import Field

from dembound.boundaries.fixed import Fixed
from dembound.boundaries.free import Free
from dembound.boundaries.free_field import FreeField
from dembound.boundaries.periodic import Periodic
from dembound.boundaries.roller import Roller
from dembound.boundaries.sides import OPPOSITE, SIDES, normal_axis
from dembound.boundaries.symmetry import Symmetry
from dembound.boundaries.velocity import Velocity
from dembound.boundaries.viscoelastic import Viscoelastic, ViscoelasticInput
from dembound.boundaries.viscous import Viscous, ViscousInput

BoundaryTable = Annotated[
    Free
    | Fixed
    | Roller
    | Symmetry
    | Velocity
    | Periodic
    | Viscous
    | ViscousInput
    | Viscoelastic
    | ViscoelasticInput
    | FreeField,
    Field(discriminator="type"),
]
"""Any boundary table of a case file, told apart by its ``type``."""

BarEndTable = Annotated[Free | Fixed | Velocity | Viscous | ViscousInput, Field(discriminator="type")]
"""Those that an end of a bar can have."""

__all__ = [
    "OPPOSITE",
    "SIDES",
    "BarEndTable",
    "BoundaryTable",
    "Fixed",
    "Free",
    "FreeField",
    "Periodic",
    "Roller",
    "Symmetry",
    "Velocity",
    "Viscoelastic",
    "ViscoelasticInput",
    "Viscous",
    "ViscousInput",
    "normal_axis",
]
