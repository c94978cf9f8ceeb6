"""A case in a few lines, as Python shows it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from dembound.table import as_toml

if TYPE_CHECKING:
    from dembound.casefile.model import Case

MOST_LINES = 10

WIDTH = 100
"""Most characters of a line."""

NAMING = ("name", "type")
"""Keys that stand for a table among several."""


def in_lines(case: Case) -> list[str]:
    """Up to `MOST_LINES` lines: name and title, and of each table that is not empty the keys that are given."""
    given = {name: as_toml(table) for name, table in case.tables.items() if name != "title"}
    tables = {name: table for name, table in given.items() if table not in (None, {}, [])}
    shown = MOST_LINES - 1 if len(tables) < MOST_LINES else MOST_LINES - 2
    lines = [f"{type(case).__name__} {case.name}" + (f": {case.title}" if case.title else "")]
    lines += [f"  {name}: {', '.join(_parts(table))}" for name, table in list(tables.items())[:shown]]
    if len(tables) > shown:
        lines.append(f"  and {', '.join(list(tables)[shown:])}")
    return [line if len(line) <= WIDTH else f"{line[: WIDTH - 1]}…" for line in lines]


def _parts(table: Any) -> Iterator[str]:
    """The keys of a table with their values; of several tables their names and types."""
    if isinstance(table, Mapping):
        for key, value in table.items():
            named = isinstance(value, Mapping)
            yield f"{key} {value.get('type', '') if named else _plain(value)}".rstrip()
    else:
        for each in table:
            yield " ".join(str(each[key]) for key in NAMING if key in each) or ", ".join(_parts(each))


def _plain(value: Any) -> str:
    """A value, numbers without needless digits."""
    if isinstance(value, list):
        return f"[{', '.join(map(_plain, value))}]"
    return f"{value:g}" if isinstance(value, float) else str(value)
