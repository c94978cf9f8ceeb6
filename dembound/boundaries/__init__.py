"""Boundary types: each file holds one type's TOML table and its recipe for the support table.

A new type is one file and its class's name in the list below.
"""

from typing import Annotated

from pydantic import Field

from dembound.boundaries.fixed import Fixed
from dembound.boundaries.free import Free
from dembound.boundaries.periodic import Periodic
from dembound.boundaries.sides import OPPOSITE, SIDES, normal_axis
from dembound.boundaries.velocity import Velocity
from dembound.boundaries.viscous import Viscous, ViscousInput

BoundaryTable = Annotated[Free | Fixed | Velocity | Periodic | Viscous | ViscousInput, Field(discriminator="type")]
"""Any boundary table of a case file, told apart by its ``type``."""

__all__ = [
    "OPPOSITE",
    "SIDES",
    "BoundaryTable",
    "Fixed",
    "Free",
    "Periodic",
    "Velocity",
    "Viscous",
    "ViscousInput",
    "normal_axis",
]
