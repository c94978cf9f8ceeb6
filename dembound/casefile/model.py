"""The case: those tables of a file that all kinds of bodies have."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, TypeVar

import tomli_w

from dembound.boundaries import Boundary, Free, Motion
from dembound.casefile.chart import Chart
from dembound.casefile.output import Output
from dembound.casefile.run import Run
from dembound.casefile.sweep import Sweep
from dembound.errors import CaseError
from dembound.table import as_toml, every_key
from dembound.waves import Wave

MOST_LINES = 10
"""Largest number of lines in which Python shows a case."""

WIDTH = 100
"""Largest number of characters in a line of a case."""

NAMING = ("name", "type")
"""Keys that identify a table among several."""


@dataclass(frozen=True, kw_only=True, repr=False)
class Case:
    """All tables of one case. Cases made by `schemas.load` and `schemas.loads` are checked.

    Attributes
    ----------
    title : one line for pictures and reports; may be empty.
    boundary : side -> table, in the order left, right, bottom, top; an absent side is free.
    wave : name -> table.
    load, monitor : in the order of the file.
    run, output, chart, sweep : the tables of these names.
    name : of the results; the file's name without folder and ending, unless another one is given.
    origin : the first of these names, which it keeps; a run checks by it that it does not replace another case's
    results. silent : waves without motion during the run, as inputs of a library without a record.
    folder : where relative paths in the case start.
    text : the TOML text the case was read from; for a case made in another way, an equivalent text. checked : the
    tables that have been read from `text` and checked against each other, by field.

    Two cases are equal if their tables are equal; the last six attributes are not compared.
    """

    title: str = ""
    boundary: Mapping[str, Boundary] = field(default_factory=dict)
    wave: Mapping[str, Wave] = field(default_factory=dict)
    load: tuple[Any, ...] = ()
    monitor: tuple[Any, ...] = ()
    run: Run
    output: Output = field(default_factory=Output)
    chart: Chart = field(default_factory=Chart)
    sweep: Sweep = field(default_factory=Sweep)
    name: str = field(default="case", compare=False)
    origin: str = field(default="", compare=False, repr=False)
    silent: frozenset[str] = field(default=frozenset(), compare=False, repr=False)
    folder: Path = field(default=Path(), compare=False)
    text: str = field(default="", compare=False, repr=False)
    checked: Mapping[str, Any] | None = field(default=None, compare=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "origin", self.origin or self.name)
        if not self.is_checked:  # also a case changed by `dataclasses.replace`
            given = {name: as_toml(table) for name, table in self.tables.items()}
            text = tomli_w.dumps({name: table for name, table in given.items() if table not in (None, "", {}, [])})
            object.__setattr__(self, "text", text)
            object.__setattr__(self, "checked", None)

    def __repr__(self) -> str:
        return "\n".join(in_lines(self))

    @property
    def tables(self) -> dict[str, Any]:
        """The tables, by field."""
        shared = {each.name for each in fields(Case)}
        own_first = sorted(fields(self), key=lambda each: each.name in shared)
        return {each.name: getattr(self, each.name) for each in own_first if each.compare}

    @property
    def is_checked(self) -> bool:
        """Whether its tables are still those that have been checked."""
        checked = self.checked
        return checked is not None and all(table is checked[name] for name, table in self.tables.items())

    @property
    def keys(self) -> dict[str, Any]:
        """The tables with all keys, also those that were left out, as plain JSON values."""
        return {name: every_key(table) for name, table in self.tables.items()}

    @property
    def files(self) -> dict[str, str]:
        """Texts of the files that the case refers to, by their paths in it."""
        return {path: text for wave in self.wave.values() for path, text in wave.files().items()}

    def side(self, name: str) -> Boundary:
        """The table of a side; one that is absent is free."""
        return self.boundary.get(name, FREE)

    @property
    def file(self) -> Path | None:
        """The file of its name in its folder; None if there is no such file."""
        path = self.folder / f"{self.name}.toml"
        return path if path.is_file() else None

    @property
    def driving(self) -> dict[str, dict[Motion, str]]:
        """The waves that drive sides: side -> kind of wave -> name."""
        return {side: dict(table.waves) for side, table in self.boundary.items() if table.waves}

    @property
    def entering(self) -> set[str]:
        """Names of the waves that enter from outside, through driven sides or at an angle."""
        return {name for waves in self.driving.values() for name in waves.values()}


FREE = Free()

K = TypeVar("K", bound=Case)


def as_kind(case: Case, kind: type[K], otherwise: str, source: str = "") -> K:
    """The case, if it is of a kind; else raises CaseError with the message `otherwise`.

    source : what the message is about, by default the case's name.
    """
    if not isinstance(case, kind):
        raise CaseError([otherwise], source or case.name)
    return case


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
