"""A chart: every choice is run, compared with the reference, and placed by its error and cost.

The Pareto front: choices for which no other is both cheaper and more accurate.

One error and one cost of every choice decide it, and are drawn: no choice that the picture shows as dominated is on it,
and every other one is. So that a second run of a chart has the same front, differences that a busy machine can cause
are ignored:

- The cost is the least CPU time of the timed runs, as whatever else a machine does only adds to it.
- Costs that differ by less than `TIE` are one cost, their median: the nearest are put together first, as long as all of
  them remain within it. So costs that differ by more are never equal, and costs of one scene with other sides are.
- Errors are the same to the bit in every run. Those within `EQUAL` are put together in the same way, and all below
  `NONE`, which a logarithmic axis cannot show, are equal.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from dembound.accuracy.chart.record import Record, record_in
from dembound.accuracy.chart.references import exact_of, reference_of
from dembound.accuracy.choice import Choice, choices_of, combinations, digest
from dembound.accuracy.judge import judge_of
from dembound.accuracy.reference import MonitorError, Reference, Requested, errors
from dembound.accuracy.runner import Run, Runner, Shown, measure
from dembound.casefile.messages import counted
from dembound.casefile.model import Case
from dembound.casefile.tables import ReferenceName
from dembound.errors import CaseError, DemboundError, RunError
from dembound.formulas.cause import TITLES, Truth
from dembound.kinds import kind_of
from dembound.results.histories import Quantity
from dembound.table import Box
from dembound.words import percent, with_unit

TIE = 1.25
"""Ratio of two costs below which they are equal: in two charts on a busy machine they differed by 15 % at most."""

EQUAL = 1.05
"""Ratio of two errors below which they are equal."""

NONE = 1e-6
"""Relative error up to which there is none."""

SHORTEST = 1e-9
"""Smallest CPU time (s): clocks of coarse ticks have 0 for a short run."""


class Point(NamedTuple):
    """A choice as compared and drawn: relative error, and cost, s of CPU time."""

    error: float
    cost: float


def points_of(errors: Sequence[float], costs: Sequence[float]) -> list[Point]:
    """The points of choices with these errors and least CPU times (s); nearly equal ones are equal."""
    seen, spent = np.maximum(errors, NONE), np.maximum(costs, SHORTEST)
    return [Point(*each) for each in zip(alike(seen, EQUAL), alike(spent, TIE), strict=True)]


def alike(values: np.ndarray, ratio: float) -> list[float]:
    """The positive values, with nearly equal ones replaced by the median of their group.

    Groups are put together, the two with the nearest extremes first, as long as these differ by less than a ratio.
    """
    groups = [[k] for k in np.argsort(values, kind="stable")]
    while len(groups) > 1:
        spans = [values[after[-1]] / values[before[0]] for before, after in pairwise(groups)]
        first = int(np.argmin(spans))
        if spans[first] >= ratio:
            break
        groups[first : first + 2] = [groups[first] + groups[first + 1]]
    found = np.empty(len(values))
    for group in groups:
        found[group] = np.median(values[group])
    return [float(each) for each in found]


def front(points: Sequence[Point]) -> list[int]:
    """Indices of the points on the front, the most accurate first; of several equal points the first."""

    def is_dominated(point: Point) -> bool:
        """Whether another one is cheaper or more accurate, and neither costlier nor less accurate."""
        return any(other.error <= point.error and other.cost <= point.cost and other != point for other in points)

    return sorted((k for k, point in enumerate(points) if not is_dominated(point)), key=lambda k: points[k])


def cheapest_within(points: Sequence[Point], level: float) -> int | None:
    """Number of the cheapest point with an error of at most `level`, which is on the front; None if there is none."""
    within = [k for k, point in enumerate(points) if point.error <= level]
    return min(within, key=lambda k: (points[k].cost, points[k].error), default=None)


def from_table(case: Case) -> dict[str, Mapping[str, Any]]:
    """The choices of the case's [chart] table by name; none without one."""
    table = case.chart
    found: dict[str, Mapping[str, Any]] = {**combinations(case, table.vary)} if table.vary else {}
    for choice in table.choice:
        if choice.name in found:
            raise CaseError([f"chart.choice: two choices have the name {choice.name}"], case.name)
        found[choice.name] = choice.set
    return found


def defaults(case: Case) -> dict[str, dict[str, Any]]:
    """Changes of keys by the name of the choice, for a case and a command that give none."""
    return dict(judge_of(case).chart_choices(case))


LEVELS = (0.01, 0.001)
"""Errors within which the cheapest choice is named."""

NOWHERE = Point(np.nan, np.nan)
"""Point of a choice without an error."""

SHORT, AT_ONCE = 0.1, 25
"""CPU time (s) in which a timed run is repeated, and how often at most; its cost is the median of these runs."""


