"""Exact solutions that results are shown beside, one problem a file.

They know nothing of disks, cases or runs: plain numbers and arrays in, arrays out.
"""

from dembound.exact.dispersion import Lattice, cells_per_wavelength, courant_limit
from dembound.exact.lamb import rayleigh_speed, surface_displacement

__all__ = ["Lattice", "cells_per_wavelength", "courant_limit", "rayleigh_speed", "surface_displacement"]
