"""The size of elements that waves of a case need."""

from __future__ import annotations

import math

import numpy as np

from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.outside.medium import Medium
from dembound.waves.wave import Wave

SHARE = 0.999
"""Share of the energy of a wave's velocity below its cut-off frequency."""

LEAST_SPACING = 1.25
"""Smallest mean spacing of nodes in diameters: finer elements gain nothing, as the disks themselves disperse."""

SAMPLES = 2**14

POINTS = {3: (0.17, 20.0), 4: (0.05, 24.0), 5: (0.05, 24.0), 6: (0.05, 24.0)}
"""By order: error (%) of waves over some wavelengths with so many nodes per shortest S wavelength; it falls as the
square of the spacing at least. Measured round a tunnel for orders 3 and 4; higher orders, which are
more accurate, have the number of the latter."""


def cutoff(wave: Wave) -> float:
    """Frequency (Hz) below which `SHARE` of the energy of a wave's velocity lies; infinite for one without an end."""
    end = wave.duration()
    if not math.isfinite(end):
        return wave.highest_frequency()
    length = end - wave.start
    times = wave.start + 4.0 * length * np.arange(SAMPLES) / SAMPLES
    energy = np.cumsum(np.abs(np.fft.rfft(wave.velocity(times))) ** 2)
    return float(np.searchsorted(energy, SHARE * energy[-1]) / (4.0 * length))


def shortest_wave(case: Case, medium: Medium) -> float:
    """Length (m) of the slowest waves of the medium at the highest cut-off frequency of the waves of a case.

    Raises CaseError if the case has no wave, or one that jumps.
    """
    frequencies = [cutoff(wave) for wave in case.wave.values()]
    if not frequencies:
        raise CaseError(["outside.element: is 0, but the case has no wave that it could be chosen from; give it"])
    if not math.isfinite(max(frequencies)):
        raise CaseError(["outside.element: is 0, but a wave jumps, which no element resolves; give it"])
    slowest = min(float(medium.plane_waves((math.cos(a), math.sin(a)))[0][0]) for a in np.linspace(0.0, math.pi, 37))
    return slowest / max(frequencies)


def element_size(case: Case, medium: Medium, diameter: float, order: int = 4, accuracy: float = 1e-3) -> float:
    """Largest side (m) of elements with which waves have this accuracy, in a medium of disks of this mean diameter."""
    percent, points = POINTS[order]
    needed = points * math.sqrt(percent / (100.0 * accuracy))
    return max(order * shortest_wave(case, medium) / needed, order * LEAST_SPACING * diameter)