@dataclass(frozen=True)
class Options:
    """Options of a chart.

    named : changes of keys by the name of the choice; None: from the case's [chart] table, by default `defaults`.
    repeats, reference : as in the table [chart]; None: from the table. of : truth to which errors are relative, see
    `reference_of`.
    """

    named: Mapping[str, Mapping[str, Any]] | None = None
    repeats: int | None = None
    reference: ReferenceName | None = None
    of: Truth | None = None
    requested: Requested = field(default_factory=Requested)


@dataclass(frozen=True)
class Line:
    """A choice in the chart: its results and the errors of its monitors, the largest first; none after a failure.

    point : its total error and cost (CPU seconds), after `points_of`.
    """

    choice: Choice
    outcome: Run
    errors: Sequence[MonitorError] = ()
    point: Point = NOWHERE

    @property
    def wall(self) -> float:
        """Median time of the whole run, s."""
        return float(np.median(self.outcome.wall))

    @property
    def apart(self) -> float:
        """Largest distance (m) between a monitor and the place where the reference recorded it."""
        return max((error.apart for error in self.errors), default=0.0)


@dataclass(frozen=True)
class Charted:
    """A chart.

    Attributes
    ----------
    case, reference, quantity : of the chart; work_unit : of the kind of body.
    lines : one for every choice. front : numbers of those on the Pareto front, the most accurate first.
    left_out : a line for each choice that was not valid, and for what the errors leave out.
    """

    case: Case
    reference: Reference
    quantity: Quantity
    work_unit: str
    lines: Sequence[Line]
    left_out: Sequence[str]
    front: Sequence[int] = ()

    def found(self, line: Line) -> str:
        """The findings of a choice in words, as differences from the reference where it has them.

        Findings of the reference itself are given as numbers.
        """
        is_own = any(line is self.lines[k] for k in self.reference.own)
        expected, found = {} if is_own else self.reference.findings, line.outcome.findings
        missing = [name for name in expected if name not in found]
        parts = [f"no {', '.join(missing)}"] if missing else []
        for name, (value, unit) in found.items():
            change, digits = (value - expected[name], 2) if name in expected else (value, 3)
            number = f"{change:.{digits}g}" if unit == "1" else with_unit(change, unit, digits)
            parts.append(f"{name} {'+' if name in expected and change >= 0.0 else ''}{number}")
        return ", ".join(parts)

    @property
    def judged(self) -> list[int]:
        """Indices of the choices that have an error and are not the reference."""
        return [k for k, line in enumerate(self.lines) if line.errors and k not in self.reference.own]

    def cheapest(self, level: float) -> int | None:
        """Index of the cheapest choice with an error of at most `level`; None if there is none."""
        judged = self.judged
        found = cheapest_within([self.lines[k].point for k in judged], level)
        return None if found is None else judged[found]

    @property
    def sentence(self) -> str:
        """Which errors the chart contains, and the cheapest choices within the `LEVELS`, in words."""
        within: dict[str, list[str]] = {}
        for level in LEVELS:
            found = self.cheapest(level)
            name = "none" if found is None else self._described(self.lines[found])
            within.setdefault(name, []).append(f"within {100.0 * level:g} %")
        parts = [f"cheapest {' and '.join(levels)}: {name}" for name, levels in within.items()]
        best = self.lines[self.front[0]]
        if best.point.error > LEVELS[-1]:
            but = ", without the reference" if self.reference.own else ""
            parts.append(f"smallest error (equal within {percent(EQUAL - 1.0)}{but}): {self._described(best)}")
        own = [f"{line.choice.name} ({line.point.cost:.2g} s)" for line in (self.lines[k] for k in self.reference.own)]
        parts += [f"the reference itself: {', '.join(own)}"] if own else []
        return f"errors {TITLES[self.reference.of]}; {'; '.join(parts)}"

    def _described(self, line: Line) -> str:
        """A choice with its error and cost."""
        error, cost = line.errors[0].total, line.point.cost
        return f"{line.choice.name} ({percent(error if error > NONE else 0.0)}, {cost:.2g} s)"


def chart(case: Case, options: Options, folder: Path, resume: bool, shown: Shown) -> Charted:
    """Run all choices of a case and compare them; the runs are recorded in ``chart.h5`` of the folder.

    Every choice runs once, which also compiles, then `repeats` times in turn. A choice whose run fails is kept with its
    failure. resume : runs that are already recorded are not repeated; otherwise an earlier chart is deleted.

    Raises CaseError, before anything is written, if no choice is valid, the case lacks a monitor, quantity or reference
    that the options name, or the folder holds no chart; RunError if all runs fail.
    """
    _must_be_comparable(case, options)
    named = options.named if options.named is not None else from_table(case) or defaults(case)
    choices, left_out = choices_of(case, named)
    if len(choices) == 1 and _requested_reference(case, options) == "finest":
        raise CaseError([f"--vary: {choices[0].name} is the only valid choice, which would be its own reference"])
    runs = _Runs(record_in(folder, resume), shown, options.requested.quantity)
    outcomes = runs.all_of(choices, options.repeats or case.chart.repeats)
    if all(outcome.failure for outcome in outcomes):
        raise RunError("\n".join(f"{c.name}: {o.failure}" for c, o in zip(choices, outcomes, strict=True)))
    reference = reference_of(case, choices, outcomes, _requested_reference(case, options), runs.one, options.of)
    lines = [_line(choice, outcome, reference, options) for choice, outcome in zip(choices, outcomes, strict=True)]
    lines = _placed(lines)
    if not any(line.errors for line in lines):
        raise RunError("\n".join(dict.fromkeys(f"{line.outcome.failure}" for line in lines)))
    unit, lines_out = kind_of(case).work_unit, [*left_out, *reference.cautions]
    charted = Charted(case, reference, options.requested.quantity, unit, lines, lines_out)
    if not (judged := charted.judged):
        raise RunError(f"nothing is left to compare with the reference, {reference.sentence}, which is a choice itself")
    return replace(charted, front=[judged[k] for k in front([lines[k].point for k in judged])])


