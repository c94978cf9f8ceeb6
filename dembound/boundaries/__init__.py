"""Boundary types: each file contains the TOML table of one type and fills its rows of the support table.

A new type is one file and its class's name in `TYPES`; another package registers its own, see casefile/types.py.
"""

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import OPPOSITE, SIDES, Motion, axis_of_motion, is_far, normal_axis, plane_of
from dembound.boundaries.fixed import Fixed
from dembound.boundaries.free import Free
from dembound.boundaries.free_field import FreeField
from dembound.boundaries.matched_layer import MatchedLayer
from dembound.boundaries.outside import Outside
from dembound.boundaries.periodic import Periodic
from dembound.boundaries.platen import beside_disks, driven_components
from dembound.boundaries.roller import Roller
from dembound.boundaries.symmetry import Symmetry
from dembound.boundaries.velocity import Velocity
from dembound.boundaries.viscoelastic import Viscoelastic, ViscoelasticInput
from dembound.boundaries.viscous import Viscous, ViscousInput

TYPES: tuple[type[Boundary], ...] = (
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
    Outside,
    MatchedLayer,
)
"""All types of sides."""

__all__ = [
    "OPPOSITE",
    "SIDES",
    "TYPES",
    "Boundary",
    "Fixed",
    "Free",
    "FreeField",
    "MatchedLayer",
    "Motion",
    "Outside",
    "Periodic",
    "Roller",
    "Symmetry",
    "Velocity",
    "Viscoelastic",
    "ViscoelasticInput",
    "Viscous",
    "ViscousInput",
    "axis_of_motion",
    "beside_disks",
    "driven_components",
    "is_far",
    "normal_axis",
    "plane_of",
]
