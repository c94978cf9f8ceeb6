"""A budget of errors as a table in the terminal: a row for every cause, a column for every monitor."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Sequence

from dembound.accuracy.budget import Budget, Share
from dembound.accuracy.cause import TITLES, Cause
from dembound.casefile.messages import counted
from dembound.results.estimates import in_words
from dembound.words import percent

WIDTH, CELL = 80, 9
"""Most characters in a line, and the most in a cell, such as ">= 0.14 %"."""

WHAT = "errors: RMS over RMS, of the quantity with the largest error at each monitor"
"""Explanation of the numbers, printed above the table."""

MUCH = 3.0
"""Upper value over the value from which on only the upper one is given."""


def lines_of(budget: Budget) -> list[str]:
    """The table, explanations of its numbers, how they were found, and unknown causes."""
    if not any(budget.largest(name, "rock")[1].is_known for name in budget.motions):
        return _wrapped(_sentences(budget))
    return [WHAT, *_table(budget), *_wrapped(_sentences(budget))]


def _table(budget: Budget) -> list[str]:
    """The rows of the table."""
    causes = list(budget.causes.found)
    titles = ["how wrong is it", *(f"  {cause.name}" for cause in causes), *TITLES.values()]
    first = max(map(len, titles))
    ordered = sorted(budget.motions, key=lambda name: -_key(budget.largest(name)[1]))
    shown = _fitting(ordered, WIDTH - first - len("  at most 100 %"))
    names = [name for name in budget.motions if name in shown]
    rows: list[tuple[str, Sequence[str], str]] = [(titles[0], names, "known by")]
    for of in ("disks", "rock"):
        own = [cause for cause in causes if cause.of_disks == (of == "rock")]
        rows += [(f"  {each.name}", list(_cells(budget, each, names)), each.how) for each in own]
        if any(cause.of_disks for cause in causes) or of == "rock":
            totals = [budget.largest(name, of)[1] for name in names]
            rows.append((TITLES[of], [_total(each) for each in totals], _at_most(totals)))
    left = [budget.largest(name)[1] for name in ordered[len(shown) :]]
    wide = [max(len(cells[k]) for _, cells, _ in rows) for k in range(len(names))]
    lines = [_row(f"{title:<{first}}", cells, last, wide) for title, cells, last in rows]
    return [*lines, *([f"and {counted(len(left), 'more monitor')}, {_at_most(left)}"] if left else [])]


def _key(share: Share) -> float:
    return share.upper if share.is_known else -1.0


def _fitting(names: Sequence[str], width: int) -> list[str]:
    """The first names whose columns fit into a width, at least one."""
    found: list[str] = []
    used = 0
    for name in names:
        used += 2 + max(CELL, len(name))
        if found and used > width:
            break
        found.append(name)
    return found


def _row(title: str, cells: Sequence[str], last: str, wide: Sequence[int]) -> str:
    """A line of the table, its cells so many characters wide."""
    padded = (f"{cell:>{width}}" for cell, width in zip(cells, wide, strict=True))
    return "  ".join([title, *padded, last]).rstrip()


def _cells(budget: Budget, cause: Cause, names: Sequence[str]) -> Iterator[str]:
    """The share of a cause at every monitor, for the quantity with the largest error."""
    for name in names:
        share = cause.share(name, budget.largest(name)[0], budget.motions[name])
        text = in_words(share) if math.isfinite(share) else "-"
        yield "?" if cause.how == "unknown" else f"<= {percent(share)}" if cause.how == "bound" else text


def _total(share: Share) -> str:
    """A total error as text, with ≥ where a cause is unknown."""
    if not share.is_known:
        return "-"
    if share.at_least:
        return f">= {percent(share.value)}" if share.value > 0.0 else "?"
    return f"<= {percent(share.upper)}" if share.upper > MUCH * share.value else in_words(share.value)


def _at_most(totals: Sequence[Share]) -> str:
    """Text of the upper value of the largest total."""
    known = [share for share in totals if share.is_known]
    if any(share.at_least for share in known):
        return "at least"
    return f"at most {in_words(max(share.upper for share in known))}" if known else ""


def _sentences(budget: Budget) -> Iterator[str]:
    """How the errors were found, with causes found in the same way in one line, then notes and unknown causes."""
    ways: dict[str, list[str]] = {}
    for cause in budget.causes.found:
        ways.setdefault(cause.words, []).append(cause.name)
    yield from (f"{' and '.join(names)}: {words}" for words, names in ways.items())
    yield from budget.causes.notes
    yield from (f"not estimated: {line}" for line in budget.causes.limits)


def _wrapped(lines: Iterator[str]) -> list[str]:
    """Lines of at most `WIDTH` characters."""
    return [part for line in lines for part in textwrap.wrap(line, WIDTH, subsequent_indent="  ")]
