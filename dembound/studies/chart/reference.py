"""The reference of a chart: an exact solution, an extended run, or the run of the finest choice."""

import math
from collections.abc import Callable, Sequence

from dembound.bar.kind import SPALL_TIME
from dembound.casefile import Case
from dembound.casefile.chart import ReferenceName
from dembound.errors import CaseError, RunError
from dembound.studies.chart.choices import Choice
from dembound.studies.chart.errors import Reference
from dembound.studies.chart.exact import Exact, exact_of
from dembound.studies.chart.measure import Outcome

RunOf = Callable[[str, Case], Outcome]
"""Returns the outcome of a case that is no choice, given its name."""


def reference_of(
    case: Case, choices: Sequence[Choice], outcomes: Sequence[Outcome], wanted: ReferenceName | None, run: RunOf
) -> Reference:
    """The reference of this name for choices with these outcomes.

    By default the exact solution if the case has one, else the choice with the most work.

    Raises CaseError if a reference that is asked for by name is not possible.
    """
    if wanted == "exact":
        return _exact(exact_of(case))
    if wanted is None:
        try:
            return _exact(exact_of(case))
        except CaseError:
            pass
    return _finest(choices, outcomes)


def _exact(solution: Exact) -> Reference:
    """The reference that an exact solution is."""
    return Reference(
        name="exact",
        sentence=solution.sentence,
        gauges=lambda choice, outcome: solution.gauges(choice.case, outcome.gauges),
        until=solution.until,
        findings=solution.findings,
    )


def _finest(choices: Sequence[Choice], outcomes: Sequence[Outcome]) -> Reference:
    """The choice that does the most work, the first of several."""
    done = [k for k, outcome in enumerate(outcomes) if not outcome.failure]
    if not done:
        raise RunError("no choice could be run")
    own = max(done, key=lambda k: outcomes[k].work)
    return Reference(
        name="finest",
        sentence=f"the finest run, {choices[own].name}",
        gauges=lambda choice, outcome: outcomes[own].gauges,
        until=_first_spall(outcomes[own]),
        findings={name: found.value for name, found in outcomes[own].findings.items()},
        own=own,
    )


def _first_spall(outcome: Outcome) -> float:
    """Time (s) of the first spall, from which on histories do not converge; infinite without one."""
    return outcome.findings[SPALL_TIME].value if SPALL_TIME in outcome.findings else math.inf
