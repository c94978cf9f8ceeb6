"""Waves: named velocity histories that drive sides, or time factors of loads.

A new type is a class in a file of its own, and its name in `TYPES`; another package registers its own, see
casefile/types.py.
"""

from dembound.waves.constant import Constant
from dembound.waves.file_wave import FileWave
from dembound.waves.pulses import Cosine, CubicSpline, Ricker, Triangle
from dembound.waves.sine_burst import SineBurst
from dembound.waves.wave import Wave

TYPES = (Cosine, CubicSpline, Triangle, Ricker, SineBurst, Constant, FileWave)
"""All types of waves."""

__all__ = ["TYPES", "Constant", "Cosine", "CubicSpline", "FileWave", "Ricker", "SineBurst", "Triangle", "Wave"]
