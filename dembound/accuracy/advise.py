"""Errors of a case of any kind, and the cheapest choices with smaller errors."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

from dembound.accuracy.choice import value_at
from dembound.accuracy.judge import Advice, Proposal, Receiver
from dembound.accuracy.judges import judge_of
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
    receiver: Receiver | None = None,
) -> Advice:
    """The errors of a case, and for every bound the cheapest choice that keeps it, or else the most accurate choice.

    bounds : errors, RMS over RMS, such as 0.01, of velocity and displacement (of bars also stress) at all monitors
    whose motion is not negligible. of : "disks": errors relative to the disks as the material; "rock": relative to the
    rock that they discretise; None: "disks" where packings are random or bonds may break. kept : dotted keys whose
    values do not change, such as ``packing.radius`` or ``boundary``. seeds : number of random packings run to find the
    scatter between packings. longest : CPU seconds that the steps of a choice may take; by default 60 for disks, for
    bars 64 times the CPU seconds of the case. receiver : of what is known before all is.

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
    judge, receiver = judge_of(case), receiver or Receiver()
    packings = _WithPackings(case, seeds, receiver)
    clock = Clock(time.process_time)
    with clock.with_compiling(), clock.of("advise"):
        found = judge.advise(case, bounds, of or judge.truth(case), kept, longest, packings if seeds > 1 else receiver)
    return replace(found, given=packings.proposal or found.given, cpu_seconds=clock.seconds["advise"])


class _WithPackings(Receiver):
    """Passes on what is known, the errors of the case with the scatter between random packings.

    Attributes
    ----------
    proposal : the case with this error, once it is known.
    """

    def __init__(self, case: Case, seeds: int, receiver: Receiver) -> None:
        self._case, self._seeds, self._receiver = case, seeds, receiver
        self.best = receiver.best  # type: ignore[method-assign]
        self.proposal: Proposal | None = None

    def given(self, proposal: Proposal) -> None:
        """Run the case with several seeds."""
        budget = proposal.budget
        packing = judge_of(self._case).of_other_seeds(self._case, budget.motions, self._seeds)
        self.proposal = replace(proposal, budget=replace(budget, causes=budget.causes + packing))
        self._receiver.given(self.proposal)