def _must_be_comparable(case: Case, options: Options) -> None:
    """Raise CaseError for a case without the monitors, quantity or reference that the options compare."""
    monitors, requested = [monitor.name for monitor in case.monitor], options.requested
    if not monitors:
        raise CaseError(["monitor: is missing; a chart compares the histories of monitors"], case.name)
    if requested.monitor is not None and requested.monitor not in monitors:
        raise CaseError([f"--monitor: is {requested.monitor}, must be one of {', '.join(monitors)}"])
    is_recorded = requested.quantity in judge_of(case).quantities
    if requested.quantity == "stress" and (not is_recorded or requested.component is not None):
        raise CaseError(["--quantity: stress is that along a bar; disks do not have it, nor has it components"])
    if _requested_reference(case, options) == "exact":
        if options.of == "disks":
            raise CaseError(["--of: errors beside an exact solution are those of the rock, not of these disks"])
        exact_of(case)


def _requested_reference(case: Case, options: Options) -> ReferenceName | None:
    """The reference given by the options or else by the case."""
    return options.reference or case.chart.reference


def _line(choice: Choice, outcome: Run, reference: Reference, options: Options) -> Line:
    """A choice compared with the reference; if it cannot be compared, with a failure."""
    if outcome.failure:
        return Line(choice, outcome)
    try:
        return Line(choice, outcome, errors(choice, outcome, reference, options.requested))
    except CaseError as error:
        return Line(choice, replace(outcome, failure="; ".join(error.problems)))


def _placed(lines: Sequence[Line]) -> list[Line]:
    """The lines with their places in the chart, where they have errors."""
    done = [line for line in lines if line.errors]
    points = iter(points_of([line.errors[0].total for line in done], [min(line.outcome.cpu) for line in done]))
    return [replace(line, point=next(points)) if line.errors else line for line in lines]


class _Runs:
    """Runs cases as far as the record does not have their results."""

    def __init__(self, record: Record, shown: Shown, quantity: str) -> None:
        self._record, self._shown, self._quantity = record, shown, quantity
        self._runner = Runner(record, shown)

    def all_of(self, choices: Sequence[Choice], repeats: int) -> list[Run]:
        """The outcomes of choices, each with `repeats` costs; in every round all choices run, one after the other."""
        count = len(choices)
        outcomes = [
            self.one(f"{k} of {counted(count, 'choice')}, {choice.name}", choice.case)
            for k, choice in enumerate(choices, start=1)
        ]
        for number in range(1, repeats + 1):
            for k, (choice, outcome) in enumerate(zip(choices, outcomes, strict=True), start=1):
                if not outcome.failure and len(outcome.cpu) < number:
                    name = f"{k} of {counted(count, 'choice')}, timed run {number} of {repeats}"
                    self._time(name, choice.case, outcome)
        for outcome in outcomes:
            del outcome.cpu[repeats:], outcome.wall[repeats:]
        return outcomes

    def one(self, name: str, case: Case, inside: Box | None = None) -> Run:
        """The outcome of a case, without costs if it has to be run; inside : box where its findings are looked for."""
        monitors = [monitor.name for monitor in case.monitor]
        known = self._record.get(digest(case), monitors, self._quantity)
        if known is not None:  # damage ends the chart, and is no failed choice
            return known
        try:
            return self._runner.run(case, name, inside)
        except DemboundError as error:
            failed = Run(failure=str(error).splitlines()[0])
            self._record.add(digest(case), failed)
            return failed

    def _time(self, name: str, case: Case, outcome: Run) -> None:
        """Run a case again, and add its costs to its outcome."""
        costs: list[tuple[float, float]] = []
        with self._shown(name) as progress:
            while not costs or (len(costs) < AT_ONCE and sum(cpu for cpu, _ in costs) < SHORT):
                costs.append(measure(case, progress, watched=False)[1:])
        cpu, wall = (float(np.median(each)) for each in zip(*costs, strict=True))
        outcome.cpu.append(cpu)
        outcome.wall.append(wall)
        self._record.add_cost(digest(case), cpu, wall)
