"""The bar without nodes and steps, at single frequencies, and histories from transforms at complex frequencies."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.boundaries.support import Signal
from dembound.casefile.bar.model import BarCase
from dembound.formulas.bars.chain import Link, velocities
from dembound.methods.rod import Range, Rod

RIGID = 1e12
"""Dashpot at an end whose velocity is prescribed, over the impedance of the rod."""

EQUAL = 1e-9
"""Distance of places that are one, over the length of the bar."""


@dataclass(frozen=True)
class Rods:
    """A bar of bonded ranges, cut at its ends, its interfaces and given places.

    places : (k,) m. s : (f,) rad/s.
    """

    case: BarCase
    rod: Rod
    places: np.ndarray
    s: np.ndarray

    @cached_property
    def cuts(self) -> np.ndarray:
        """All places (q,) m at which the bar is cut, from end to end."""
        end = self.rod.ranges[-1].end
        cuts = np.unique([*self.places, *(part.start for part in self.rod.ranges), end])
        return cuts[np.concatenate([[True], np.diff(cuts) > EQUAL * end])]

    @cached_property
    def parts(self) -> list[Range]:
        """The range between each cut and the next one (q − 1)."""
        middles = 0.5 * (self.cuts[1:] + self.cuts[:-1])
        return [next(part for part in self.rod.ranges if place <= part.end) for place in middles]

    @cached_property
    def links(self) -> list[Link]:
        """The link between each cut and the next one (q − 1)."""
        return [self._link(part, length) for part, length in zip(self.parts, np.diff(self.cuts), strict=True)]

    def motion(
        self, forces: Mapping[str, np.ndarray], waves: Mapping[str, np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Velocities (f, k) m/s and stresses (f, k) Pa, tension positive, at the places.

        forces : by side (f,) N to the right on ends. waves : by side (f,) m/s, the velocity of the wave that enters at
        an end, or the prescribed velocity of an end.
        """
        own = [np.zeros((len(self.s), 1, 1), dtype=complex) for _ in self.cuts]
        force = np.zeros((len(self.s), len(self.cuts), 1), dtype=complex)
        for side, k in (("left", 0), ("right", -1)):
            impedance, end = self._impedance(self.rod.end(side)), self.case.side(side)
            force[:, k, 0] += forces.get(side, 0.0)
            if end.is_artificial:
                own[k][:, 0, 0] = impedance
                force[:, k, 0] += 2.0 * impedance * waves.get(side, 0.0)
            elif 0 in end.prescribed(0):
                own[k][:, 0, 0] = RIGID * impedance
                force[:, k, 0] = RIGID * impedance * waves.get(side, 0.0)
        moved = velocities(own, self.links, force)[:, :, 0]
        stress = np.stack([self._stress(moved, k) for k in range(len(self.cuts))], axis=1)
        nearest = np.abs(self.cuts - self.places[:, None]).argmin(axis=1)
        return moved[:, nearest], stress[:, nearest]

    def _stress(self, moved: np.ndarray, k: int) -> np.ndarray:
        """Stress (f,) at a cut; between different sections the force over the mean section."""
        section = np.mean([part.section for part in self.parts[max(0, k - 1) : k + 1]])
        if k < len(self.links):
            link = self.links[k]
            force = -(link.a[:, 0, 0] * moved[:, k] + link.b[:, 0, 0] * moved[:, k + 1])
        else:
            link = self.links[-1]
            force = link.c[:, 0, 0] * moved[:, k - 1] + link.d[:, 0, 0] * moved[:, k]
        return np.asarray(force / section)

    def _impedance(self, part: Range) -> np.ndarray:
        """Impedance Z (f,) N·s/m of a range."""
        return part.density * part.section * part.speed * self._root(part)

    def _root(self, part: Range) -> np.ndarray:
        return np.sqrt(1.0 + part.drag_rate / self.s)

    def _link(self, part: Range, length: float) -> Link:
        """The link of a rod of a length (m)."""
        way, impedance = self.s * self._root(part) * (length / part.speed), self._impedance(part)
        faded = -np.expm1(-2.0 * way)
        diagonal = (impedance * (2.0 - faded) / faded)[:, None, None]
        across = (-2.0 * impedance * np.exp(-way) / faded)[:, None, None]
        return Link(diagonal, across, across, diagonal)


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
