"""Dotted keys of cases: their places in the tables, and tables with some keys changed."""

from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from dembound.casefile.messages import unknown
from dembound.casefile.toml import DEEPEST
from dembound.errors import CaseError


def applied(data: dict[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """The tables of a case with the values at dotted keys replaced, added, or with None left out; `data` is changed.

    Missing tables are created. A table in a list is named by its name or its number, from 1: ``load.blow.pressure``.

    Raises CaseError for keys that lead to no table.
    """
    for dotted, value in changes.items():
        *path, last = dotted.split(".")
        if not all((*path, last)):
            raise CaseError([f"{dotted}: is no key, must be names with one dot between two, such as run.duration"])
        if len(path) > DEEPEST:
            raise CaseError([f"{dotted[:40]}…: has {len(path)} dots, must have at most {DEEPEST}"])
        table: Any = data
        for name in path:
            table = _inner(table, name, dotted)
        key = _key(table, last, dotted)
        table[key] = deepcopy(value)  # as a later change may modify it
        if value is None:
            del table[key]  # which may not have been there, either
    return data


def _inner(table: Any, name: str, dotted: str) -> Any:
    """The table, or list of tables, with this name; a missing table is created."""
    key = _key(table, name, dotted)
    inner = table.setdefault(key, {}) if isinstance(table, dict) else table[key]
    tables = inner if isinstance(inner, list) else [inner]
    if not tables or not all(isinstance(each, dict) for each in tables):
        raise CaseError([f"{dotted}: {name} is not a table"])
    return inner


def _key(table: Any, name: str, dotted: str) -> Any:
    """Key or index of a name in a table; in a list of tables it may be a table's name, or its number from 1."""
    if isinstance(table, dict):
        return name
    names = [str(each.get("name", "")) for each in table]
    numbers = [str(number) for number in range(1, len(table) + 1)]
    for known in (names, numbers):
        if name in known:
            return known.index(name)
    kind, _, _ = dotted.partition(".")
    raise CaseError([f"{dotted}: {unknown(kind, name, names)}, or a number up to {len(table)}"])
