"""Errors of a case of any kind, and the cheapest choices with smaller errors."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

from dembound.accuracy.choice import value_at
from dembound.accuracy.judges import judge_of
from dembound.accuracy.proposal import Advice
from dembound.accuracy.watch import Watch
from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.formulas.cause import Truth
from dembound.motion.clock import Clock

BOUNDS = (0.1, 0.03, 0.01, 0.003)
"""Errors for which the cheapest choices are found where none is asked for."""


def advise(
    case: Case,
    bounds: Sequence[float] = BOUNDS,
    of: Truth | None = None,
    kept: Sequence[str] = (),
    seeds: int = 1,
    longest: float | None = None,
    watch: Watch | None = None,
) -> Advice:
    """The errors of a case, and for every bound the cheapest choice that keeps it, or else the most accurate choice.

    bounds : errors, RMS over RMS, such as 0.01, of velocity and displacement (of bars also stress) at all monitors
    whose motion is not negligible. of : "disks": errors relative to the disks as the material; "rock": relative to the
    rock that they discretise; None: "disks" where packings are random or bonds may break. kept : dotted keys whose
    values do not change, such as ``packing.radius`` or ``boundary``. seeds : number of random packings run to find the
    scatter between packings. longest : CPU seconds that the steps of a choice may take; by default 60 for disks, for
    bars 64 times the CPU seconds of the case. watch : told of what is done, and of what is
    known before all is.

    Raises CaseError for cases without monitors, without motion at them, or whose errors are not known, for a bound that
    is not a positive number and for unknown keys; the errors of building a scene and of running companions.
    """
    for bound in bounds:
        if not 0.0 < bound < 1.0:
            raise CaseError([f"--error: is {bound:g}, must be above 0 and below 1, such as 1% or 0.01"])
    if not case.monitor:
        raise CaseError(["advise: needs a monitor, at which errors are known; give a [[monitor]]"], case.name)
    for key in kept:
        value_at(case, key)
    judge, clock = judge_of(case), Clock(time.process_time)
    with clock.with_compiling(), clock.of("advise"):
        found = judge.advise(case, bounds, of or judge.truth(case), kept, longest, seeds, watch or Watch())
    return replace(found, cpu_seconds=clock.seconds["advise"])
