"""The time that companions of a case take, as counted, which is said before they run and has a limit."""

from __future__ import annotations

import math

from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.measured import OFTEN, runs_own, sides_with_rows
from dembound.accuracy.proposal import Watch
from dembound.disks.scene import DiskScene
from dembound.disks.step_cost import seconds_of
from dembound.errors import CaseError
from dembound.formulas.disks.held_sides import HeldSides
from dembound.words import with_unit

MOST = 20.0
"""CPU seconds that the companions of a case may take, as counted, if that is more than the case takes."""


def require_short(
    companions: Companions, own: float, longest: float | None, watch: Watch, then: str = "", command: str = ""
) -> None:
    """Say what companions are run; CaseError if they take longer than the case, a given limit, and `MOST`.

    own, longest : CPU seconds of the case, and of the option. then : what follows, for the line that is said; command :
    that has the option, if it is another one.
    """
    most, needed = max(MOST, own, longest or 0.0), seconds_of_all(companions)
    if needed > most:
        longer = f"more than {with_unit(most, 's', 2)}: {command}--longest {math.ceil(needed)} allows it"
        raise CaseError([f"companions of {companions.size} take about {with_unit(needed, 's', 2)}, {longer}"])
    watch.says(f"runs companions of {companions.size} and others of these sizes{then}")


def seconds_of_all(companions: Companions) -> float:
    """CPU seconds of all companions that the errors of the case itself need, as counted."""
    scene, first = companions.scene, [seconds_of(each, steps) for each, steps in companions.first]
    beside = {*HeldSides(scene).among_others, *sides_with_rows(companions, scene)}
    return sum(first) + len(beside) * max(first) + (_of_contacts(companions) if scene.has_history else 0.0)


def _of_contacts(companions: Companions) -> float:
    """CPU seconds of a run and of one with half its step, where contacts may open or slide."""
    own: tuple[DiskScene, float] = companions.scene, companions.case.run.duration / companions.time_step
    scene, steps = own if runs_own(companions) else companions.first[0]
    return OFTEN * seconds_of(scene, steps)
