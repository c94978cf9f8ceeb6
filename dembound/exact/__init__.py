"""Exact solutions with which results are compared, one problem per file.

They import nothing about disks, cases or runs. Arguments are numbers and arrays, results are arrays.
"""

from dembound.exact.bar import bar_stress, bar_velocity, triangle_spall
from dembound.exact.dispersion import Lattice, cells_per_wavelength, courant_limit
from dembound.exact.lamb import rayleigh_speed, surface_displacement

__all__ = [
    "Lattice",
    "bar_stress",
    "bar_velocity",
    "cells_per_wavelength",
    "courant_limit",
    "rayleigh_speed",
    "surface_displacement",
    "triangle_spall",
]
