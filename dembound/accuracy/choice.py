"""Choices: named changes of a case, made of lists of values of its keys, and the keys in which cases differ."""

from __future__ import annotations

import hashlib
import json
import math
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice, product
from typing import Any, Generic, Self, TypeVar

import numpy as np

from dembound.casefile.model import Case
from dembound.casefile.reader import parsed, value_of
from dembound.casefile.tables import range_of
from dembound.errors import CaseError
from dembound.results.structure import MOST_MEMBERS
from dembound.schemas import with_changes
from dembound.table import DISCRIMINATORS, Table, every_key
from dembound.version import __version__


def label(case: Case, changes: Mapping[str, Any]) -> str:
    """Changed keys of a case in words, such as "radius 0.5 m, boundary.right viscous".

    A table of the case that is replaced as a whole is named by its type.
    """
    parts = [
        ("" if "." not in key else name, in_words(value) + _unit(case, key, value))
        for name, (key, value) in zip(short_keys(changes), changes.items(), strict=True)
    ]
    return ", ".join(" ".join(part).strip() for part in parts)


def short_keys(changes: Mapping[str, Any]) -> list[str]:
    """The last names of keys, or the full keys where the last names are ambiguous."""
    last = [key.rpartition(".")[2] for key in changes]
    return [
        short if key.count(".") == 1 and last.count(short) == 1 and not isinstance(value, Mapping) else key
        for short, (key, value) in zip(last, changes.items(), strict=True)
    ]


def in_words(value: Any) -> str:
    """A value without quotes; a table as its type followed by its other keys in brackets."""
    if isinstance(value, Mapping):
        kind = [in_words(inner) for key, inner in value.items() if key in DISCRIMINATORS]
        rest = ", ".join(f"{key} {in_words(inner)}" for key, inner in value.items() if key not in DISCRIMINATORS)
        return " ".join([*kind, f"({rest})"] if rest else kind)
    if isinstance(value, list):
        return f"[{', '.join(in_words(inner) for inner in value)}]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _unit(case: Case, key: str, value: Any) -> str:
    """The unit of a number at a key of the case, after a blank; empty for pure numbers and unknown keys."""
    if isinstance(value, bool | str | Mapping):
        return ""
    table: Any = case
    *path, last = key.split(".")
    for name in path:
        table = _inner_table(table, name)
    if not isinstance(table, Table) or last not in type(table).model_fields:
        return ""
    unit = table.described(last).get("unit", "1")
    return "" if unit == "1" else f" {unit}"


def _inner_table(table: Any, name: str) -> Any:
    """The table with this name in a table, a mapping, or a list of named tables; None if there is none."""
    if isinstance(table, Mapping):
        return table.get(name)
    if isinstance(table, tuple):
        return next((each for each in table if getattr(each, "name", None) == name), None)
    return getattr(table, name, None)


Path = tuple[str, ...]


def differences(given: Case, changed: Case) -> dict[str, Any]:
    """Dotted keys and values by which `with_changes` makes the changed case of the given one.

    A table that lacks keys of the given one is replaced as a whole, one that is left out has None. A load, monitor or
    hole is identified by its name.
    """
    return {".".join(path): value for path, value in _differences(parsed(given.text), parsed(changed.text), ())}


def _differences(old: Any, new: Any, path: Path) -> Iterator[tuple[Path, Any]]:
    """Paths of keys below a path at which two values differ, each with the new value."""
    if old == new:
        return
    before, after = _named(old), _named(new)
    are_tables = isinstance(before, Mapping) and isinstance(after, Mapping)
    if path and not (are_tables and before.keys() <= after.keys()):
        yield path, new
        return
    yield from (((*path, key), None) for key in before if key not in after)
    for key, value in after.items():
        if key in before:
            yield from _differences(before[key], value, (*path, key))
        elif value != {}:  # an empty table is one that was left out
            yield (*path, key), value


