"""Exact motions with which charts compare their choices: problems of this folder, plane waves, level layers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from dembound.accuracy.of_disks.exact import exact_motions, problem_of
from dembound.accuracy.of_disks.exact.problem import BEGINNING, must_be_continuous
from dembound.accuracy.reference import Exact
from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import OPPOSITE, SIDES, Motion, axis_of_motion, normal_axis
from dembound.casefile.disks.model import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.scene import build, ground_of
from dembound.exact.column import Column, ColumnMotion
from dembound.formulas.disks.waves import is_square_lattice, layers_of
from dembound.formulas.history import History, Motions, along
from dembound.schemas import with_changes


@dataclass(frozen=True)
class ExactContinuum(Exact[DiskCase]):
    """The exact motion of a problem of this folder, by the name of the problem.

    base : the given case. Sides beyond which its rock goes on are treated so for all choices: reflections of a free or
    fixed side there are errors of the choice.
    """

    base: DiskCase
    name: str
    sentence: str
    until: float

    @classmethod
    def of(cls, case: DiskCase) -> ExactContinuum:
        """The problem of a case; raises CaseError, with the reasons, if it is none."""
        problem = problem_of(build(case))
        return cls(case, problem.name, problem.sentence, min(problem.until.values(), default=math.inf))

    def motions(self, case: DiskCase, recorded: Motions) -> dict[str, History]:
        """The motion at the monitors' places; errors as of `exact_motions`."""
        _, motions = exact_motions(build(self._without_ends(case)), self.name)
        return {name: replace(motion, place=recorded[name].place) for name, motion in motions.items()}

    def _without_ends(self, case: DiskCase) -> DiskCase:
        """The case of a choice, with the sides of the base if it ends where the rock of the base goes on."""
        if not any(self.base.side(side).is_artificial and _ends(case.side(side)) for side in SIDES):
            return case
        return with_changes(case, {"boundary": {side: table.given() for side, table in self.base.boundary.items()}})


def _ends(side: Boundary) -> bool:
    """Whether the rock ends at a side, instead of going on or being repeated beyond."""
    return not (side.is_artificial or side.is_mirror or side.is_periodic)


@dataclass(frozen=True)
class ExactPlaneWave(Exact[DiskCase]):
    """A plane wave that enters at one side of a block of disks and leaves at the opposite one.

    It enters through the plane of the side, at once, and runs with the homogenised speed of the packing of each choice;
    on the opposite side it leaves without reflection, whatever side a choice has there.
    """

    side: str
    motion: Motion
    sentence: str = "exact plane wave at the homogenised speed, leaving without reflection"

    @classmethod
    def of(cls, case: DiskCase) -> ExactPlaneWave | None:
        """The solution of a case; None if it is another problem."""
        other = case.is_damped or len(case.layer) > 1
        if other or case.holes or case.load or case.static or len(case.driving) != 1:
            return None
        ((side, waves),) = case.driving.items()
        far = case.side(OPPOSITE[side])
        if case.side(side).is_interface or far.is_interface or case.joint or case.group:
            return None
        if len(waves) != 1 or not far.factors or far.waves or not LAWS[case.material.law].is_linear:
            return None
        ((motion, _),) = waves.items()
        return cls(side, motion) if all(_keeps_plane(case, side, motion)) else None

    def motions(self, case: DiskCase, recorded: Motions) -> dict[str, History]:
        """The wave at the monitors' particles, at the same times."""
        scene, axis = build(case), normal_axis(self.side)
        speed = scene.ground.wave_speeds(axis)[0 if self.motion == "p" else 1]
        start = scene.plane(self.side)
        wave, column = case.wave[case.driving[self.side][self.motion]], axis_of_motion(self.side, self.motion)
        found = {}
        for name, history in recorded.items():
            late = history.time - abs(float(history.place[axis]) - start) / speed
            moved, moving = (along(motion(late), column) for motion in (wave.displacement, wave.velocity))
            found[name] = History.of(history.place, history.time, moved, moving)
        return found


def _keeps_plane(case: DiskCase, side: str, motion: Motion) -> Iterator[bool]:
    """For each of the two sides along which a plane wave runs, whether the wave stays plane.

    Along free sides it does so on a square lattice only. Free edges of random packings are softer, even with rows of
    equal disks along them: they slow the wave in a strip 20 disks high by up to 2 %.
    """
    across = 1 - normal_axis(side)
    held = motion == "p" and "xy"[across] in case.motion.held
    for lateral in ("bottom", "top") if across == 1 else ("left", "right"):
        is_even = held and case.side(lateral).is_free and case.packing.is_lattice
        yield case.side(lateral).is_periodic or (is_even and is_square_lattice(ground_of(case)))


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
        if (
            len(case.layer) < 2
            or case.holes
            or case.joint
            or case.group
            or case.load
            or case.static
            or list(case.driving) != ["bottom"]
        ):
            return None
        bottom, top = case.side("bottom"), case.side("top")
        enters = (bottom.factors or bottom.is_outside) and not bottom.is_interface
        ends = not top.is_interface and (top.factors or top.is_free) and not top.waves
        if not (enters and ends and LAWS[case.material.law].is_linear and all(_keeps_level(case))):
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


def _keeps_level(case: DiskCase) -> Iterator[bool]:
    """For the left and the right side, whether waves from below stay plane."""
    for side in ("left", "right"):
        yield case.side(side).is_periodic or side in case.column_sides
