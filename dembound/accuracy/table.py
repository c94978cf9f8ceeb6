"""A budget of errors as a table in the terminal: a row for every monitor, a column for every cause."""

from __future__ import annotations

import math
import shlex
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from dembound.accuracy.budget import Budget, Share
from dembound.casefile.messages import counted
from dembound.formulas.cause import TITLES, Cause, Causes
from dembound.formulas.history import Motions
from dembound.results.histories import LEAST, in_words
from dembound.words import columns, percent

WIDTH, HEAD = 80, 9
"""Most characters in a line, and in a line of the head of a column."""

WHAT = "errors: RMS over RMS, of the quantity with the largest error at each monitor"
"""Explanation of the numbers, printed above the table."""

MOST_MONITORS = 10
"""Monitors that have a row."""

MUCH = 3.0
"""Upper value over the value from which on only the upper one is given."""

ENOUGH = 0.01
"""Error from which on a more accurate case is proposed."""


def lines_of(budget: Budget) -> list[str]:
    """The table, explanations of its numbers, how they were found, and unknown causes."""
    if not any(budget.largest(name, "rock")[1].is_known for name in budget.motions):
        return _wrapped(_sentences(budget))
    return [WHAT, *_table(budget), *_wrapped(_sentences(budget))]


def in_one_line(causes: Sequence[Cause], motions: Motions) -> str:
    """The largest error by each known cause at monitors whose motion is not negligible; motions : by monitor.

    Without motions only causes whose sizes do not depend on them are known.
    """
    known = [cause for cause in causes if cause.how != "unknown"]
    sizes = [Budget(motions, Causes([cause])).worst().share.value if motions else cause.largest for cause in known]
    return ", ".join(f"{cause.name} {in_words(size)}" for cause, size in zip(known, sizes, strict=True))


def next_step(budget: Budget, results: Path, case: Path | None) -> str:
    """What can be done about the error of a run, in one line; case : its file, if that is known."""
    worst = budget.worst()
    if not worst.by:
        return f"next: dembound report {shlex.quote(str(results))}"
    if worst.share.upper <= ENOUGH and not worst.share.at_least:
        shows = f"dembound report {shlex.quote(str(results))} shows it beside the motion"
        return f"next: the error is below {percent(ENOUGH)} where the motion is not small; {shows}"
    cause = max(worst.by, key=lambda name: worst.by[name])
    path = "CASE" if case is None else shlex.quote(str(case))
    return f"next: most is by {cause}, at {worst.monitor}; less with dembound advise {path} --error {ENOUGH:.0%}"


def _table(budget: Budget) -> list[str]:
    """The table; causes that are small at all monitors have no column where there is no space for all."""
    worst = {name: budget.largest(name)[1] for name in budget.motions}
    ordered = sorted(worst, key=lambda name: -worst[name].upper if worst[name].is_known else 1.0)
    names = [name for name in budget.motions if name in ordered[:MOST_MONITORS]]
    known = [cause for cause in budget.causes.found if cause.how != "unknown"]
    large = [cause for cause in known if any(_share(budget, cause, name) >= LEAST for name in names)]
    lines = _lines(budget, names, known)
    if max(map(len, lines)) > WIDTH and len(large) < len(known):
        small = ", ".join(cause.name for cause in known if cause not in large)
        lines = [*_lines(budget, names, large), *_wrapped([f"{in_words(0.0)} at all monitors: {small}"])]
    left = [worst[name] for name in ordered[MOST_MONITORS:]]
    return [*lines, *([f"and {counted(len(left), 'more monitor')}, {_at_most(left)}"] if left else [])]


def _lines(budget: Budget, names: Sequence[str], causes: Sequence[Cause]) -> list[str]:
    """The table with columns for some causes."""
    has_disks = any(cause.of_disks for cause in budget.causes.found)
    heads, cells = ["monitor"], [list(names)]
    for of in ("disks", "rock") if has_disks else ("rock",):
        for cause in (each for each in causes if each.of_disks == (of == "rock") or not has_disks):
            heads.append(cause.name)
            cells.append([_cell(budget, cause, name) for name in names])
        totals = [budget.largest(name, of)[1] for name in names]
        heads.append(TITLES[of].removeprefix("of ") if has_disks else "whole")
        cells.append([_total(share) for share in totals])
        if of == budget.of or not has_disks:
            heads.append("at most")
            cells.append([share.most if share.is_known else "-" for share in totals])
    wrapped = [textwrap.wrap(head, HEAD) for head in heads]
    deepest = max(map(len, wrapped))
    above = zip(*([""] * (deepest - len(lines)) + lines for lines in wrapped), strict=True)
    return columns([*above, *zip(*cells, strict=True)])


def _share(budget: Budget, cause: Cause, name: str) -> float:
    """The share of a cause at a monitor, of the quantity with the largest error; nan if it is not known."""
    return cause.share(name, budget.largest(name)[0], budget.motions[name])


def _cell(budget: Budget, cause: Cause, name: str) -> str:
    """The share of a cause at a monitor as text."""
    share = _share(budget, cause, name)
    if cause.how == "bound":
        return f"<= {percent(share)}"
    return in_words(share) if math.isfinite(share) else "-"


def _total(share: Share) -> str:
    """A total error as text, with ≥ where a cause is unknown."""
    if not share.is_known:
        return "-"
    is_wide = not share.at_least and share.upper > MUCH * share.value
    return f"<= {percent(share.upper)}" if is_wide else share.expected


def _at_most(totals: Sequence[Share]) -> str:
    """Text of the upper value of the largest total."""
    known = [share for share in totals if share.is_known]
    if not known or any(share.at_least for share in known):
        return "of unknown error"
    return f"at most {in_words(max(share.upper for share in known))}"


def _sentences(budget: Budget) -> Iterator[str]:
    """How the errors were found, with causes found in the same way in one line, then notes and unknown causes."""
    ways: dict[str, list[str]] = {}
    for cause in budget.causes.found:
        if cause.how != "unknown":
            ways.setdefault(cause.words, []).append(cause.name)
    yield from (f"{' and '.join(names)}: {words}" for words, names in ways.items())
    yield from budget.causes.notes
    yield from (f"not estimated: {cause.name}, {cause.words}" for cause in budget.causes.unknown)
    yield from (f"not estimated: {line}" for line in budget.causes.limits)


def _wrapped(lines: Iterable[str]) -> list[str]:
    """Lines of at most `WIDTH` characters."""
    return [part for line in lines for part in textwrap.wrap(line, WIDTH, subsequent_indent="  ")]
