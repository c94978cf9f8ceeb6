"""The case: the tables of a file, checks between them, and the list of tables of each kind of body."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, TypeVar

import tomli_w
from pydantic import TypeAdapter

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import SIDES, Motion
from dembound.boundaries.free import Free
from dembound.boundaries.platen import driven_components
from dembound.casefile.messages import choices, numbered, show
from dembound.casefile.tables import Chart, Output, Run, Sweep
from dembound.casefile.types import WaveTable
from dembound.errors import CaseError
from dembound.table import as_toml, every_key
from dembound.waves.wave import Wave

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

    @property
    def moving(self) -> set[str]:
        """Names of the waves by which walls move; by default there are none."""
        return set()

    @property
    def pull(self) -> float:
        """The largest acceleration (m/s²) of steady loads; 0 by default."""
        return 0.0

    @property
    def last_change(self) -> float:
        """Time (s) from which the case changes nothing but by waves; by default it never does."""
        return 0.0


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


Tables = Mapping[str, Any]
"""The tables of a case by name; one that is invalid is None."""

MOST_MONITORS = 1000
"""Largest number of monitors: their records are checked for damage within seconds, see `results.structure`."""


def unknown_waves(named: Iterable[tuple[str, str]], waves: Mapping[str, object]) -> Iterator[str]:
    """Keys that name a wave the case does not define; named : key -> name of the wave."""
    for place, name in named:
        if name not in waves:
            defined = f"defined: {choices(name, waves)}" if waves else "none is defined"
            yield f"{place}: {show(name)} is not a wave of this case; {defined}"


def driving_waves(sides: Mapping[str, Boundary | None]) -> Iterator[tuple[str, str]]:
    """Keys of sides that name a wave -> its name."""
    for side, table in sides.items():
        for motion, name in table.waves.items() if table else ():
            yield f"boundary.{side}.wave_{motion}", name


def monitor_problems(tables: Tables) -> Iterator[str]:
    """Groups, holes, loads or monitors whose results would overwrite one another, and too many monitors."""
    for key in ("group", "hole", "wall", "load", "monitor"):
        first: dict[str, int] = {}
        for number, table in enumerate(tables.get(key, ()), start=1):
            if table and first.setdefault(table.name, number) != number:
                yield f"{key}[{number}].name: {show(table.name)} is taken by {key}[{first[table.name]}]"
    if (count := len(tables["monitor"])) > MOST_MONITORS:
        yield f"monitor: there are {count:,}, must be {MOST_MONITORS:,} or less; snapshots have all places"


def never_estimated(tables: Tables) -> Iterator[str]:
    """A request for errors at monitors in a case without monitors, or with means over polygons."""
    for place, monitor in numbered("monitor", tables["monitor"] if tables["output"].estimate else ()):
        if getattr(monitor, "points", None):
            yield f"output.estimate: is true, but errors of means over polygons are not known; leave {place}.points out"
    if tables["output"].estimate and not tables["monitor"]:
        yield "output.estimate: is true, but the case has no monitor whose error could be estimated; give a [[monitor]]"


def run_problems(tables: Tables) -> Iterator[str]:
    """Time step and intervals that are longer than the run, and ends before its duration that cannot come.

    A run may end once its monitors are at rest, or after the peak of the forces on driven sides.
    """
    run, output, sides = tables["run"], tables["output"], tables["boundary"]
    most = f"must be at most run.duration, {run.duration:g} (s)"
    if run.time_step != "auto" and run.time_step > run.duration:
        yield f"run.time_step: is {run.time_step:g}, {most}"
    for key in ("history_interval", "side_interval", "energy_interval"):
        if output and (interval := getattr(output, key)) > run.duration:
            yield f"output.{key}: is {interval:g}, {most}"
    if run.until == "silent" and not tables["monitor"]:
        yield f'run.until: is "{run.until}", but the case has no monitor; give a [[monitor]]'
    if run.until == "peak" and None not in sides.values() and not any(True for _ in driven_components(sides)):
        yield 'run.until: is "peak", but no side prescribes the motion of a wave; give one type = "velocity"'
    for key in ("silent_for", "peak_for", "rest_for"):
        if (time := getattr(run, key)) is not None and time > run.duration:
            yield f"run.{key}: is {time:g}, {most}"


WAVE: TypeAdapter[Any] = TypeAdapter(WaveTable)


@dataclass(frozen=True)
class Schema:
    """The tables of one kind of case, by the names of its fields.

    Attributes
    ----------
    case : the class of such cases.
    noun : "disks" or the like, for messages.
    new : the command that writes such a case.
    marks : tables of which a file of this kind has at least one, and a file of a kind named later has none.
    tables : those that occur once.
    side : type of [boundary.SIDE]; sides : the names of the sides.
    lists : those that may occur any number of times.
    problems : finds mistakes between tables, from the tables and the file's data. optional : those that may be absent.
    staged : those that may be absent and have their own sides: the table, and the type of its boundary.SIDE.
    completed : the tables of a file with keys that follow from other tables, and what these lack for that. completing :
    by table, the list from whose entries they follow where each gives them. expanded : the validated tables, invalid
    ones None, with single entries in place of those that stand for several, and the mistakes of these.
    """

    case: type[Case]
    noun: str
    new: str
    marks: tuple[str, ...]
    tables: Mapping[str, TypeAdapter[Any]]
    side: TypeAdapter[Any]
    lists: Mapping[str, TypeAdapter[Any]]
    problems: Callable[[Tables, Mapping[str, Any]], Iterator[str]]
    sides: tuple[str, ...] = SIDES
    optional: Mapping[str, TypeAdapter[Any]] = field(default_factory=dict)
    staged: Mapping[str, tuple[TypeAdapter[Any], TypeAdapter[Any]]] = field(default_factory=dict)
    completed: Callable[[Tables], tuple[Tables, list[str]]] = lambda data: (data, [])
    completing: Mapping[str, str] = field(default_factory=dict)
    expanded: Callable[[dict[str, Any]], tuple[dict[str, Any], list[str]]] = lambda tables: (tables, [])

    @property
    def keys(self) -> list[str]:
        """All keys allowed at the top level of a file, in the order of messages."""
        last = ("run", "output", "chart", "sweep")
        first = [key for key in self.tables if key not in last]
        return ["title", *first, "boundary", *self.staged, *self.optional, "wave", *self.lists, *last]
