"""The frequencies of the waves and forces of a case, and the damping of its ground over their band."""

import math

import numpy as np

from dembound.casefile.disks.model import DiskCase
from dembound.continuum import sizing
from dembound.continuum.sizing import Signal
from dembound.damping import Attenuation, Rayleigh, fitted
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.surroundings.near_fields import signals_of
from dembound.waves.wave import Wave

LENGTHS = (200.0, 20.0)
"""Longest and shortest wave, in mean diameters, where a case has no waves with a spectrum of finite energy."""


def frequencies_of(case: DiskCase, ground: PackedMaterial, count: int) -> np.ndarray:
    """`count` frequencies (Hz), each for an equal share of the energy of the case's waves and forces.

    Without a spectrum of finite energy: frequencies of waves from `LENGTHS` diameters long, evenly spaced.
    """
    signals = [signal for signal in signals_of(case) if not sizing.jumps(signal)]
    highest = float(np.nanmax(ground.wave_speeds(0))) / (LENGTHS[1] * ground.brick.mean_diameter)
    if not signals:
        return np.linspace(LENGTHS[1] / LENGTHS[0], 1.0, count) * highest
    return np.sort(np.mean([_quantiles(signal, count) for signal in signals], axis=0))


def mean_frequency(case: DiskCase) -> float:
    """Mean frequency (Hz) of the energy of the case's waves and forces; nan without a spectrum of finite energy."""
    means = [_mean_of(signal) for signal in signals_of(case) if not sizing.jumps(signal)]
    means = [mean for mean in means if not math.isnan(mean)]
    return sum(means) / len(means) if means else math.nan


def share_above(wave: Wave, frequency: float) -> float:
    """Share of the energy of one wave's velocity, which must not jump, above a frequency (Hz)."""
    frequencies, energy = sizing.energies(Signal(wave, is_force=False))
    return float(energy[frequencies > frequency].sum() / energy.sum())


def _mean_of(signal: Signal) -> float:
    """Mean frequency of a signal, Hz; nan without energy."""
    frequencies, energy = sizing.energies(signal)
    return float(frequencies @ energy / energy.sum()) if energy.sum() > 0.0 else math.nan


def _quantiles(signal: Signal, count: int) -> np.ndarray:
    """Frequencies (count,) in the middle of equal shares of a signal's energy."""
    frequencies, energy = sizing.energies(signal)
    share = np.concatenate([[0.0], np.cumsum(energy) / energy.sum()])
    return np.interp((np.arange(count) + 0.5) / count, share, np.concatenate([[0.0], frequencies]))


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