def _named(value: Any) -> Any:
    """A list of tables with names as a mapping of names; other values as they are."""
    if isinstance(value, list) and value and all(isinstance(each, Mapping) and "name" in each for each in value):
        return {each["name"]: each for each in value}
    return value


def in_toml(changes: Mapping[str, Any]) -> list[str]:
    """A line ``key = value`` for each change, as TOML and ``--set`` take it; removed keys are marked as left out."""
    return [f"{key}: left out" if value is None else f"{key} = {_value(value)}" for key, value in changes.items()]


def _value(value: Any) -> str:
    """A value in one line of TOML."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_value(inner)}" for key, inner in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_value(inner) for inner in value) + "]"
    return f"{value:.10g}" if isinstance(value, float) else json.dumps(value, ensure_ascii=False)


def value_at(case: Case, key: str) -> Any:
    """The value of a case at a dotted key, also one that was left out; loads, monitors, holes by name or number.

    Raises CaseError for a key that no such case has.
    """
    first, *others = key.split(".")
    value = every_key(_inner(case.tables, first, key))
    for name in others:
        value = _inner(value, name, key)
    return value


def _inner(table: Any, name: str, key: str) -> Any:
    """The value with this name in a table."""
    if isinstance(table, Sequence) and not isinstance(table, str):
        named = _named(list(table))
        numbered = {str(number): each for number, each in enumerate(table, start=1)}
        table = {**numbered, **(named if isinstance(named, Mapping) else {})}
    if not isinstance(table, Mapping) or name not in table:
        known = f"; here: {', '.join(table)}" if isinstance(table, Mapping) and table else ""
        raise CaseError([f"--keep: {key} is no key of this case, at {name}{known}"])
    return table[name]


def keeps(given: Case, changed: Case, keys: Iterable[str]) -> bool:
    """Whether a changed case has the values of the given one at some keys."""
    return all(_or_none(changed, key) == value_at(given, key) for key in keys)


def _or_none(case: Case, key: str) -> Any:
    """The value at a key; None where a changed case has no such key."""
    try:
        return value_at(case, key)
    except CaseError:
        return None


WAVE_SAMPLES = 1000
"""Samples of every wave in a digest, so that it depends on the contents of files, too."""

NO_RESULTS = ("title", "chart", "sweep")
"""Tables and keys of a case that its results do not depend on."""


COARSER = (1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 10.0)
"""Factors tried for radii and spacings in charts; those that do not divide the scene into whole bricks or cells are
left out."""

FEW = 2
"""Number of coarser radii or spacings in charts."""

OWN = "as in the case"
"""Name of the choice without changes."""

Named = Iterator[tuple[str, dict[str, Any]]]
"""Names of choices, and the keys they change."""

AnyCase = TypeVar("AnyCase", bound=Case)


@dataclass(frozen=True)
class Choice(Generic[AnyCase]):
    """A change of a case.

    name : in words. changes : new values by dotted key, None for keys left out, as `with_changes` takes them. case :
    the changed case.
    """

    name: str
    changes: Mapping[str, Any]
    case: AnyCase

    @classmethod
    def of(cls, given: Case, case: AnyCase, name: str) -> Self:
        """The choice that makes a case of the given one."""
        return cls(name, differences(given, case), case)

    @property
    def toml(self) -> list[str]:
        """A line of TOML for each key that it changes."""
        return in_toml(self.changes)


def choices_of(case: AnyCase, named: Mapping[str, Mapping[str, Any]]) -> tuple[list[Choice[AnyCase]], list[str]]:
    """The choices whose changed cases are valid, and a line for each of the others.

    named : changes of keys by the name of the choice, see `with_changes`. Two choices that make the same case count
    once. Raises CaseError with these lines if no choice is valid.
    """
    made: dict[str, Choice[AnyCase]] = {}
    left_out: list[str] = []
    for name, changes in named.items():
        try:
            choice = Choice(name, changes, with_changes(case, changes))
        except CaseError as error:
            left_out.append(f"{name}: left out, {'; '.join(error.problems)}")
            continue
        made.setdefault(digest(choice.case), choice)
    if not made:
        raise CaseError(left_out or ["--vary: is missing; there is no choice"], case.name)
    return list(made.values()), left_out


def combinations(case: Case, vary: Mapping[str, Sequence[Any]]) -> dict[str, dict[str, Any]]:
    """All combinations of the keys' values, by name; raises CaseError if they are more than a record may have."""
    if (count := math.prod(map(len, vary.values()))) > MOST_MEMBERS:
        raise CaseError([f"vary: makes {count:,} choices, must be {MOST_MEMBERS:,} or less"], case.name)
    rows = [dict(zip(vary, values, strict=True)) for values in product(*vary.values())]
    return {label(case, changes): changes for changes in rows}


