"""The exact motion of a bar under one pulse at its left end, which charts compare their choices with."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from dembound.accuracy.history import History, Motions, along
from dembound.accuracy.reference import Exact
from dembound.bar.kind import SPALL_PLACE, SPALL_TIME
from dembound.casefile.bar import BarCase
from dembound.exact.bar import End, bar_stress, bar_velocity, triangle_spall
from dembound.waves import Triangle, Wave


@dataclass(frozen=True)
class PulseInBar(Exact[BarCase]):
    """A pulse on the left end of a bar without attenuation, up to the first spall.

    pressure : Pa, factor of the wave; far_end : its type, which determines the reflection.
    """

    bar_length: float
    speed: float
    impedance: float
    pressure: float
    wave: Wave
    far_end: End
    until: float = math.inf
    findings: Mapping[str, float] = field(default_factory=dict)
    sentence: str = "exact (d'Alembert)"

    @classmethod
    def of(cls, case: BarCase) -> PulseInBar | None:
        """The solution of a case; None if it is another problem."""
        if case.bar.attenuation > 0.0 or len(case.load) != 1 or case.driving:
            return None
        if case.bar.range:
            return None
        load, far = case.load[0], case.side("right")
        end: End | None = "absorbing" if far.absorbs else "free" if far.is_free else None
        end = "fixed" if 0 in far.prescribed(0) else end
        if load.side != "left" or not case.side("left").is_free or end is None:
            return None
        bar, wave = case.bar, case.wave[load.wave]
        found = cls(bar.length, bar.speed, bar.density * bar.speed, load.pressure, wave, end)
        return found._until_it_breaks(bar.breaking_stretch * bar.modulus)

    def _until_it_breaks(self, strength: float) -> PulseInBar | None:
        """The solution up to the first spall, if the bar may break; None where its place has no closed form."""
        crest = abs(self.pressure) * self.wave.peak()
        if strength > crest:
            return self
        wave = self.wave
        if not isinstance(wave, Triangle) or self.far_end != "free" or self.pressure * wave.amplitude < 0.0:
            return None
        if self.speed * (wave.rise + wave.fall) > self.bar_length:
            return None
        place, at = triangle_spall(self.bar_length, self.speed, wave.rise, wave.fall, crest, strength)
        at += wave.start
        return replace(
            self,
            until=at,
            findings={SPALL_PLACE: place, SPALL_TIME: at},
            sentence=f"exact (d'Alembert), up to the first spall at {1e3 * at:.4g} ms",
        )

    def motions(self, case: BarCase, recorded: Motions) -> dict[str, History]:
        """The motion and stress at the nodes of the monitors, at the same times."""
        return {name: self._at(history) for name, history in recorded.items()}

    def _at(self, history: History) -> History:
        place = float(history.place[0])
        length, speed, impedance = self.bar_length, self.speed, self.impedance

        def pressure(time: np.ndarray) -> np.ndarray:
            return np.where(time >= 0.0, self.pressure * self.wave.velocity(time), 0.0)

        velocity = bar_velocity(place, history.time, pressure, length, speed, impedance, self.far_end)
        displacement = np.concatenate([[0.0], np.cumsum(0.5 * (velocity[1:] + velocity[:-1]) * np.diff(history.time))])
        stress = bar_stress(place, history.time, pressure, length, speed, self.far_end)
        return History.of(history.place, history.time, along(displacement, 0), along(velocity, 0), stress)
