"""Histories of monitors, and errors of waves that a grid, or steps in time, delay: by formula, from the motion itself.

A wave of the angular frequency ω on a grid comes late by τ(ω) = s(1/c(ω) − 1/c) on its way of s m, where c(ω) is its
phase speed there and c that of long waves. The exact motion is that of the record with this delay taken out, and the
error of the record is the difference.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from dembound.results.compare import at_times, largest_component

LEAST = {"velocity": 0.01, "displacement": 0.01, "stress": 0.1}
"""By quantity, the share of the largest peak of all monitors below which that of a monitor is next to nothing.

Relative errors there are those of a small residual, and do not count. Motion fades with distance, so little is left
out. A pulse keeps its stress along a bar, which falls only where physics makes it zero: at a free end. The node there
has it half a spacing Δx inside, where a pulse with a rise of the length L and its reflection leave Δx/L of the peak,
at most 0.1 on a grid with ten spacings along the rise.
"""


@dataclass(frozen=True)
class History:
    """The motion at one monitor.

    place : (2,) m, of its particle. time : (k,) s. values : quantity -> (k, c) in SI units: displacement and velocity
    along x, y and, where it is known, of rotation; stress along a bar (k, 1).
    """

    place: np.ndarray
    time: np.ndarray
    values: Mapping[str, np.ndarray]

    @classmethod
    def of(
        cls,
        place: np.ndarray,
        time: np.ndarray,
        displacement: np.ndarray,
        velocity: np.ndarray,
        stress: np.ndarray | None = None,
    ) -> History:
        """A history from displacement (k, c) m, rad, velocity (k, c) m/s, rad/s and, of bars, stress (k,) Pa."""
        along = {} if stress is None else {"stress": stress[:, None]}
        return cls(place, time, {"displacement": displacement, "velocity": velocity, **along})

    @property
    def displacement(self) -> np.ndarray:
        """Displacement (k, c) m, rad."""
        return self.values["displacement"]

    @property
    def velocity(self) -> np.ndarray:
        """Velocity (k, c) m/s, rad/s."""
        return self.values["velocity"]

    def component(self, quantity: str) -> int:
        """The column with the largest value, for which errors are computed; see `largest_component`."""
        return largest_component(self.values[quantity])

    def at(self, times: np.ndarray) -> History:
        """The motion interpolated at times (m,) s; constant before the first and after the last sample."""
        return History(
            self.place, times, {name: at_times(self.time, each, times) for name, each in self.values.items()}
        )

    def until(self, end: float) -> History:
        """The samples up to a time (s) and at it."""
        return self._part(self.time <= end)

    def before(self, end: float) -> History:
        """The samples before a time (s)."""
        return self._part(self.time < end)

    def _part(self, kept: np.ndarray) -> History:
        """The history with the samples kept (k,) bool; itself if all are kept."""
        if kept.all():
            return self
        return History(self.place, self.time[kept], {name: each[kept] for name, each in self.values.items()})


Motions = Mapping[str, History]
"""Histories by the name of their monitor."""


def loud(motions: Motions, quantity: str) -> list[str]:
    """Monitors at which a quantity is not negligible relative to the monitor with the largest one."""
    recorded = {name: each.values[quantity] for name, each in motions.items() if quantity in each.values}
    peaks = {name: float(np.abs(values).max(initial=0.0)) for name, values in recorded.items()}
    return loud_of(peaks, LEAST[quantity])


def loud_of(peaks: Mapping[str, float], least: float) -> list[str]:
    """Monitors whose peak is at least this share of the largest peak of all monitors."""
    return [name for name, peak in peaks.items() if peak >= least * max(peaks.values())]


def earlier(motions: Motions, by: float) -> Motions:
    """Motions shifted to earlier times by `by` s (to later ones if negative); unchanged for 0."""
    if by == 0.0:
        return motions
    return {name: replace(each, time=each.time - by) for name, each in motions.items()}


def along(values: np.ndarray, column: int) -> np.ndarray:
    """Motion (k, 3) with these values (k,) in one column and zero elsewhere."""
    motion = np.zeros((len(values), 3))
    motion[:, column] = values
    return motion


Delay = Callable[[np.ndarray], np.ndarray]
"""Returns delays (k,) s at angular frequencies (k,) rad/s."""


def error_of_delay(time: np.ndarray, velocity: np.ndarray, delay: Delay) -> tuple[np.ndarray, np.ndarray]:
    """Errors that a delay adds to a recorded velocity (k, c) m/s and its displacement (k, c) m, at even times (k,) s.

    Frequencies at which no wave runs, whose delay is nan, count as an error of 100 %.
    """
    step = float(time[1] - time[0]) if len(time) > 1 else 1.0
    count = len(time)
    padded = np.concatenate([velocity, going_on(velocity)])
    length = 2 ** int(np.ceil(np.log2(2 * len(padded))))
    omega = 2.0 * np.pi * np.fft.rfftfreq(length, step)
    phase = np.exp(1j * omega * np.nan_to_num(delay(omega)))
    phase[~np.isfinite(delay(omega))] = 0.0
    spectrum = np.fft.rfft(padded, length, axis=0)
    error = np.fft.irfft(spectrum * (1.0 - phase)[:, None], length, axis=0)[:count]
    displacement = step * (np.cumsum(error, axis=0) - 0.5 * (error + error[0]))
    return error, displacement


def error_of_steps(time: np.ndarray, velocity: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Errors that central differences with a step (s) add to a velocity (k, c) m/s and its displacement (k, c) m.

    time : even times (k,) s. The steps move the body as it would move at the frequency ω̂ = (2/Δt) sin(ωΔt/2); the
    recorded velocity is the mean of two half steps, cos(ωΔt/2) iω̂u. Waves keep the amplitude of iω̂u, so that the
    velocity is too small by (ωΔt)²/8, and the displacement too large by (ωΔt)²/24.
    """
    if len(time) < 2:
        return np.zeros_like(velocity), np.zeros_like(velocity)
    acceleration = np.gradient(velocity, time, axis=0)
    return step**2 / 8.0 * np.gradient(acceleration, time, axis=0), -(step**2) / 24.0 * acceleration


def going_on(values: np.ndarray) -> np.ndarray:
    """Continuation (k - 1, c) of values (k, c) that end within a wave: same slope at first, then fading to zero.

    The values turned about the last one, times a polynomial that falls from 1 to 0 without slope and curvature at its
    ends. Corners would add high frequencies that no wave of the record has, whose long delays would enter the record.
    """
    turned = 2.0 * values[-1] - values[-2::-1]
    s = np.arange(1, len(values)) / len(values)
    fading = 1.0 - s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
    return np.asarray(fading[:, None] * turned)


def part_above(
    time: np.ndarray, velocity: np.ndarray, least: float, power: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """A velocity (k,) at even times (k,) s with its spectrum times ω^power, and its part above `least` rad/s."""
    padded = np.concatenate([velocity, going_on(velocity[:, None])[:, 0]])
    length = 2 ** int(np.ceil(np.log2(2 * len(padded))))
    omega = 2.0 * np.pi * np.fft.rfftfreq(length, float(time[1] - time[0]))
    spectrum = np.fft.rfft(padded, length) * omega**power
    whole, above = (np.fft.irfft(each, length)[: len(time)] for each in (spectrum, spectrum * (omega > least)))
    return np.asarray(whole), np.asarray(above)
