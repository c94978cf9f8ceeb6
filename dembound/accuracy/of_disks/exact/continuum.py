"""Exact motion of the problems of this folder, which charts compare their choices with."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from dembound.accuracy.history import History, Motions
from dembound.accuracy.of_disks.exact import exact_motions, problem_of
from dembound.accuracy.reference import Exact
from dembound.boundaries import SIDES
from dembound.boundaries.boundary import Boundary
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import build
from dembound.kinds import with_changes


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
