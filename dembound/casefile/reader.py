"""TOML text to a `Case`, or to the list of its mistakes."""

import re
import tomllib
from collections.abc import Collection, Iterator, Mapping, Sequence
from datetime import date, time
from functools import cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, TypeAdapter, ValidationError
from pydantic_core import to_json

from dembound.casefile.messages import describe, places, show, unknown
from dembound.casefile.model import WAVE, Case, Schema
from dembound.errors import CONTROL, CaseError
from dembound.table import usable

DEEPEST = 30
"""Largest number of keys and list positions on the way to a value. The deepest of a case are below ten."""

SHOWN = 80
"""Characters of a line with a mistake that are shown."""


class NotTomlError(CaseError):
    """A text that is not TOML."""


def parsed(text: str, source: str = "") -> dict[str, Any]:
    """The tables of a TOML text; source : its name in errors.

    Raises CaseError for a text that is not TOML, is nested too deeply, or contains a date or time, which no key has.
    """
    return allowed(_parsed(text, source), source)


def allowed(data: dict[str, Any], source: str = "") -> dict[str, Any]:
    """The tables of parsed TOML; raises CaseError for values that `parsed` refuses."""
    if problems := list(_problems(data)):
        raise CaseError(problems, source)
    return data


def value_of(text: str, key: str) -> Any:
    """A text as a TOML value, or if it is none the text itself, without blanks around it.

    key : its name in errors. Raises CaseError for values that `parsed` refuses.
    """
    try:
        value = _parsed(f"value = {text}", key)["value"]
    except NotTomlError:
        return text.strip()
    if problems := list(_problems({key: value})):
        raise CaseError(problems)
    return value


def _parsed(text: str, source: str) -> dict[str, Any]:
    """The tables of a text with any values; raises the errors of `parsed`."""
    try:
        text.encode()
        return tomllib.loads(text)
    except UnicodeEncodeError:
        raise CaseError(["has characters that are not text in UTF-8"], source) from None
    except tomllib.TOMLDecodeError as error:
        raise NotTomlError([_syntax_problem(str(error), text)], source) from None
    except RecursionError:
        raise CaseError([f"is nested more than {DEEPEST} deep, deeper than any case"], source) from None
    except ValueError:  # of Python, which converts no more digits
        raise CaseError(["has a number of more than 4000 digits"], source) from None


def _problems(data: Mapping[str, Any]) -> Iterator[str]:
    """Values that no key of a case has, each with its place; found without recursion, however deep."""
    waiting: list[tuple[str, Any, int]] = [(key, value, 1) for key, value in data.items()]
    while waiting:
        place, value, depth = waiting.pop()
        if depth > DEEPEST:
            yield f"{re.split(r'[.[]', place)[0]}: is nested more than {DEEPEST} deep, deeper than any key of a case"
            return
        if isinstance(value, Mapping):
            waiting += [(f"{place}.{key}", inner, depth + 1) for key, inner in value.items()]
        elif isinstance(value, list):
            waiting += [(f"{place}[{number}]", inner, depth + 1) for number, inner in enumerate(value, start=1)]
        elif isinstance(value, date | time):
            yield f"{place}: is a date or time, must be a number, a text, true or false, a list or a table"


def _syntax_problem(message: str, text: str) -> str:
    """Tomllib's message with the line first: ``line 7: … in: period = fast``."""
    place = re.search(r" \(at (?:line (\d+), column \d+|end of document)\)$", message)
    if not place:
        return message
    what = message[: place.start()]
    if not place[1]:
        return f"at the end: {what}"
    return f"line {place[1]}: {what}, in: {text.split(chr(10))[int(place[1]) - 1].strip()[:SHOWN]}"


TITLE: TypeAdapter[Any] = TypeAdapter(Annotated[str, AfterValidator(usable)])


def load(path: Path, schemas: Sequence[Schema]) -> Case:
    """Read a case file of one of the kinds given by the schemas; see `Schema.marks`.

    Raises
    ------
    CaseError
        With one line per mistake. For a file that is absent, not TOML, or of none of these kinds there is only this
        line.
    """
    try:
        text = path.read_text(encoding="utf-8-sig")  # without the byte order mark of some editors
    except FileNotFoundError:
        raise CaseError([f"{path}: no such file"]) from None
    except UnicodeDecodeError:
        raise CaseError([f"{path}: is not a text file in UTF-8"]) from None
    except OSError as error:
        raise CaseError([f"{path}: cannot be read: {error.strerror}"]) from None
    except ValueError:
        raise CaseError([f"{path}: is not the path of a file"]) from None
    return case_of_tables(parsed(text, str(path)), text, schemas, path.parent, path.stem, str(path))


def loads(
    text: str,
    schemas: Sequence[Schema],
    folder: Path = Path(),
    name: str = "case",
    files: Mapping[str, str] | None = None,
) -> Case:
    """Read a case from TOML text, as if it were the file `name` in the folder; errors as `load`.

    files : texts of files that the case refers to, by their paths in it, in place of files in the folder.
    """
    return case_of_tables(parsed(text, name), text, schemas, folder, name, files=files)


