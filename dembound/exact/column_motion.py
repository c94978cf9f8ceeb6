"""The motion in time of a column of layers under an incident wave, at any depths and times.

The velocity v of the incident wave is sampled from where it begins, and fades beyond the last time that is asked for.
With e^{−εt} v(t), which decays within the window, its Fourier transform is that at the frequencies ω − iε, and so is
the column's: what comes round again is `column.DECAY` times smaller. Times between samples are interpolated.
"""

import math
from collections.abc import Callable
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np

from dembound.exact.column import DECAY, PADDED, Column

Quantity = Literal["displacement", "velocity", "gradient", "rate", "traction", "impulse", "relaxed", "relaxed_rate"]
"""u m, v m/s, ∂u/∂y, ∂v/∂y 1/s, with y upwards, and on planes facing up the traction, Pa, and its integral, Pa·s.

relaxed, relaxed_rate : u and v under which the unrelaxed springs of a layer have the forces of the damped ones."""

QUANTITIES: dict[Quantity, tuple[int, int]] = {
    "displacement": (0, 0),
    "velocity": (0, 1),
    "gradient": (1, 0),
    "rate": (1, 1),
    "traction": (2, 0),
    "impulse": (2, -1),
    "relaxed": (0, 0),
    "relaxed_rate": (0, 1),
}
"""Row of `Column.motion`, and number of derivatives in time."""

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


class _Window(NamedTuple):
    """Samples of a wave: how many up to the last time, step, s, and rate ε, 1/s; frequencies, Hz, and spectrum."""

    kept: int
    step: float
    rate: float
    frequencies: np.ndarray
    spectrum: np.ndarray


class ColumnMotion:
    """The motion of a column.

    Parameters
    ----------
    column : its layers. velocity : m/s at times in s, of the incident wave alone at a depth, m, in its half-space or
    continued from there; or if `within` of the column at this depth. begin : time (s) before which it is zero. until :
    last time (s); later ones double the window.
    """

    def __init__(
        self,
        column: Column,
        velocity: Callable[[np.ndarray], np.ndarray],
        depth: float,
        begin: float,
        until: float,
        within: bool = False,
    ) -> None:
        self._column, self._velocity, self._begin, self._until = column, velocity, begin, until
        self._depth, self._within = depth, within
        self._found: dict[tuple[Quantity, tuple[float, ...], int | None], np.ndarray] = {}

    def at(self, of: Quantity, times: np.ndarray, depths: tuple[float, ...], number: int | None = None) -> np.ndarray:
        """A quantity (k, d) at times (k,) s and depths (d,) m; number : of the layer, see `Column.motion`."""
        while times.max(initial=self._begin) > self._until:
            self._until += self._until - self._begin
            self._found.clear()
            self.__dict__.pop("_window", None)
        key = of, depths, number
        if key not in self._found:
            self._found[key] = self._sampled(*key)
        samples, places = self._found[key], (times - self._begin) / self._window.step
        first = np.floor(places).astype(np.int64) - POINTS // 2 + 1
        points = np.arange(POINTS)
        away = (places - first)[:, None] - points  # in steps, from each sample
        weights = np.ones(away.shape)
        for own in points:
            for other in points[points != own]:
                weights[:, own] *= away[:, other] / (own - other)
        rows = np.clip(first[:, None] + points + POINTS, 0, len(samples) - 1)
        return np.asarray(np.einsum("kj,kjd->kd", weights, samples[rows]))

    @cached_property
    def _window(self) -> _Window:
        """The samples of the incident wave."""
        length, count = self._until - self._begin, FEWEST
        while True:
            step, window = length / count, PADDED * count
            times = step * np.arange(window)
            fade = np.clip((times - length) / step - POINTS, 0.0, None) / (FADING * count)
            left = 1.0 - _risen(np.minimum(fade, 1.0))
            kept = left > 0.0
            rate = DECAY / (window * step)
            values = np.zeros(window)
            values[kept] = left[kept] * self._velocity(self._begin + times[kept]) * np.exp(-rate * times[kept])
            spectrum = np.fft.rfft(values)
            size = np.abs(spectrum)
            above = size[int(RATE * len(size)) :].max()
            if above <= FAINT * size.max() or count >= MOST:
                last = int(np.flatnonzero(size > NONE * size.max()).max(initial=0)) + 1
                frequencies = np.fft.rfftfreq(window, step)[:last] - 1j * rate / (2.0 * math.pi)
                return _Window(count, step, rate, frequencies, spectrum[:last])
            count *= 2

    def _sampled(self, of: Quantity, depths: tuple[float, ...], number: int | None) -> np.ndarray:
        """A quantity (n, d) at all samples, after `POINTS` samples at rest."""
        window, (row, derivatives) = self._window, QUANTITIES[of]
        incident = window.spectrum * (2j * math.pi * window.frequencies) ** (derivatives - 1)
        if self._within:
            incident = incident / self._column.motion(window.frequencies, [self._depth])[0, 0]
        else:
            incident = incident / self._column.rising(window.frequencies, self._depth)
        count = window.kept + POINTS
        growth = np.exp(window.rate * window.step * np.arange(count))
        found = np.zeros((count + POINTS, len(depths)))
        for place, depth in enumerate(depths):
            own = self._column.motion(window.frequencies, [depth], number)[row, 0]
            if of in ("relaxed", "relaxed_rate") and number is not None:
                own = own * self._column.layers[number].relaxation(window.frequencies)
            found[POINTS:, place] = np.fft.irfft(incident * own, PADDED * window.kept)[:count] * growth
        return found


def _risen(x: np.ndarray) -> np.ndarray:
    """From 0 at 0 to 1 at 1 with three derivatives that are zero at both."""
    return np.asarray(x**4 * (35.0 - 84.0 * x + 70.0 * x**2 - 20.0 * x**3))
