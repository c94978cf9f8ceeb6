"""The exact motion of a bar at the monitors of the given case, for all its choices."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from dembound.accuracy.cause import QUANTITIES
from dembound.accuracy.history import LEAST, History, Motions
from dembound.accuracy.of_bars.motions import FINER, BarMotions, places_of
from dembound.accuracy.of_bars.options import FACTORS
from dembound.accuracy.of_bars.window import Window
from dembound.bar.banded import ROUNDING
from dembound.bar.layers import ENDS
from dembound.bar.scene import BarScene
from dembound.bar.stability import own_step

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

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
