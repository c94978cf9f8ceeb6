"""From a TOML file to a `Case`, or to the list of everything wrong with it."""

import re
import tomllib
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter, ValidationError
from pydantic_core import to_json

from dembound.boundaries import SIDES, BarEndTable, BoundaryTable
from dembound.case.bar import Bar
from dembound.case.bar_load import BarLoad
from dembound.case.bar_monitor import BarMonitor
from dembound.case.bar_problems import bar_problems
from dembound.case.bar_run import BarRun
from dembound.case.load import Load
from dembound.case.material import Material
from dembound.case.model import BarCase, Case, DiskCase
from dembound.case.monitor import Monitor
from dembound.case.motion import Motion
from dembound.case.output import Output
from dembound.case.problems import problems_between
from dembound.case.run import Run
from dembound.case.sentences import describe, show, unknown
from dembound.case.static import Static, StaticSide
from dembound.errors import CaseError
from dembound.holes import HoleTable
from dembound.methods import MethodTable
from dembound.packings import PackingTable
from dembound.waves import WaveTable

TABLES: Mapping[type[Case], Mapping[str, TypeAdapter[Any]]] = {
    DiskCase: {
        "packing": TypeAdapter(PackingTable),
        "material": TypeAdapter(Material),
        "motion": TypeAdapter(Motion),
        "run": TypeAdapter(Run),
        "output": TypeAdapter(Output),
    },
    BarCase: {
        "bar": TypeAdapter(Bar),
        "method": TypeAdapter(MethodTable),
        "run": TypeAdapter(BarRun),
        "output": TypeAdapter(Output),
    },
}
"""The tables of which a case of each kind has one."""
TITLE: TypeAdapter[Any] = TypeAdapter(str)
BOUNDARY: TypeAdapter[Any] = TypeAdapter(BoundaryTable)
STATIC: TypeAdapter[Any] = TypeAdapter(Static)
STATIC_SIDE: TypeAdapter[Any] = TypeAdapter(StaticSide)
WAVE: TypeAdapter[Any] = TypeAdapter(WaveTable)
HOLE: TypeAdapter[Any] = TypeAdapter(HoleTable)
LOAD: TypeAdapter[Any] = TypeAdapter(Load)
MONITOR: TypeAdapter[Any] = TypeAdapter(Monitor)
BAR_END: TypeAdapter[Any] = TypeAdapter(BarEndTable)
BAR_LOAD: TypeAdapter[Any] = TypeAdapter(BarLoad)
BAR_MONITOR: TypeAdapter[Any] = TypeAdapter(BarMonitor)
ORDER = (
    *("title", "bar", "method", "packing", "material", "motion", "boundary", "static", "wave"),
    *("hole", "load", "monitor", "run", "output"),
)
"""All that may stand at the top level of a case file, in the order messages name it."""

ENDS = ("left", "right")
"""The sides of a bar."""

NEITHER = "has neither [packing] (disks) nor [bar]; `dembound new` and `dembound new --bar` write a case to start from"
"""What is wrong with a file that does not say what its case is of."""


def load(path: Path) -> Case:
    """Read a case file.

    Raises
    ------
    CaseError
        With one line per mistake. A file that is absent, not TOML, or neither of disks nor of a bar shows only that.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise CaseError(["no such file"], str(path)) from None
    except UnicodeDecodeError:
        raise CaseError(["is not a text file in UTF-8"], str(path)) from None
    except OSError as error:
        raise CaseError([f"cannot be read: {error.strerror}"], str(path)) from None
    return _read(text, path.parent, path.stem, str(path))


def loads(text: str, folder: Path = Path(), name: str = "case") -> Case:
    """Read a case from TOML text, as if it stood in the file `name` of the folder; errors as `load`."""
    return _read(text, folder, name, name)


def _read(text: str, folder: Path, name: str, source: str) -> Case:
    """The case; `source` is how errors call the text."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise CaseError([_syntax_problem(str(error), text)], source) from None
    if not {"packing", "bar", "method"} & data.keys():
        strange = [f"{key}: {unknown('table', key, ORDER)}" for key in data if key not in ORDER]
        raise CaseError([*strange, NEITHER], source)
    kind: type[Case] = BarCase if "bar" in data or "method" in data else DiskCase
    tables, problems = _Reader(folder, kind).read(data)
    if problems:
        raise CaseError(problems, source)
    return kind(**tables, name=name, text=text, folder=folder)


def _syntax_problem(message: str, text: str) -> str:
    """Tomllib's message with the line first: ``line 7: … in: period = fast``."""
    place = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)$", message)
    if not place:
        return message
    what = message[: place.start()]
    if not place[1]:
        return f"at the end: {what}"
    return f"line {place[1]}: {what}, in: {text.splitlines()[int(place[1]) - 1].strip()}"


