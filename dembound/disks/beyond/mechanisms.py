"""The damping of the ground of a case, over the band of its waves."""

import math

from dembound.casefile.disks import DiskCase
from dembound.damping.attenuation import Attenuation
from dembound.damping.quality import fitted
from dembound.damping.rayleigh import Rayleigh
from dembound.disks.beyond.settings import signals_of
from dembound.outside import sizing

BAND = (0.3, 10.0)
"""Lowest and highest frequency (Hz) of nearly constant Q in a case without waves that have a highest frequency."""


def mechanisms_of(case: DiskCase, quality: float | None) -> Attenuation | None:
    """The damping of ground of a quality factor, with the settings of the case; None without one."""
    if quality is None:
        return None
    keys = case.damping
    band = keys.band or band_of(case)
    if keys.type == "rayleigh":
        return Rayleigh.fitted(quality, band)
    frequency = keys.frequency or float(f"{math.sqrt(band[0] * band[1]):.3g}")
    return fitted(quality, band, frequency, keys.mechanisms)


def band_of(case: DiskCase) -> tuple[float, float]:
    """The band (Hz) of the waves and forces of a case: as wide as `BAND`, up to the highest frequency they have."""
    highest = [sizing.cutoff(signal) for signal in signals_of(case) if not sizing.jumps(signal)]
    if not highest or max(highest) == 0.0:
        return BAND
    high = float(f"{max(highest):.3g}")
    return float(f"{high * BAND[0] / BAND[1]:.3g}"), high
