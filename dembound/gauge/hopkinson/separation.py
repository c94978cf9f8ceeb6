"""Waves in a bar between its gauges: moved from place to place, and separated by their direction.

A wave to the right is e(x, t) = ∫ ê(ω) exp i(ωt − k x) dω with the complex wave number k = ω/c − iα, or with that of
the first mode of a round bar in place of ω/c (`exact.pochhammer`). Spectra are taken of the signal times exp(−ηt), that
is, at frequencies ω − iη: so the end of a record does not wrap around to its beginning, and where two gauges are half a
wavelength apart nothing is divided by zero.
"""

from dataclasses import dataclass

import numpy as np

from dembound.exact.pochhammer import wavenumber

FADED = 1e-4
"""exp(−ηT), the factor of the end of a record of length T."""

PADDING = 2
"""Length of the spectrum's record over that of the signal."""


@dataclass(frozen=True)
class LongBar:
    """A long bar in which waves run.

    speed : c_0 of long waves, m/s; attenuation : α, 1/m; radius : m, and poisson : ν, for the dispersion of a round
    bar; None without.
    """

    speed: float
    attenuation: float = 0.0
    radius: float | None = None
    poisson: float | None = None

    def wavenumbers(self, frequency: np.ndarray, damping: float) -> np.ndarray:
        """Complex k (n,) rad/m at angular frequencies ω − iη, ω ≥ 0 (n,) and η both in rad/s."""
        if self.radius is None or self.poisson is None:
            return (frequency - 1j * damping) / self.speed - 1j * self.attenuation
        real = wavenumber(frequency, self.radius, self.poisson, self.speed)
        slope = np.gradient(real, frequency)  # 1/c_g: k(ω − iη) is k − iη/c_g, as η is small beside ω where k bends
        return real - 1j * damping * slope - 1j * self.attenuation


def moved(time: np.ndarray, values: np.ndarray, distance: float, bar: LongBar) -> np.ndarray:
    """A wave (k,) after travelling a distance, or before, for a negative distance, at the same times.

    time : (k,) s, evenly spaced. distance : m, in the wave's direction. Before the record the wave is zero.
    """
    frequency, damping, grown = _axis(time)
    spectrum = np.fft.rfft(values / grown, PADDING * len(time))
    spectrum *= np.exp(-1j * bar.wavenumbers(frequency, damping) * distance)
    return np.fft.irfft(spectrum, PADDING * len(time))[: len(time)] * grown


def separated(
    time: np.ndarray, first: np.ndarray, second: np.ndarray, distance: float, bar: LongBar
) -> tuple[np.ndarray, np.ndarray]:
    """The waves to the right and to the left (k,), at the first gauge, from two gauges on a bar (Zhao & Gary 1997).

    With P the change on the way between them, first = R + L and second = P R + L/P, so R = (first − P second)/(1 − P²).

    Parameters
    ----------
    time : (k,) s, evenly spaced. first, second : (k,) strains or stresses; the second gauge is farther to the right.
    distance : between them, m.

    Raises ValueError for a distance that is not positive.
    """
    if not distance > 0.0:
        raise ValueError(f"distance ({distance} m) must be above 0")
    frequency, damping, grown = _axis(time)
    one, two = (np.fft.rfft(each / grown, PADDING * len(time)) for each in (first, second))
    passage = np.exp(-1j * bar.wavenumbers(frequency, damping) * distance)
    right = (one - passage * two) / (1.0 - passage**2)
    waves = (np.fft.irfft(each, PADDING * len(time))[: len(time)] * grown for each in (right, one - right))
    rightward, leftward = waves
    return rightward, leftward


def _axis(time: np.ndarray) -> tuple[np.ndarray, float, np.ndarray]:
    """Angular frequencies ω of a spectrum, η in rad/s, and exp(ηt) (k,)."""
    step = float(time[-1] - time[0]) / (len(time) - 1)
    damping = -np.log(FADED) / (PADDING * len(time) * step)
    frequency = 2.0 * np.pi * np.fft.rfftfreq(PADDING * len(time), step)
    return frequency, damping, np.exp(damping * step * np.arange(len(time)))
