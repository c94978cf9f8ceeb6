"""The exact motion of a bar at the monitors of a case, also under one pulse."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dembound.accuracy.of_bars.options import FACTORS
from dembound.accuracy.reference import Exact
from dembound.bar.body import ROUNDING
from dembound.bar.layers import ENDS
from dembound.bar.scene import BarScene
from dembound.bar.stability import own_step
from dembound.casefile.bar.model import BarCase
from dembound.exact.bar import End, bar_stress, bar_velocity, triangle_spall
from dembound.formulas.bars.motions import FINER, BarMotions, places_of
from dembound.formulas.bars.rods import Window
from dembound.formulas.cause import QUANTITIES
from dembound.formulas.history import LEAST, History, Motions, along
from dembound.kinds.bar.kind import SPALL_PLACE, SPALL_TIME
from dembound.waves.triangle import Triangle
from dembound.waves.wave import Wave

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline


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


CLEARLY = 2.0
"""Largest motion of a monitor that surely counts, over the smallest that does."""


class ExactMotion:
    """The motion of rods at the places of the monitors of a scene's case.

    The stress at the ends of the bar is taken half a spacing of this scene inside.
    """

    def __init__(self, scene: BarScene) -> None:
        self._scene = scene
        self._found: dict[int, dict[str, dict[str, CubicSpline]]] = {}

    @cached_property
    def step(self) -> float:
        """The time step (s) of the case."""
        return own_step(self._scene, self._scene.step_limit())

    @cached_property
    def places(self) -> dict[str, float]:
        """Monitor -> its place in the case, m, which need not be at a node."""
        return places_of(self._scene.case)

    def at(self, window: Window) -> Motions:
        """The motions at the times of a window; computed once for all steps between two powers of 2 s."""
        octave = math.floor(math.log2(window.step))
        if octave not in self._found:
            self._found[octave] = self._splines(2.0**octave)
        return {
            name: History(
                np.array([self.places[name], 0.0]),
                window.time,
                {quantity: spline(window.time) for quantity, spline in each.items()},
            )
            for name, each in self._found[octave].items()
        }

    def surely_counted(self, window: Window) -> dict[str, set[str]]:
        """By monitor the quantities that count for all choices.

        Nearly negligible quantities are left out, and stresses that some choices record at end nodes.
        """
        motion, found = self.at(window), {name: set[str]() for name in self.places}
        for quantity in QUANTITIES:
            peaks = {name: float(np.abs(each.values[quantity]).max()) for name, each in motion.items()}
            for name, peak in peaks.items():
                if peak > CLEARLY * LEAST[quantity] * max(peaks.values()) and (
                    quantity != "stress" or self._inside(name)
                ):
                    found[name].add(quantity)
        return found

    def _inside(self, name: str) -> bool:
        """Whether the node of a monitor is no end node with any spacing that is tried."""
        rod, place = self._scene.rod, self.places[name]
        away = {"left": place, "right": rod.ranges[-1].end - place}
        reach = 0.5 * max(FACTORS) * (1.0 + ROUNDING)
        return all(away[side] > reach * rod.end(side).spacing for side in ENDS)

    def _splines(self, step: float) -> dict[str, dict[str, CubicSpline]]:
        """Splines of the motions for steps (s) of up to twice this length; the last may begin before the end."""
        from scipy.interpolate import CubicSpline

        window = Window.up_to(self._scene.case.run.duration + 2.0 * step, step)
        time = window.finer(FINER).time
        found = BarMotions(self._scene.case, self._scene, window, dict.fromkeys(self.places, time)).exact(self.places)
        return {
            name: {q: CubicSpline(time, values) for q, values in each.values.items()} for name, each in found.items()
        }
