"""The exact motion of level layers under waves from below, which charts compare their choices with."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from dembound.accuracy.history import History, Motions
from dembound.accuracy.of_disks.exact.problem import BEGINNING, must_be_continuous
from dembound.accuracy.of_disks.layered_column import layers_of
from dembound.accuracy.reference import Exact
from dembound.boundaries import Motion, axis_of_motion
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.scene import build
from dembound.exact.column import Column
from dembound.exact.column_motion import ColumnMotion


@dataclass(frozen=True)
class ExactLayeredColumn(Exact[DiskCase]):
    """Plane waves that enter at the bottom of level layers, up to a free surface or out of an absorbing top.

    They enter through the plane of the bottom, at once, and run with the homogenised speeds of the packing of each
    choice in each layer; what comes back leaves at the bottom without reflection.
    """

    waves: Mapping[Motion, str]
    sentence: str = "exact plane waves in layers of the homogenised speeds, leaving at the bottom without reflection"

    @classmethod
    def of(cls, case: DiskCase) -> ExactLayeredColumn | None:
        """The solution of a case; None if it is another problem. Raises CaseError for a wave that jumps."""
        if len(case.layer) < 2 or case.hole or case.load or case.static or list(case.driving) != ["bottom"]:
            return None
        bottom, top = case.side("bottom"), case.side("top")
        enters = (bottom.factors or bottom.is_outside) and not bottom.is_interface
        ends = not top.is_interface and (top.factors or top.is_free) and not top.waves
        if not (enters and ends and LAWS[case.material.law].is_linear and all(_keeps_plane(case))):
            return None
        for name in bottom.waves.values():
            before = case.wave[name].begin() - BEGINNING * case.run.duration
            must_be_continuous(name, case.wave[name].velocity, before, case.run.duration)
        return cls(bottom.waves)

    def motions(self, case: DiskCase, recorded: Motions) -> dict[str, History]:
        """The motion at the monitors' particles, at the same times."""
        scene = build(case)
        plane, surface = scene.plane("bottom"), scene.plane("top")
        mass = None if case.side("top").factors else 0.0
        values = {name: np.zeros((2, len(own.time), 3)) for name, own in recorded.items()}
        for motion, wave in self.waves.items():
            signal, column = case.wave[wave], axis_of_motion("bottom", motion)
            span = signal.begin(), case.run.duration
            moving = ColumnMotion(Column(layers_of(scene, motion), mass=mass), signal.velocity, surface - plane, *span)
            for name, own in recorded.items():
                depth = (surface - float(own.place[1]),)
                values[name][0, :, column] = moving.at("displacement", own.time, depth)[:, 0]
                values[name][1, :, column] = moving.at("velocity", own.time, depth)[:, 0]
        return {name: History.of(own.place, own.time, *values[name]) for name, own in recorded.items()}


def _keeps_plane(case: DiskCase) -> Iterator[bool]:
    """For the left and the right side, whether waves from below stay plane."""
    for side in ("left", "right"):
        yield case.side(side).is_periodic or side in case.column_sides
