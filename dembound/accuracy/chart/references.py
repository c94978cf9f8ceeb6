"""The reference of a chart: an exact solution, an extended run, a finer run of a bar, or the finest choice's run."""

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import Choice, label
from dembound.accuracy.judge import MOST, extended, judge_of
from dembound.accuracy.reference import Exact, FinerRun, Reference
from dembound.accuracy.runner import Run
from dembound.boundaries import SIDES as SIDE_NAMES
from dembound.casefile import Case
from dembound.casefile.tables import ReferenceName
from dembound.errors import CaseError, DemboundError, RunError
from dembound.formulas.cause import SIDES as OF_SIDES
from dembound.formulas.cause import Causes, Truth
from dembound.formulas.history import Motions
from dembound.kinds import with_changes
from dembound.table import Box

SIDES = "boundary."
"""Beginning of all keys of sides."""

DISCRETE = ("bar.spacing", "method", "run")
"""Beginnings of the keys of bars that the finer reference replaces."""

RunOf = Callable[[str, Case, Box | None], Run]
"""Returns the outcome of a case that is no choice, given its name, and the part of its scene in which breaks count."""

AFFORDABLE = 16
"""Size of an extended scene over that of the choice with most particles, up to which it is run without being asked for.
"""


def reference_of(
    case: Case,
    choices: Sequence[Choice],
    outcomes: Sequence[Run],
    requested: ReferenceName | None,
    run: RunOf,
    of: Truth | None = None,
) -> Reference:
    """The reference of a chart for choices whose runs have these outcomes.

    requested : its name; None: the exact solution if the case has one, no hole, and `of` is not "disks". Else, if
    choices differ in their sides, the extended scene, if it is affordable. Else for bars the finer run, for disks the
    choice with the most nodes times steps. of : truth to which errors are relative; None: by `Judge.truth`, or "rock"
    for exact solutions.

    Raises CaseError if the requested reference is not possible, RunError if its run fails.
    """
    return _References(case, choices, outcomes, run, of).named(requested)


def exact_of(case: Case) -> Exact:
    """The exact solution of a case; raises CaseError, with the reasons, if none is known."""
    if (found := judge_of(case).exact(case)) is not None:
        return found
    known = (
        "for a pulse on the free left end of a bar without attenuation, for a plane wave that leaves through an "
        "absorbing side, and for the problems of dembound exact"
    )
    raise CaseError([f"--reference: there is no exact solution of this case; there are {known}"], case.name)


