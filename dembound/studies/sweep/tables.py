"""The results of a sweep in files, with means and confidence intervals over seeds."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.model import Case
from dembound.casefile.tables import Action
from dembound.errors import CaseError
from dembound.results.committed import new_file
from dembound.results.datasets import describe, text, write
from dembound.results.text_files import write_csv
from dembound.studies.sweep.members import Member, shown_by_default, unit_of
from dembound.studies.sweep.perform import Outcome
from dembound.version import __version__

CONFIDENCE = 0.95
"""Probability with which the interval round the mean has the true mean, if values are distributed normally."""


@dataclass(frozen=True)
class Statistic:
    """The mean of a quantity over the members of a group.

    group : keys and values that they share. count : members with this quantity. spread : standard deviation of a single
    member, √(Σ(x − mean)²/(count − 1)). interval : half the width of the confidence interval of the mean. Both are nan
    for a single member.
    """

    group: Mapping[str, Any]
    quantity: str
    count: int
    mean: float
    spread: float
    interval: float

    @property
    def ends(self) -> tuple[float, float]:
        """Lower and upper end of the confidence interval."""
        return self.mean - self.interval, self.mean + self.interval


def statistic(group: Mapping[str, Any], quantity: str, values: Sequence[float]) -> Statistic:
    """Mean, spread and confidence of values; the interval is Student's, t·spread/√count of count − 1 degrees."""
    from scipy.special import stdtrit

    count, mean = len(values), float(np.mean(values))
    if count == 1:
        return Statistic(group, quantity, count, mean, np.nan, np.nan)
    spread = float(np.std(values, ddof=1))
    t = float(stdtrit(count - 1, 0.5 + 0.5 * CONFIDENCE))
    return Statistic(group, quantity, count, mean, spread, t * spread / np.sqrt(count))


def statistics(members: Sequence[Member], outcomes: Sequence[Outcome | None]) -> Iterator[Statistic]:
    """Statistics of every group of members and every quantity, in the order of the members."""
    groups: list[tuple[Mapping[str, Any], list[Outcome]]] = []
    for member, outcome in zip(members, outcomes, strict=True):
        found = next((each for group, each in groups if group == member.group), None)
        if found is None:
            groups.append((member.group, found := []))
        if outcome is not None and not outcome.failure:
            found.append(outcome)
    for group, inside in groups:
        for quantity in quantities(inside):
            yield statistic(group, quantity, [each.values[quantity] for each in inside if quantity in each.values])


def quantities(outcomes: Sequence[Outcome | None]) -> list[str]:
    """Names of all values of these outcomes."""
    return list(dict.fromkeys(name for outcome in outcomes if outcome is not None for name in outcome.values))


MISSING = "not done"
"""State of members that a stopped sweep has not done."""

OF_STATISTICS = ("quantity", "unit", "count", "mean", "spread", "interval", "low", "high")
"""Columns of statistics, after those of the keys: see `Statistic`; low and high are the ends of the interval."""


NUMBER = re.compile(r"(?<![\w.\[])[-+]?\d[\d.,]*(e[-+]?\d+)?")
"""A number in a sentence, but not in a name or a place such as ``hole[2]``."""


@dataclass(frozen=True)
class Swept:
    """A sweep: its case and action, its members, and the outcome of each, None if it was not done.

    requested : names of the quantities that are printed and drawn, see `shown`.
    """

    case: Case
    action: Action
    members: Sequence[Member]
    outcomes: Sequence[Outcome | None]
    requested: Sequence[str] = ()

    @property
    def keys(self) -> list[str]:
        """The varied keys."""
        return list(dict.fromkeys(key for member in self.members for key in member.changes))

    @property
    def states(self) -> list[str]:
        """State of every member: done, or the reason why it is not."""
        return [MISSING if each is None else each.failure or "done" for each in self.outcomes]

    @property
    def shown(self) -> list[str]:
        """The quantities that are printed and drawn: the requested ones, else `shown_by_default`.

        Raises CaseError for one that no member has.
        """
        names = quantities(self.outcomes)
        if names and (missing := [name for name in self.requested if name not in names]):
            raise CaseError([f"--quantity: is {missing[0]}, must be one of {', '.join(names)}"])
        return [name for name in self.requested if name in names] or shown_by_default(names, self.action)

    @property
    def warnings(self) -> dict[str, int]:
        """Each distinct warning of the members' runs, see `distinct`."""
        return distinct(self.outcomes)

    def values(self, quantity: str) -> np.ndarray:
        """The values (n,) of a quantity, nan for members without it."""
        return np.array([np.nan if each is None else each.values.get(quantity, np.nan) for each in self.outcomes])