def case_of_tables(
    data: Mapping[str, Any],
    text: str,
    schemas: Sequence[Schema],
    folder: Path,
    name: str,
    source: str = "",
    files: Mapping[str, str] | None = None,
) -> Case:
    """The case of the tables that a TOML text contains; errors as `loads`. source : name of the text in them."""
    source = source or name
    if CONTROL.search(name):
        raise CaseError(["has a name with control characters or bytes that are not text, rename it"], source)
    schema = next((schema for schema in schemas if not data.keys().isdisjoint(schema.marks)), None)
    known = list(dict.fromkeys(key for each in schemas for key in each.keys))  # no mapping
    if schema is None:
        strange = [f"{key}: {unknown('table', key, known)}" for key in data if key not in known]
        raise CaseError([*strange, _of_no_kind(schemas)], source)
    reader = _Reader(schema, {"folder": folder, "files": files or {}})
    reader.problems = [_stray(key, data, schema, known) for key in data if key not in schema.keys]
    tables = reader.read(data)
    if reader.problems:
        raise CaseError(reader.problems, source)
    return schema.case(**tables, name=name, folder=folder, text=text, checked=tables)


def _of_no_kind(schemas: Sequence[Schema]) -> str:
    """Message for a file whose tables do not identify the kind of its case."""
    kinds = " nor ".join(f"[{schema.marks[0]}] ({schema.noun})" for schema in schemas)
    return f"has neither {kinds}; {' and '.join(f'`{schema.new}`' for schema in schemas)} write a case to start from"


def _stray(key: str, data: Mapping[str, Any], schema: Schema, known: Collection[str]) -> str:
    """Message for a table that is not allowed in a case of this kind; known : the tables of all kinds."""
    if key not in known:
        return f"{key}: {unknown('table', key, schema.keys)}"
    mark = next(mark for mark in schema.marks if mark in data)
    return (
        f"{key}: is not allowed here, as [{mark}] makes this a case of {schema.noun}; allowed: {', '.join(schema.keys)}"
    )


@cache
def _json_schema(kind: TypeAdapter[Any]) -> dict[str, Any]:
    """JSON schema of a table; made once, as this takes ten times as long as reading a case."""
    return kind.json_schema()


class _Reader:
    """Validates table by table, so that the mistakes in all tables are found."""

    def __init__(self, schema: Schema, context: Mapping[str, Any]) -> None:
        self.schema = schema
        self.context = context
        self.problems: list[str] = []

    def read(self, data: Mapping[str, Any]) -> dict[str, Any]:
        """The fields of a case, None for invalid ones; collects all problems."""
        schema = self.schema
        data, lacking = schema.completed(data)
        self.problems += lacking
        tables = {"title": self._valid("title", data.get("title", ""), TITLE)}
        for key, kind in schema.tables.items():
            tables[key] = self._valid(key, data.get(key, {}), kind)
        tables["wave"] = self._named("wave", data.get("wave", {}), WAVE)
        tables["boundary"] = self._sides("boundary", data.get("boundary", {}), schema.side, schema.sides)
        for key, kind in schema.optional.items():
            tables[key] = self._valid(key, data[key], kind) if key in data else None
        for key, kinds in schema.staged.items():
            tables[key] = self._staged(key, data[key], *kinds) if key in data else None
        for key, kind in schema.lists.items():
            tables[key] = self._numbered(key, data.get(key, []), kind)
        tables, wrong = schema.expanded(tables)
        self.problems += [*wrong, *schema.problems(tables, data)]
        return tables

    def _valid(self, path: str, raw: object, kind: TypeAdapter[Any]) -> Any | None:
        """The validated table; None if it is invalid, in which case its mistakes are collected.

        Strict JSON accepts a list as a tuple and a whole number as a float, but no text or bool as a number.
        """
        try:
            json = to_json(raw, inf_nan_mode="constants")
            return kind.validate_json(json, strict=True, context=self.context)
        except ValidationError as error:
            self.problems += describe(error, path, raw, _json_schema(kind))
            return None

    def _named(self, path: str, raw: object, kind: TypeAdapter[Any]) -> dict[str, Any]:
        """A table of named tables."""
        if not isinstance(raw, Mapping):
            self.problems.append(f"{path}: is {show(raw)}, must be tables by name, [{path}.NAME] in TOML")
            return {}
        self.problems += [f"{path}.{name}: has control characters in its name" for name in raw if CONTROL.search(name)]
        return {name: self._valid(f"{path}.{name}", table, kind) for name, table in raw.items()}

    def _sides(self, path: str, raw: object, kind: TypeAdapter[Any], sides: tuple[str, ...]) -> dict[str, Any]:
        """The tables of sides, in the order of the sides."""
        if isinstance(raw, Mapping):
            strange = [name for name in raw if name not in sides]
            self.problems += [f"{path}.{name}: {unknown('side', name, sides)}" for name in strange]
            raw = {side: raw[side] for side in sides if side in raw}
        return self._named(path, raw, kind)

    def _staged(self, path: str, raw: object, kind: TypeAdapter[Any], side: TypeAdapter[Any]) -> Any | None:
        """A table with its own sides, which are validated one by one; an invalid side is None."""
        if not isinstance(raw, Mapping):
            return self._valid(path, raw, kind)
        sides = self._sides(f"{path}.boundary", raw.get("boundary", {}), side, self.schema.sides)
        table = self._valid(path, {key: value for key, value in raw.items() if key != "boundary"}, kind)
        return table and table.model_copy(update={"boundary": sides})

    def _numbered(self, key: str, raw: object, kind: TypeAdapter[Any]) -> tuple[Any, ...]:
        """The tables of a list, counted from 1 in error texts."""
        if not isinstance(raw, list):
            self.problems.append(f"{key}: is {show(raw)}, must be a list of tables, each [[{key}]] in TOML")
            return ()
        return tuple(self._valid(path, table, kind) for path, table in zip(places(key, raw), raw, strict=True))
