"""Waves: named velocity histories that drive sides, or time factors of loads, one type per file.

A new type is one file and its class's name in `TYPES`; another package registers its own, see casefile/types.py.
"""

from dembound.waves.constant import Constant
from dembound.waves.cosine import Cosine
from dembound.waves.file_wave import FileWave
from dembound.waves.ricker import Ricker
from dembound.waves.sine_burst import SineBurst
from dembound.waves.spline import CubicSpline
from dembound.waves.triangle import Triangle
from dembound.waves.wave import Wave

TYPES = (Cosine, CubicSpline, Triangle, Ricker, SineBurst, Constant, FileWave)
"""All types of waves."""

__all__ = ["TYPES", "Constant", "Cosine", "CubicSpline", "FileWave", "Ricker", "SineBurst", "Triangle", "Wave"]
