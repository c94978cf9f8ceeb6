"""The reference of a chart: an exact solution, an extended run, or the run of the finest choice."""

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace

from dembound.bar.kind import SPALL_TIME
from dembound.casefile import Case
from dembound.casefile.chart import ReferenceName
from dembound.disks.breaks import BREAK_TIME
from dembound.errors import CaseError, RunError
from dembound.kinds import with_changes
from dembound.studies.chart.choices import Choice
from dembound.studies.chart.errors import Reference
from dembound.studies.chart.exact import Exact, exact_of
from dembound.studies.chart.measure import Outcome
from dembound.studies.extended import MOST, extended

SIDES = "boundary."
"""Beginning of all keys of sides."""

RunOf = Callable[[str, Case], Outcome]
"""Returns the outcome of a case that is no choice, given its name."""

AFFORDABLE = 16
"""Size of an extended scene over that of the choice with most particles, up to which it is run without being asked for.
"""


def reference_of(
    case: Case, choices: Sequence[Choice], outcomes: Sequence[Outcome], wanted: ReferenceName | None, run: RunOf
) -> Reference:
    """The reference of this name for choices with these outcomes.

    By default the exact solution if the case has one. Else, if choices differ in their sides, the extended scene, if it
    is affordable. Else the choice with the most nodes times steps.

    Raises CaseError if a reference that is asked for by name is not possible, RunError if its run fails.
    """
    finest = _finest(case, choices, outcomes)
    if wanted == "exact":
        return _exact(exact_of(case))
    if wanted == "extended":
        return _extended(case, choices, outcomes, finest, run, MOST)
    if wanted is None:
        with suppress(CaseError):
            return _exact(exact_of(case))
        if any(key.startswith(SIDES) for choice in choices for key in choice.changes):
            most = AFFORDABLE * max(outcome.count for outcome in outcomes)
            try:
                return _extended(case, choices, outcomes, finest, run, most)
            except CaseError as error:
                unseen = "errors of its sides are not seen"
                sentence = f"{finest.sentence}; {unseen}"
                return replace(finest, sentence=sentence, caution=f"{unseen}, as there is no extended scene: {error}")
    return finest


def _extended(
    case: Case, choices: Sequence[Choice], outcomes: Sequence[Outcome], finest: Reference, run: RunOf, most: int
) -> Reference:
    """The scene of the case with all keys of the finest choice but those of its sides, extended.

    most : largest number of particles.
    """
    assert finest.own is not None
    inner = {key: value for key, value in choices[finest.own].changes.items() if not key.startswith(SIDES)}
    plain = with_changes(case, inner)
    larger = extended(plain, most)
    if larger.case is plain:
        raise CaseError(["--reference: no side has to be moved, the extended scene is that of the case"], case.name)
    outcome = run("extended scene", larger.case)
    if outcome.failure:
        raise RunError(f"extended scene: {outcome.failure}")
    moved = {  # the same particles, which are elsewhere in the extended scene
        name: replace(outcome.gauges[name], position=gauge.position)
        for name, gauge in outcomes[finest.own].gauges.items()
    }
    return _of_run("extended", larger.sentence.removeprefix("reference: "), case, replace(outcome, gauges=moved))


def _exact(solution: Exact) -> Reference:
    """The reference that an exact solution is."""
    return Reference(
        name="exact",
        sentence=solution.sentence,
        gauges=lambda choice, outcome: solution.gauges(choice.case, outcome.gauges),
        until=solution.until,
        findings=solution.findings,
    )


def _finest(case: Case, choices: Sequence[Choice], outcomes: Sequence[Outcome]) -> Reference:
    """The choice with the most nodes times steps, the first of several.

    Work would be no measure of accuracy for bars: wider horizons have more bonds and larger errors.
    """
    done = [k for k, outcome in enumerate(outcomes) if not outcome.failure]
    if not done:
        raise RunError("no choice could be run")
    own = max(done, key=lambda k: outcomes[k].count * outcomes[k].steps)
    return replace(_of_run("finest", f"the finest run, {choices[own].name}", case, outcomes[own]), own=own)


def _of_run(name: str, sentence: str, case: Case, outcome: Outcome) -> Reference:
    """The reference that a run is, up to its first spall or broken bond, after which histories do not converge."""
    findings = {found: value for found, (value, _) in outcome.findings.items()}
    breaks = [findings[at] for at in (SPALL_TIME, BREAK_TIME) if at in findings and case.chart.until == "break"]
    return Reference(
        name=name,
        sentence=sentence + "".join(f", up to its first break at {1e3 * time:.4g} ms" for time in breaks),
        gauges=lambda choice, _: outcome.gauges,
        until=min(breaks, default=math.inf),
        findings=findings,
    )
