"""Exact solutions with which results are compared.

They import nothing about disks, cases or runs. Arguments are numbers and arrays, results are arrays.
"""

from dembound.exact.bar import Lattice, bar_stress, bar_velocity, cells_per_wavelength, courant_limit, triangle_spall
from dembound.exact.explosion import CavityMotion, buried_explosion, cavity_moment, cavity_motion
from dembound.exact.lamb import rayleigh_speed, surface_displacement
from dembound.exact.lamb_below import buried_displacement
from dembound.exact.scattering import PlaneWave, ScatteredMotion, scattered_motion
from dembound.exact.solid import Solid

__all__ = [
    "CavityMotion",
    "Lattice",
    "PlaneWave",
    "ScatteredMotion",
    "Solid",
    "bar_stress",
    "bar_velocity",
    "buried_displacement",
    "buried_explosion",
    "cavity_moment",
    "cavity_motion",
    "cells_per_wavelength",
    "courant_limit",
    "rayleigh_speed",
    "scattered_motion",
    "surface_displacement",
    "triangle_spall",
]
