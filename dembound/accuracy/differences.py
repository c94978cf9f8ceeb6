"""Keys and values in which a changed case differs from a given one, as `with_changes` takes them."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from dembound.casefile import Case
from dembound.casefile.toml import parsed
from dembound.errors import CaseError
from dembound.table import every_key

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
    if path and not _may_be_changed_inside(before, after):
        yield path, new
        return
    yield from (((*path, key), None) for key in before if key not in after)
    for key, value in after.items():
        if key in before:
            yield from _differences(before[key], value, (*path, key))
        elif value != {}:  # an empty table is one that was left out
            yield (*path, key), value


def _may_be_changed_inside(old: Any, new: Any) -> bool:
    """Whether both are tables, and the new one has all keys of the old one."""
    return isinstance(old, Mapping) and isinstance(new, Mapping) and old.keys() <= new.keys()


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
        table = {str(number): each for number, each in enumerate(table, start=1)} | (
            _named(list(table)) if isinstance(_named(list(table)), Mapping) else {}
        )
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
