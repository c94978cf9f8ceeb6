"""A whole number of sine cycles, tapered or not."""

import math
from typing import Literal

import numpy as np

from dembound.roots import root
from dembound.table import quantity
from dembound.waves.wave import FADED, HANN_FADE, Shape

MOST_CYCLES = 1_000_000
"""Largest number of cycles: more is a mistake, and rounding would shift the last ones."""


class SineBurst(Shape):
    """v = M w(t) sin 2πft for n cycles, w = ½(1 − cos 2πft/n) when tapered, else 1. No net displacement.

    With the taper M is the crest of the envelope; that of the velocity is slightly smaller.
    """

    type: Literal["sine_burst"]
    frequency: float = quantity(unit="Hz", gt=0.0)
    """frequency of the sine"""
    cycles: int = quantity(means="count", ge=1, le=MOST_CYCLES)
    """number of cycles"""
    taper: bool = quantity(True)
    """a Hann window fades the burst in and out"""

    def _harmonics(self) -> tuple[tuple[int, float], ...]:
        """The burst as plain sines (cycles k in the burst's length, factor): Σ factor · sin(2πk·t/length)."""
        if not self.taper:
            return ((self.cycles, 1.0),)
        sides = ((self.cycles - 1, -0.25), (self.cycles + 1, -0.25))
        return ((self.cycles, 0.5), *(side for side in sides if side[0] > 0))

    def _velocity_shape(self, since: np.ndarray) -> np.ndarray:
        phase = 2.0 * math.pi * np.clip(since * self.frequency / self.cycles, 0.0, 1.0)
        return sum((factor * np.sin(k * phase) for k, factor in self._harmonics()), np.zeros_like(phase))

    def _displacement_shape(self, since: np.ndarray) -> np.ndarray:
        phase = 2.0 * math.pi * np.clip(since * self.frequency / self.cycles, 0.0, 1.0)
        per_radian = self.cycles / (2.0 * math.pi * self.frequency)
        shape = sum((w / k * (1.0 - np.cos(k * phase)) for k, w in self._harmonics()), np.zeros_like(phase))
        return per_radian * shape

    def _crest(self) -> float:
        """Time from the largest |velocity| to the middle of a tapered burst, as a phase of the window.

        With e that phase (π over the whole length) the burst is ±cos²e · sin 2ne, largest where
        n cos e cos 2ne = sin e sin 2ne; the root nearest the middle lies between 0 and π/4n.
        """
        n = self.cycles

        def slope(e: float) -> float:
            return n * math.cos(e) * math.cos(2 * n * e) - math.sin(e) * math.sin(2 * n * e)

        return root(slope, 0.0, math.pi / (4 * n))

    def peak(self) -> float:
        """Largest |velocity|, m/s: the amplitude, or a little less when tapered."""
        if not self.taper:
            return self.share * abs(self.amplitude)
        e = self._crest()
        return self.share * abs(self.amplitude) * math.cos(e) ** 2 * math.sin(2 * self.cycles * e)

    def peak_time(self) -> float:
        """Time of the first largest |velocity|, s."""
        if not self.taper:
            return self.start + 0.25 / self.frequency
        return self.start + (0.5 - self._crest() / math.pi) * self.cycles / self.frequency

    def duration(self) -> float:
        """Time from which the wave is over, s: n cycles after the start."""
        return self.start + self.cycles / self.frequency

    def dominant_frequency(self) -> float:
        """Frequency of the sine, Hz."""
        return self.frequency

    def highest_frequency(self) -> float:
        """Frequency above which the spectrum stays below 1 % of its largest value, Hz; an upper bound.

        Tapered: the bandwidth of the window added to f (the sine's negative frequency only lowers it). Plain: the
        envelope f/[π(F² − f²)] of the spectrum at frequency F against its value n/(2f) at f.
        """
        if self.taper:
            return self.frequency * (1.0 + HANN_FADE / self.cycles)
        return self.frequency * math.sqrt(1.0 + 2.0 / (math.pi * self.cycles * FADED))