def _stray(key: str, data: Mapping[str, Any], keys: list[str]) -> str:
    """Say that a table has no place in a case of this kind, whose tables are called `keys`."""
    if key not in ORDER:
        return f"{key}: {unknown('table', key, keys)}"
    mark = "bar" if "bar" in data else "method"  # one of them is there, as cases of disks may have all others
    return f"{key}: is for disks, but [{mark}] makes this the case of a bar; allowed: {', '.join(keys)}"


class _Reader:
    """Validates table by table, so that a mistake in one hides none in the others."""

    def __init__(self, folder: Path, kind: type[Case]) -> None:
        self.folder = folder
        self.kind = kind
        self.problems: list[str] = []

    def read(self, data: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
        """The fields of a case, None for what is invalid, and all problems."""
        known = {field.name for field in fields(self.kind) if field.compare}
        keys = [key for key in ORDER if key in known]
        self.problems = [_stray(key, data, keys) for key in data if key not in keys]
        tables = {"title": self._valid("title", data.get("title", ""), TITLE)}
        for key, kind in TABLES[self.kind].items():
            tables[key] = self._valid(key, data.get(key, {}), kind)
        tables["wave"] = self._named("wave", data.get("wave", {}), WAVE)
        if self.kind is BarCase:
            tables["boundary"] = self._sides("boundary", data.get("boundary", {}), BAR_END, ENDS)
            tables["load"] = self._numbered("load", data.get("load", []), BAR_LOAD)
            tables["monitor"] = self._numbered("monitor", data.get("monitor", []), BAR_MONITOR)
            self.problems += bar_problems(tables)
        else:
            tables["boundary"] = self._sides("boundary", data.get("boundary", {}), BOUNDARY)
            tables["static"] = self._static(data["static"]) if "static" in data else None
            tables["hole"] = self._numbered("hole", data.get("hole", []), HOLE)
            tables["load"] = self._numbered("load", data.get("load", []), LOAD)
            tables["monitor"] = self._numbered("monitor", data.get("monitor", []), MONITOR)
            self.problems += problems_between(tables, data)
        return tables, self.problems

    def _valid(self, path: str, raw: object, kind: TypeAdapter[Any]) -> Any | None:
        """The validated table; None, and its mistakes noted, if it is invalid.

        Strict JSON takes a list for a tuple and a whole number for a float, but no text or bool for a number.
        """
        try:
            json = to_json(raw, inf_nan_mode="constants")
            return kind.validate_json(json, strict=True, context={"folder": self.folder})
        except ValidationError as error:
            self.problems += describe(error, path, raw, kind.json_schema())
            return None

    def _named(self, path: str, raw: object, kind: TypeAdapter[Any]) -> dict[str, Any]:
        """A table of named tables."""
        if not isinstance(raw, Mapping):
            self.problems.append(f"{path}: is {show(raw)}, must be made of tables [{path}.NAME]")
            return {}
        return {name: self._valid(f"{path}.{name}", table, kind) for name, table in raw.items()}

    def _sides(self, path: str, raw: object, kind: TypeAdapter[Any], sides: tuple[str, ...] = SIDES) -> dict[str, Any]:
        """The tables of sides, in the order of the sides."""
        if isinstance(raw, Mapping):
            strange = [name for name in raw if name not in sides]
            self.problems += [f"{path}.{name}: {unknown('side', name, sides)}" for name in strange]
            raw = {side: raw[side] for side in sides if side in raw}
        return self._named(path, raw, kind)

    def _static(self, raw: object) -> Static | None:
        """The static stage. Its sides are validated one by one, and an invalid one is None in it."""
        if not isinstance(raw, Mapping):
            return self._valid("static", raw, STATIC)
        sides = self._sides("static.boundary", raw.get("boundary", {}), STATIC_SIDE)
        static = self._valid("static", {key: value for key, value in raw.items() if key != "boundary"}, STATIC)
        return static and static.model_copy(update={"boundary": sides})

    def _numbered(self, key: str, raw: object, kind: TypeAdapter[Any]) -> tuple[Any, ...]:
        """The tables of a list, counted from 1 in error texts."""
        if not isinstance(raw, list):
            self.problems.append(f"{key}: is {show(raw)}, must be made of tables [[{key}]]")
            return ()
        paths = []
        for number, table in enumerate(raw, start=1):
            named = isinstance(table, Mapping) and isinstance(table.get("name"), str)
            paths.append(f"{key}[{number}, {table['name']}]" if named else f"{key}[{number}]")
        return tuple(self._valid(path, table, kind) for path, table in zip(paths, raw, strict=True))
