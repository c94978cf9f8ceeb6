"""Waves: named velocity histories that drive sides, or time factors of loads, one type a file.

A new type is one file and its class's name in the list below; another package registers its own under the entry point
group ``dembound.waves``.
"""

from typing import TYPE_CHECKING

from dembound.table import one_of, with_registered
from dembound.waves.constant import Constant
from dembound.waves.cosine import Cosine
from dembound.waves.record import Record
from dembound.waves.ricker import Ricker
from dembound.waves.sine_burst import SineBurst
from dembound.waves.spline import CubicSpline
from dembound.waves.triangle import Triangle
from dembound.waves.wave import Wave

TYPES = with_registered("dembound.waves", Wave, (Cosine, CubicSpline, Triangle, Ricker, SineBurst, Constant, Record))
"""All types of waves."""

if TYPE_CHECKING:
    WaveTable = Wave
else:
    WaveTable = one_of("type", TYPES)

__all__ = [
    "TYPES",
    "Constant",
    "Cosine",
    "CubicSpline",
    "Record",
    "Ricker",
    "SineBurst",
    "Triangle",
    "Wave",
    "WaveTable",
]