def distinct(outcomes: Sequence[Outcome | None]) -> dict[str, int]:
    """Each distinct warning of members' runs -> number of members with it.

    Warnings that differ only in numbers count as one, with the numbers of the first member.
    """
    first: dict[str, str] = {}
    count: Counter[str] = Counter()
    for warnings in (each.warnings for each in outcomes if each is not None):
        alike = {line: NUMBER.sub("", line) for line in warnings}
        for line, words in alike.items():
            first.setdefault(words, line)
        count.update(set(alike.values()))
    return {line: count[words] for words, line in first.items()}


def write_tables(swept: Swept, folder: Path) -> list[Path]:
    """Write all files into the folder of a sweep; returns their paths."""
    averages = list(statistics(swept.members, swept.outcomes))
    paths = [folder / name for name in ("sweep.csv", "statistics.csv", "sweep.h5")]
    write_csv(paths[0], _rows_of_members(swept))
    write_csv(paths[1], _rows_of_statistics(swept, averages))
    _write_record(paths[2], swept, averages)
    return paths


def _rows_of_members(swept: Swept) -> Iterable[Sequence[Any]]:
    """A row for every member: its name and state, the values of its keys, its quantities, and the time it took (s)."""
    names = quantities(swept.outcomes)
    yield ["member", "state", *swept.keys, *names, "wall_s"]
    for member, outcome, state in zip(swept.members, swept.outcomes, swept.states, strict=True):
        values = [None if outcome is None else outcome.values.get(name) for name in names]
        seconds = None if outcome is None else round(outcome.seconds, 3)
        yield [member.name, state, *(_plain(member.changes.get(key)) for key in swept.keys), *values, seconds]


def _rows_of_statistics(swept: Swept, averages: Sequence[Statistic]) -> Iterable[Sequence[Any]]:
    """A row for every group of members and quantity."""
    keys = list(dict.fromkeys(key for member in swept.members for key in member.group))
    yield [*keys, *OF_STATISTICS]
    for each in averages:
        group = (_plain(each.group.get(key)) for key in keys)
        numbers = each.count, each.mean, each.spread, each.interval
        yield [*group, each.quantity, unit_of(each.quantity), *numbers, *each.ends]


def _plain(value: Any) -> Any:
    """A value of a key in a cell: numbers and texts as they are, lists and tables as JSON."""
    return json.dumps(value) if isinstance(value, list | dict | bool) else value


def _write_record(path: Path, swept: Swept, averages: Sequence[Statistic]) -> None:
    """Write the members by column, and the statistics by group and quantity."""
    with new_file(path) as file:
        case = swept.case
        describe(file, {"name": case.name, "title": case.title, "case": case.text, "version": __version__})
        describe(file, {"action": swept.action, "shown": json.dumps(swept.shown)})
        members = file.create_group("members")
        texts = {"name": [member.name for member in swept.members], "state": swept.states}
        for name in ("changes", "group"):
            texts[name] = [json.dumps(getattr(member, name)) for member in swept.members]
        for name, own in texts.items():
            members.create_dataset(name, data=np.array([text(each) for each in own]))
        seconds = np.array([np.nan if each is None else each.seconds for each in swept.outcomes])
        write(members, "seconds", seconds, "s")
        values = file.create_group("values")
        for name in quantities(swept.outcomes):
            write(values, name, swept.values(name), unit_of(name))
        _write_statistics(file.create_group("statistics"), averages)


def _write_statistics(group: Any, averages: Sequence[Statistic]) -> None:
    """A group for every quantity, with a row for every group of members that has it."""
    for name in dict.fromkeys(each.quantity for each in averages):
        rows = [each for each in averages if each.quantity == name]
        inner = group.create_group(name)
        inner.create_dataset("group", data=np.array([text(json.dumps(each.group)) for each in rows]))
        write(inner, "count", np.array([each.count for each in rows]), "1")
        for column in ("mean", "spread", "interval"):
            write(inner, column, np.array([getattr(each, column) for each in rows]), unit_of(name))
