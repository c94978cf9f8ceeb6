"""The exact motion of a bar at the monitors of the given case, for all its choices."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

from dembound.bar.scene import BarScene
from dembound.studies.estimate.bar_motions import FINER, Histories, Motions
from dembound.studies.estimate.window import Window

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline


class ExactMotion:
    """The motion of rods at the nodes of the monitors of a scene.

    The stress at the ends of the bar is that half a spacing of this scene inside.
    """

    def __init__(self, scene: BarScene) -> None:
        self._scene = scene
        self._found: dict[int, dict[str, dict[str, CubicSpline]]] = {}

    @cached_property
    def places(self) -> dict[str, float]:
        """Monitor -> m, the place of its node."""
        return {name: float(self._scene.positions[node, 0]) for name, node in self._scene.monitors.items()}

    def at(self, window: Window) -> Histories:
        """At the times of a window; computed once for all windows whose steps are between two powers of 2 s."""
        octave = math.floor(math.log2(window.step))
        if octave not in self._found:
            self._found[octave] = self._splines(2.0**octave)
        return {
            name: {quantity: spline(window.time) for quantity, spline in each.items()}
            for name, each in self._found[octave].items()
        }

    def _splines(self, step: float) -> dict[str, dict[str, CubicSpline]]:
        """For times of steps (s) of up to twice this length, of which the last may begin before the end of the run."""
        from scipy.interpolate import CubicSpline

        window = Window.up_to(self._scene.case.run.duration + 2.0 * step, step)
        time = window.finer(FINER).time
        found = Motions(self._scene.case, self._scene, window, dict.fromkeys(self.places, time)).exact()
        return {name: {q: CubicSpline(time, values) for q, values in each.items()} for name, each in found.items()}
