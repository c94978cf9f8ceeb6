"""Dotted keys of cases, and the statements of a TOML text, with the lines they stand on."""

import re
import tomllib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass
from typing import Any, Literal

from dembound.casefile.messages import unknown
from dembound.casefile.reader import DEEPEST
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


Place = tuple[str | int, ...]
"""Keys that lead to a table or value; a number is a position in a list, from 0."""

CLOSING = re.compile(r"""[\]}]|\"\"\"|'''""")
"""Characters that close a value of several lines."""

PLAIN = re.compile(r"\s*([A-Za-z0-9_-]+)\s*=")
"""One key without quotes, as nearly all are."""


@dataclass(frozen=True)
class Statement:
    """A header or a key with its value, on the lines from `begin` to before `end`.

    table : the place of the table in whose section it stands, of a header its own place; place : that of the table or
    value itself, further in than `table` by one key, or by more of a dotted one.
    """

    kind: Literal["header", "key"]
    table: Place
    place: Place
    begin: int
    end: int


def lines_of(text: str) -> list[str]:
    """The lines of a text with their ends, of one character or two."""
    return re.findall(r"[^\n]*\n|[^\n]+", text)


def statements_of(lines: list[str]) -> list[Statement]:
    """The statements of a text that is TOML."""
    return list(_statements(lines))


def _statements(lines: list[str]) -> Iterator[Statement]:
    counts: dict[Place, int] = {}
    table: Place = ()
    begin = 0
    while begin < len(lines):
        first = lines[begin].strip()
        if not first or first.startswith("#"):
            begin += 1
        elif first.startswith("["):
            table = _table_of(lines[begin], counts)
            yield Statement("header", table, table, begin, begin + 1)
            begin += 1
        else:
            end = _end_of(lines, begin)
            yield Statement("key", table, table + keys_of("".join(lines[begin:end])), begin, end)
            begin = end


def _table_of(header: str, counts: dict[Place, int]) -> Place:
    """The place of the table that a header begins; counts : headers so far of each list of tables."""
    keys = _only_keys(tomllib.loads(header))
    in_list = header.strip().startswith("[[")
    place: Place = ()
    for number, key in enumerate(keys, start=1):
        place = (*place, key)
        if in_list and number == len(keys):
            counts[place] = counts.get(place, 0) + 1
        if place in counts:
            place = (*place, counts[place] - 1)
    return place


def _only_keys(tables: Any) -> list[str]:
    """The keys of tables of one key each, from outside."""
    keys = []
    while tables:
        if isinstance(tables, list):
            tables = tables[0]
            continue
        ((key, tables),) = tables.items()
        keys.append(key)
    return keys


def _end_of(lines: list[str], begin: int) -> int:
    """The line after the value of the key that begins on a line: the first at which the text so far is TOML."""
    for end in range(begin + 1, len(lines)):
        if end == begin + 1 or CLOSING.search(lines[end - 1]):
            try:
                tomllib.loads("".join(lines[begin:end]))
            except tomllib.TOMLDecodeError:
                continue
            return end
    return len(lines)


def keys_of(statement: str) -> tuple[str, ...]:
    """The keys before the equals sign, several of a dotted key."""
    if plain := PLAIN.match(statement):
        return (plain[1],)
    import tomlkit

    ((key, item),) = [(key, item) for key, item in tomlkit.parse(statement).body if key is not None]
    keys = [key.key]
    while key.is_dotted():
        ((key, item),) = [(key, inner) for key, inner in item.value.body if key is not None]
        keys.append(key.key)
    return tuple(keys)