def is_valid(case: Case, changes: Mapping[str, Any], use: Callable[[Any], object] = bool) -> bool:
    """Whether a changed case has no mistake, nor one that appears only when it is used (`use`, such as `build`)."""
    try:
        use(changed(case, changes))
    except CaseError:
        return False
    return True


def valid(case: Case, changes: Iterator[dict[str, Any]]) -> Iterator[dict[str, Any]]:
    """The first `FEW` of some changes that make valid cases."""
    return islice((change for change in changes if is_valid(case, change)), FEW)


def changed(case: AnyCase, changes: Mapping[str, Any]) -> AnyCase:
    """The case with some keys changed, itself without changes; raises CaseError for changes that are not valid."""
    return with_changes(case, changes) if changes else case


def digest(case: Case) -> str:
    """A hash that is equal for cases with equal results: same tables, waves and program version."""
    tables = {key: _filled(table) for key, table in tomllib.loads(case.text).items() if key not in NO_RESULTS}
    found = hashlib.sha256(json.dumps([__version__, tables], sort_keys=True).encode())
    times = np.linspace(0.0, case.run.duration, WAVE_SAMPLES)
    for wave in case.wave.values():
        found.update(np.ascontiguousarray(wave.velocity(times)).tobytes())
    return found.hexdigest()


def _filled(table: Any) -> Any:
    """A table without empty tables inside, which are equivalent to missing ones."""
    if not isinstance(table, dict):
        return table
    return {key: _filled(value) for key, value in table.items() if value != {}}


def parsed_options(options: Sequence[str]) -> dict[str, list[Any]]:
    """Keys and their values from options such as ``packing.radius=0.25,0.5``; values are TOML, or else plain text.

    A range such as ``1:20`` stands for its whole numbers, both ends included. Raises CaseError for an option that is
    not KEY=VALUE,… , for a key that is given twice, and for ranges as `range_of`.
    """
    found: dict[str, list[Any]] = {}
    for option in options:
        key, equals, text = option.partition("=")
        key, values = key.strip(), [value.strip() for value in _split(text)]
        if not equals or not key or not all(values):
            raise CaseError([f"--vary: is {option}, must be KEY=VALUE,VALUE,…, e.g. packing.radius=0.25,0.5"])
        if key in found:
            raise CaseError([f"--vary: has {key} twice, give all its values once"])
        given = [value_of(value, f"--vary {key}") for value in values]
        try:
            found[key] = [each for value in given for each in range_of(value) or [value]]
        except ValueError as error:
            raise CaseError([f"--vary: {key}: {error}"]) from None
    return found


def _split(text: str) -> Iterator[str]:
    """The parts of a text between commas that are not within brackets or quotes."""
    depth, quote, part = 0, "", ""
    for sign in text:
        if quote:
            quote = "" if sign == quote else quote
        elif sign in "\"'":
            quote = sign
        else:
            depth += (sign in "[{") - (sign in "]}")
        if sign == "," and depth == 0 and not quote:
            yield part
            part = ""
        else:
            part += sign
    yield part