class _References:
    """The references for choices with these outcomes."""

    def __init__(
        self, case: Case, choices: Sequence[Choice], outcomes: Sequence[Run], run: RunOf, of: Truth | None
    ) -> None:
        self._case, self._choices, self._outcomes, self._run, self._of = case, choices, outcomes, run, of
        self._own = _finest(outcomes)
        self._judge = judge_of(case)

    def named(self, requested: ReferenceName | None) -> Reference:
        """The reference with the requested name, or the default."""
        if requested is None:
            return self._default()
        made = {"exact": self._exact, "extended": self._extended, "finer": self._finer, "finest": self._finest}
        if (found := made[requested]()) is None:
            said = "--reference: finer is for bars; of disks take exact, extended or finest"
            raise CaseError([said], self._case.name)
        return found

    def _default(self) -> Reference:
        """The first reference that the case allows: exact, extended, or the most accurate run."""
        if self._of != "disks" and not self._judge.hides_sides(self._case):
            with suppress(CaseError):
                return self._exact()
        if not any(key.startswith(SIDES) for choice in self._choices for key in choice.changes):
            return self._best()
        try:
            return self._extended(AFFORDABLE * max(outcome.count for outcome in self._outcomes))
        except CaseError as error:
            best = self._best()
            caution = f"errors of sides are not seen, as there is no extended scene: {error}"
            return replace(best, cautions=(*best.cautions, caution))

    def _best(self) -> Reference:
        """The most accurate run of the same scene."""
        try:
            return self._finer() or self._finest()
        except DemboundError as error:
            finest = self._finest()
            caution = f"the reference is the finest choice, as a finer run is not possible: {error}"
            return replace(finest, cautions=(caution,))

    def _exact(self) -> Reference:
        """The exact solution."""
        found: Exact = exact_of(self._case)

        def motions(choice: Choice, outcome: Run) -> Motions:
            return found.motions(choice.case, outcome.motions)

        return Reference("exact", found.sentence, motions, found.until, found.findings)

    def _extended(self, most: int = MOST) -> Reference:
        """The extended scene of the finest choice, with the case's own sides, of at most `most` particles.

        A bar is that of the finer run, extended.
        """
        changes = self._choices[self._own].changes
        others = {key: each for key, each in changes.items() if not key.startswith(SIDES)}
        plain = with_changes(self._case, others | self._sides())
        fine = self._judge.finer(plain, self._choices, self._outcomes)
        plain = fine.case if fine else plain
        larger = extended(plain, most)
        if larger.case is plain:
            said = "--reference: no side has to be moved, the extended scene is that of the case"
            raise CaseError([said], self._case.name)
        outcome = self._done("extended scene", larger.case, larger.inside)
        places = {name: outcome.findings[name] for name in self._judge.from_left_end if name in outcome.findings}
        begins = larger.inside[0]  # where the case's scene begins, from which its places are measured
        own = {name: found._replace(value=found.value - begins) for name, found in places.items()}
        outcome = replace(outcome, findings={**outcome.findings, **own})
        sentence = larger.sentence.removeprefix("reference: ")
        sentence += f", by finite differences at Courant number 1, spacing {fine.spacing:.4g} m" if fine else ""
        return self._of_run("extended", sentence, larger.case, outcome, fine)

    def _sides(self) -> dict[str, Any]:
        """Changes of sides for the extended scene: a continuum where a choice lets waves in through one; else none.

        A side that waves enter through cannot move away; a continuum there reflects least.
        """
        for choice in self._choices:
            if self._judge.has_input_continuum(choice.case):
                return {key: each for key, each in choice.changes.items() if key.startswith(SIDES)}
        return {}

    def _finer(self) -> Reference | None:
        """Finite differences at Courant number 1 with a finer spacing than all choices; None for bodies without."""
        own = self._choices[self._own]
        fine = self._judge.finer(own.case, self._choices, self._outcomes)
        if fine is None:
            return None
        outcome = self._done("finer reference", fine.case)
        spacing = f"a spacing of {fine.spacing:.4g} m, finer than all choices"
        sentence = f"finite differences at Courant number 1 and {spacing}"
        other = {key: value for key, value in own.changes.items() if not key.startswith(DISCRETE)}
        sentence += f", {label(self._case, other)}" if other else ""
        return self._of_run("finer", sentence, fine.case, outcome, fine)

    def _finest(self) -> Reference:
        """The run of the finest choice."""
        sentence = f"the finest run, {self._choices[self._own].name}"
        own = self._choices[self._own].case
        return self._of_run("finest", sentence, own, self._outcomes[self._own])

    def _done(self, name: str, case: Case, inside: Box | None = None) -> Run:
        """The run of a case that is no choice, with breaks found inside a box; raises RunError if it fails."""
        outcome = self._run(name, case, inside)
        if outcome.failure:
            raise RunError(f"{name}: {outcome.failure}")
        return outcome

    def _of_run(self, name: str, sentence: str, case: Case, run: Run, fine: FinerRun | None = None) -> Reference:
        """The run of a case as reference, up to its first break, after which histories do not converge.

        fine : the finer run that it is, which has histories at the monitors of every choice.
        """
        findings = {found: value for found, (value, _) in run.findings.items()}
        at = self._judge.first_break
        of = self._of or self._judge.truth(self._choices[self._own].case)
        intact = {monitor: own.before(findings.get(at, math.inf)) for monitor, own in run.motions.items()}
        causes = self._judge.of_reference(case, intact, run.time_step)
        causes = replace(causes, found=[cause for cause in causes.found if cause.counts(of)])
        sides = [case.side(side) for side in SIDE_NAMES]  # errors of those are unknown that absorb without a continuum
        absorb = any(table.is_artificial and not table.waves and not table.is_outside for table in sides)
        breaks = [findings[at]] if at in findings and self._case.chart.until == "break" else []
        return Reference(
            name=name,
            sentence=sentence + "".join(f", up to its first break at {1e3 * time:.4g} ms" for time in breaks),
            motions=lambda _, outcome: run.motions if fine is None else fine.motions(run, outcome),
            until=min(breaks, default=math.inf),
            findings=findings,
            own=tuple(k for k, outcome in enumerate(self._outcomes) if _is_same_run(outcome, run)),
            cautions=self._judge.cautions([choice.case for choice in self._choices]),
            rest=_sizes(causes),
            of=of,
            late=run.late,
            added=[cause.name for cause in causes.found if cause.how != "unknown"],
            unknown=[*([OF_SIDES] if absorb and name != "extended" else []), *(cause.name for cause in causes.unknown)],
        )


def _sizes(causes: Causes) -> dict[str, dict[str, float]]:
    """By monitor and quantity, RMS of all causes together over RMS of the motion; empty without causes."""
    if causes.motions is None:
        return {}
    budget, found = Budget(causes.motions, causes), {}
    for name in causes.motions:
        totals = {quantity: budget.total(name, quantity).value for quantity in budget.quantities(name)}
        found[name] = {quantity: size for quantity, size in totals.items() if math.isfinite(size)}
    return found


def _finest(outcomes: Sequence[Run]) -> int:
    """Index of the choice with the most nodes times steps, the first of several.

    Work would be no measure of accuracy for bars: wider horizons have more bonds and larger errors.
    """
    done = [k for k, outcome in enumerate(outcomes) if not outcome.failure]
    if not done:
        raise RunError("no choice could be run")
    return max(done, key=lambda k: outcomes[k].count * outcomes[k].steps)


def _is_same_run(outcome: Run, run: Run) -> bool:
    """Whether two outcomes are those of one run: equal work, steps and bits."""
    if (outcome.time_step, outcome.steps, outcome.work) != (run.time_step, run.steps, run.work):
        return False
    return outcome.motions.keys() == run.motions.keys() and all(
        np.array_equal(history.velocity, run.motions[name].velocity)
        and np.array_equal(history.displacement, run.motions[name].displacement)
        for name, history in outcome.motions.items()
    )
