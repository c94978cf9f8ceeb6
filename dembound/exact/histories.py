"""Histories that follow from an incident wave by factors to its spectrum.

The velocity v of the incident wave is sampled from where it begins, and fades beyond the last time that is asked for.
With e^{−εt} v(t), which decays within the window, its Fourier transform is that at the frequencies ω − iε, and so are
all motions that it causes: what comes round again is `DECAY` times smaller.
"""

import math
from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np

PADDED = 4
"""Length of the window of a history over that of the history, at least; a power of two in samples."""

DECAY = math.log(1e8)
"""Decay of signals over a window: what comes round again has 1e-8 of its size."""

POINTS = 10
"""Samples from which a value between them is interpolated: with eight in a period to 2e-5, with sixteen to 2e-8."""

RATE = 0.25
"""Part of the band of samples above which a wave has less than `FAINT` of its largest amplitude, if they suffice."""

FAINT, NONE = 1e-6, 1e-10
"""Amplitude over the largest one that is hardly visible, and that is left out."""

FEWEST, MOST = 2**9, 2**16
"""Least and largest number of samples up to the last time."""

FADING = 0.5
"""Time in which a wave fades beyond the last time, over that from its begin."""


class Window(NamedTuple):
    """Samples of a wave: how many up to the last time, step, s, and rate ε, 1/s; frequencies, Hz, and spectrum."""

    kept: int
    step: float
    rate: float
    frequencies: np.ndarray
    spectrum: np.ndarray

    def derived(self, derivatives: int) -> np.ndarray:
        """The spectrum (k,) of a derivative in time of the displacement."""
        return np.asarray(self.spectrum * (2j * math.pi * self.frequencies) ** (derivatives - 1))

    def sampled(self, spectrum: np.ndarray, finer: int = 1) -> np.ndarray:
        """The history (n,) of a spectrum at samples that are so many times finer, after `POINTS` samples at rest."""
        count = finer * self.kept + POINTS
        growth = np.exp(self.rate * self.step / finer * np.arange(count))
        history = finer * np.fft.irfft(spectrum, finer * PADDED * self.kept)[:count] * growth
        return np.concatenate([np.zeros(POINTS), history])


class Histories:
    """The window of an incident wave, and samples of what follows from it, which are kept.

    Parameters
    ----------
    velocity : m/s at times in s, of the incident wave alone. begin : time (s) before which it is zero. until : last
    time (s); later ones double the window.
    """

    def __init__(self, velocity: Callable[[np.ndarray], np.ndarray], begin: float, until: float) -> None:
        self.begin = begin
        self._velocity, self._until = velocity, until
        self._found: dict[object, np.ndarray] = {}

    def reach(self, times: np.ndarray) -> None:
        """Make the window long enough for times, s; what was kept is gone if it is not."""
        while times.max(initial=self.begin) > self._until:
            self._until += self._until - self.begin
            self._found.clear()
            self.__dict__.pop("window", None)

    def kept(self, key: object, find: Callable[[], np.ndarray]) -> np.ndarray:
        """What was found once for a key and this window."""
        if key not in self._found:
            self._found[key] = find()
        return self._found[key]

    @cached_property
    def window(self) -> Window:
        """The samples of the incident wave."""
        length, count = self._until - self.begin, FEWEST
        while True:
            step, window = length / count, PADDED * count
            times = step * np.arange(window)
            fade = np.clip((times - length) / step - POINTS, 0.0, None) / (FADING * count)
            left = 1.0 - _risen(np.minimum(fade, 1.0))
            kept = left > 0.0
            rate = DECAY / (window * step)
            values = np.zeros(window)
            values[kept] = left[kept] * self._velocity(self.begin + times[kept]) * np.exp(-rate * times[kept])
            spectrum = np.fft.rfft(values)
            size = np.abs(spectrum)
            above = size[int(RATE * len(size)) :].max()
            if above <= FAINT * size.max() or count >= MOST:
                last = int(np.flatnonzero(size > NONE * size.max()).max(initial=0)) + 1
                frequencies = np.fft.rfftfreq(window, step)[:last] - 1j * rate / (2.0 * math.pi)
                return Window(count, step, rate, frequencies, spectrum[:last])
            count *= 2

    def between(self, samples: np.ndarray, times: np.ndarray) -> np.ndarray:
        """Values (k, d) at times (k,) s between samples (n, d), from `POINTS` of them."""
        places = (times - self.begin) / self.window.step
        first = np.floor(places).astype(np.int64) - POINTS // 2 + 1
        points = np.arange(POINTS)
        away = (places - first)[:, None] - points  # in steps, from each sample
        weights = np.ones(away.shape)
        for own in points:
            for other in points[points != own]:
                weights[:, own] *= away[:, other] / (own - other)
        rows = np.clip(first[:, None] + points + POINTS, 0, len(samples) - 1)
        return np.asarray(np.einsum("kj,kjd->kd", weights, samples[rows]))

    def by_slopes(self, samples: np.ndarray, slopes: np.ndarray, finer: int, times: np.ndarray) -> np.ndarray:
        """Values at times (any shape) s between fine samples (n,), from two of them and of their derivatives (n,).

        In a tenth of the time of `between`; with 32 fine samples in a period to 4e-6.
        """
        step = self.window.step / finer
        places = np.clip((times - self.begin) / step + POINTS, 0.0, len(samples) - 1.5)
        row = places.astype(np.int64)
        x = places - row
        left, right = samples[row], samples[row + 1]
        a, b = step * slopes[row] - (right - left), (right - left) - step * slopes[row + 1]
        return np.asarray(left + x * (right - left) + x * (1.0 - x) * ((1.0 - x) * a + x * b))


def _risen(x: np.ndarray) -> np.ndarray:
    """From 0 at 0 to 1 at 1 with three derivatives that are zero at both."""
    return np.asarray(x**4 * (35.0 - 84.0 * x + 70.0 * x**2 - 20.0 * x**3))
