"""Deconvolution: the incident wave below the ground of a case that moves its surface as a record.

What runs up below the free surface is half of its motion, early by the way up; from what runs up at the plane where the
wave enters, the incident wave follows as in disks/within.py: in the same ground, or in the rock of the side. The ground
is uniform and undamped, so this only delays and adds, and is computed for all frequencies of the record.
"""

import math
from dataclasses import dataclass

import numpy as np

from dembound.boundaries import Motion
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.motions_of_waves import not_level
from dembound.disks.scene import build
from dembound.disks.within import Level
from dembound.errors import CaseError
from dembound.waves.spectrum import amplitude_spectrum, faded_frequency

SIDE = "bottom"
"""The side at which the wave enters."""


@dataclass(frozen=True)
class Deconvolved:
    """An incident wave.

    velocity : (n + k,) m/s at the time step of the record. early : by how many steps k it begins before the record, so
    that the surface moves k steps later than recorded if the wave begins at t = 0. magnification : largest amplitude
    over that of the record, which noise has too; band : highest frequency that counts, Hz.
    """

    velocity: np.ndarray
    early: int
    magnification: float
    band: float

    @property
    def sentence(self) -> str:
        """The magnification in words."""
        return (
            f"the incident wave has up to {self.magnification:.3g} times the amplitude of the surface at frequencies "
            f"to {self.band:.3g} Hz, and so has the noise of the record"
        )


def deconvolve(case: DiskCase, surface: np.ndarray, time_step: float, motion: Motion | None = None) -> Deconvolved:
    """The incident wave at the bottom of a case that gives its free surface a velocity (n,) m/s, sampled at a step (s).

    motion : S or P; by default that of the wave of the bottom side. The record is zero beyond its ends.

    Raises CaseError where the ground is not level under a free surface, or no such wave enters at the bottom.
    """
    table = case.side(SIDE)
    if problems := [f"deconvolution: needs {reason}" for reason in not_level(SIDE, table, case.tables)]:
        raise CaseError(problems, case.name)
    waves = case.driving.get(SIDE, {})
    motion = motion or next(iter(waves), None)
    if motion not in waves or {0, 1} & {*table.prescribed(1)}:
        kind = "wave_p or wave_s" if motion is None else f"wave_{motion}"
        raise CaseError([f"boundary.{SIDE}: must absorb and name a {kind}, whose ground and rock are taken"], case.name)
    return incident_below(Level.of(build(case), SIDE, motion), surface, time_step)


def incident_below(ground: Level, surface: np.ndarray, time_step: float) -> Deconvolved:
    """The incident wave below level ground whose free surface has a velocity (n,) m/s, sampled at a step (s)."""
    way = ground.height / ground.speed
    early = math.ceil((way + max(0.0, -ground.mass, -ground.stiffness) / ground.speed) / time_step)
    count = len(surface) + early
    window = 2 ** math.ceil(math.log2(2 * count))
    frequencies = np.fft.rfftfreq(window, time_step)
    turn = 2j * math.pi * frequencies
    below = 0.5 * sum(factor * np.exp(-turn * (late - way)) for late, factor in ground.echoes)
    spectrum = np.fft.rfft(surface, window) * below * np.exp(-turn * early * time_step)
    velocity = np.fft.irfft(spectrum, window)[:count]
    band = faded_frequency(*amplitude_spectrum(surface, time_step))
    magnification = float(np.abs(below[frequencies <= max(band, frequencies[1])]).max())
    return Deconvolved(velocity, early, magnification, band)
