"""The base of all waves, of those given by a formula, and of those of straight lines between points."""

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, ClassVar, Literal, Self

import numpy as np
from pydantic import AfterValidator, model_validator

from dembound.spectra import PADDING, fourier_spectrum
from dembound.table import Table, quantity

FADED = 0.01
"""Share of its largest value below which an amplitude spectrum is treated as faded."""

HANN_FADE = 2.0 / math.sqrt(3.0) * math.cosh(math.acosh(1.5 * math.sqrt(3.0) / (math.pi * FADED)) / 3.0)
"""Frequency times length at which the spectrum of one Hann lobe, ½(1 − cos 2πt/T) on 0…T, has faded: 3.274.

The spectrum is T/2 · sin(πx)/[πx(1 − x²)], x = fT. Its envelope has faded where x³ − x = 1/(π · FADED), which
Cardano's formula solves.
"""


def amplitude_spectrum(velocities: np.ndarray, time_step: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (m,), Hz, and amplitudes (m,), m, of velocities (n,), m/s, sampled every `time_step` s."""
    frequencies, spectrum = fourier_spectrum(velocities, time_step, PADDING * len(velocities))
    return frequencies, np.abs(spectrum)


def faded_frequency(frequencies: np.ndarray, amplitudes: np.ndarray) -> float:
    """First frequency, Hz, from which all amplitudes are faded; the last one if they never are."""
    last_alive = int(np.flatnonzero(amplitudes >= FADED * amplitudes.max())[-1])
    return float(frequencies[min(last_alive + 1, len(frequencies) - 1)])


@dataclass(frozen=True, eq=False)
class Polyline:
    """Values (k,) at increasing times (k,), s, joined by straight lines and zero outside."""

    times: np.ndarray
    values: np.ndarray

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Polyline)
            and np.array_equal(self.times, other.times)
            and np.array_equal(self.values, other.values)
        )

    __hash__ = None  # type: ignore[assignment]

    def at(self, t: np.ndarray) -> np.ndarray:
        """Values at the times t, s; same shape as t."""
        return np.interp(t, self.times, self.values, left=0.0, right=0.0)

    def integral(self, t: np.ndarray) -> np.ndarray:
        """Exact integral from −∞ to the times t, s; same shape as t, unit of the values times s."""
        times, values = self.times, self.values
        inside = np.clip(t, times[0], times[-1])
        left = np.clip(np.searchsorted(times, inside, side="right") - 1, 0, len(times) - 2)
        mean = 0.5 * (values[left] + np.interp(inside, times, values))
        whole: np.ndarray = self._integral_at_points[left] + mean * (inside - times[left])
        return whole

    @cached_property
    def _integral_at_points(self) -> np.ndarray:
        areas = 0.5 * (self.values[1:] + self.values[:-1]) * np.diff(self.times)
        return np.concatenate([[0.0], np.cumsum(areas)])


LATEST = 1e12
"""Largest time over the scale on which a wave varies: doubles then keep its times to 2e-4 of that scale."""


def _not_zero(value: float) -> float:
    if value == 0.0:
        raise ValueError("is 0, must not be 0")
    return value


NonZero = Annotated[float, AfterValidator(_not_zero)]
"""A number of either sign, but not zero."""


class Wave(Table, ABC):
    """A velocity history, zero before `start`; as the factor of a load its values are pure numbers.

    Of an outcrop half enters.

    Attributes
    ----------
    stays : whether the velocity remains constant in the end.
    halves : whether the type multiplies its history by `share`.
    """

    stays: ClassVar[bool] = False
    halves: ClassVar[bool] = False

    type: str
    start: float = quantity(0.0, unit="s", ge=0.0)
    """time at which the wave begins"""
    motion: Literal["incident", "outcrop", "within"] | None = quantity(None)
    """what moves so: the "incident" wave; a free "outcrop" of the rock; the ground at the side, "within"; absent:
    incident, at sides of prescribed velocity within"""

    @property
    def share(self) -> float:
        """Incident wave over the history: ½ for an outcrop, whose free surface doubles it, else 1."""
        return 0.5 if self.motion == "outcrop" else 1.0

    @abstractmethod
    def velocity(self, t: np.ndarray) -> np.ndarray:
        """Particle velocity, m/s, at the times t, s; same shape as t."""

    @abstractmethod
    def displacement(self, t: np.ndarray) -> np.ndarray:
        """Exact time integral of the velocity from −∞ to t, m; same shape as t."""

    @abstractmethod
    def peak(self) -> float:
        """Largest |velocity| ever reached, m/s."""

    @abstractmethod
    def peak_time(self) -> float:
        """First time at which |velocity| is `peak`, s, counted from t = 0 like `start`."""

    @abstractmethod
    def duration(self) -> float:
        """Time from which the wave is over, s, counted from t = 0; infinite if it never is."""

    @abstractmethod
    def dominant_frequency(self) -> float:
        """The frequency that characterises the wave, Hz; see each type."""

    @abstractmethod
    def highest_frequency(self) -> float:
        """Frequency above which the amplitude spectrum stays below 1 % of its largest value, Hz.

        Particle spacing and time step must resolve this frequency. The spectrum is that of the velocity unless the type
        defines it otherwise.
        """

    def begin(self) -> float:
        """Time (s) before which the velocity is zero, counted from t = 0 like `start`."""
        return self.start

    def ends(self) -> tuple[tuple[str, float, float], ...]:
        """Ends of a history of samples, where it may jump: "begins" or "ends", time (s), velocity (m/s); else none."""
        return ()

    def doubts(self, read: str, factor: float) -> Iterator[str]:
        """Probable errors of a measured history, in words; by default none.

        read : unit of its values times the factor: m/s at a side, with factor 1; for a load the load's, such as Pa.
        """
        return iter(())

    def joined(self) -> str:
        """What joins the samples of a history, in words; empty for a formula."""
        return ""

    def describe(self) -> dict[str, str | float]:
        """What was chosen for a history of samples, as plain JSON values; by default nothing."""
        return {}

    def dominant_period(self) -> float:
        """One over the dominant frequency, s; 0 for a step, infinite where nothing oscillates."""
        frequency = self.dominant_frequency()
        return 1.0 / frequency if frequency > 0.0 else math.inf

    def time_scale(self) -> float:
        """Time (s) that characterises how fast the wave varies; by default its period."""
        return self.dominant_period()

    def _require_resolved(self, latest: float, scale: float, key: str) -> None:
        """Raise ValueError for a time (s) at which rounding loses changes on a scale (s).

        key : named in the message.
        """
        if latest > LATEST * scale > 0.0:
            most = f"must be at most {LATEST:g} times the {scale:g} s within which the wave varies"
            raise ValueError(f"{key} is {latest:g}, {most}, or rounding changes it")

    def moved(self, here: Path, there: Path) -> dict[str, str]:
        """Keys with paths relative to the folder `here`, with the corresponding paths in `there`; by default none."""
        return {}

    def files(self) -> dict[str, str]:
        """Texts of the files that the wave was read from, by their paths in the case; by default none."""
        return {}


class Shape(Wave):
    """A wave given by a formula: `amplitude` times a shape whose argument is the time since `start`."""

    halves: ClassVar[bool] = True

    amplitude: NonZero = quantity(unit="m/s", means="velocity")
    """factor M of the shape, of either sign; not 0"""

    @model_validator(mode="after")
    def _resolved(self) -> Self:
        self._require_resolved(self.start, self.time_scale(), "start:")
        return self

    def velocity(self, t: np.ndarray) -> np.ndarray:
        """Particle velocity, m/s, at the times t, s; same shape as t."""
        return self.share * self.amplitude * self._velocity_shape(np.asarray(t, dtype=float) - self.start)

    def displacement(self, t: np.ndarray) -> np.ndarray:
        """Exact time integral of the velocity from −∞ to t, m; same shape as t."""
        return self.share * self.amplitude * self._displacement_shape(np.asarray(t, dtype=float) - self.start)

    def peak(self) -> float:
        """Largest |velocity|, m/s: the amplitude's size, as the shapes reach 1."""
        return self.share * abs(self.amplitude)

    @abstractmethod
    def _velocity_shape(self, since: np.ndarray) -> np.ndarray:
        """Velocity for unit amplitude, at times since the start, s."""

    @abstractmethod
    def _displacement_shape(self, since: np.ndarray) -> np.ndarray:
        """Integral of the velocity shape, s, at times since the start, s."""


class Pulse(Shape):
    """One smooth one-sided pulse whose length is a period, with its crest in the middle."""

    period: float = quantity(unit="s", means="period", gt=0.0)
    """length T of the pulse"""

    def peak_time(self) -> float:
        """Time of the crest, half a period after the start, s."""
        return self.start + 0.5 * self.period

    def duration(self) -> float:
        """Time from which the wave is over, s: one period after the start."""
        return self.start + self.period

    def dominant_frequency(self) -> float:
        """1/T, Hz; the spectrum of a one-sided pulse is largest at zero, and falls to its first zero at 2/T or 4/T."""
        return 1.0 / self.period
