"""Histories from transforms at complex frequencies: a damped discrete Fourier transform, as in exact/transform.py.

The window W is `LONGER` times as long as the history; motion after it aliases to its beginning multiplied by e^{−ηW}.
Signals fade out beyond the history, so that they do not jump there.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from dembound.boundaries.signals import Signal

LONGER = 2.0
"""Length of the window over that of the history."""

DAMPING = math.log(1e6)
"""ηW; what rounding, and delays by parts of a step, leave at the end of the window grows by e^{ηW/2} = 1000."""

LEFT_OUT = 1e-16
"""Part of the energy of the signals that the highest frequencies may have that are left out: 1e-8 of the motion."""


@dataclass(frozen=True)
class Window:
    """Times nΔt up to the end of a history.

    step : Δt, s. steps : up to the end. samples : in the window.
    """

    step: float
    steps: int
    samples: int

    @classmethod
    def up_to(cls, last: float, step: float) -> Window:
        """Times up to one (s), or to the next step after it."""
        from scipy.fft import next_fast_len

        steps = max(1, math.ceil(last / step - 1e-9))
        return cls(step, steps, int(next_fast_len(math.ceil(LONGER * steps) + 16, real=True)))

    def finer(self, times: int) -> Window:
        """The window with `times` as many samples in the same time."""
        return Window(self.step / times, self.steps * times, self.samples * times)

    @property
    def time(self) -> np.ndarray:
        """Times (steps + 1,) s."""
        return self.step * np.arange(self.steps + 1)

    @property
    def rate(self) -> float:
        """Damping rate η, 1/s."""
        return DAMPING / (self.samples * self.step)

    @property
    def s(self) -> np.ndarray:
        """All complex frequencies (f,) rad/s."""
        return self.rate + 2j * math.pi * np.fft.rfftfreq(self.samples, self.step)

    def transform(self, signal: Signal, ahead: float = 0.0) -> np.ndarray:
        """Sum of the values of a signal times e^{−st}, (f,); ahead : s, by which it is sampled later."""
        time = self.step * np.arange(self.samples)
        after = np.clip((np.arange(self.samples) - self.steps) / (0.5 * (self.samples - self.steps)), 0.0, 1.0)
        values = np.asarray(signal(time + ahead)) * 0.5 * (1.0 + np.cos(np.pi * after))
        return np.fft.rfft(values * np.exp(-self.rate * time))

    def history(self, transform: np.ndarray) -> np.ndarray:
        """Values at all nΔt up to the end (steps + 1,), from a transform at the lowest frequencies."""
        values = np.fft.irfft(np.pad(transform, (0, self.samples // 2 + 1 - len(transform))), self.samples)
        kept = slice(0, self.steps + 1)
        grown: np.ndarray = values[kept] * np.exp(self.rate * self.time)
        return grown


def needed(transforms: list[np.ndarray]) -> int:
    """How many of the frequencies (f,), from the lowest on, represent these signals; at least one."""
    most = 1
    for values in transforms:
        energy = np.cumsum(np.abs(values[::-1]) ** 2)[::-1]
        most = max(most, int(np.count_nonzero(energy > LEFT_OUT * energy[0])))
    return most
