"""CSV and JSON files: strict, and written completely or not at all."""

import csv
import io
import json
import math
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from dembound.errors import RecordError
from dembound.files import content_of, replacing, write_text

FORMULAS = ("=", "+", "-", "@", "\t", "\r")
"""Beginnings of texts that spreadsheets take for formulas, which might do anything."""

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+|inf|nan)(e[+-]?\d+)?$", re.IGNORECASE)


def write_csv(path: Path, rows: Iterable[Sequence[Any]]) -> None:
    """Write rows, completely or not at all; missing values (None, nan) are empty.

    A text that a spreadsheet would take for a formula begins with an apostrophe. Raises the errors of
    `dembound.files.created`.
    """
    with replacing(path) as file, io.TextIOWrapper(file, encoding="utf-8", newline="") as text:
        csv.writer(text).writerows([_cell(each) for each in row] for row in rows)


def _cell(value: Any) -> Any:
    """A value as a cell."""
    if value is None or value != value:
        return ""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULAS) and not NUMBER.match(value) else value


LARGEST = 2**26
"""Largest size (bytes) of a file that is read."""

Kind = TypeVar("Kind")


def read_json(path: Path, kind: type[Kind]) -> Kind:
    """The contents of a file as a type whose values are checked.

    Raises RecordError, in one line, for others, and as `content_of`.
    """
    return checked(kind, content_of(path, LARGEST), path)


def checked(kind: type[Kind], found: bytes | Mapping[str, Any], path: Path) -> Kind:
    """The JSON text of a file, or its values, as a type whose values are checked; errors as of `read_json`."""
    text = found if isinstance(found, bytes) else json.dumps(found)
    try:
        return TypeAdapter(kind).validate_json(text, strict=True)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise RecordError([f"{path}: is damaged{f', {where}' if where else ''}: {first['msg']}"]) from None


def write_json(path: Path, values: Any) -> None:
    """Write plain values, numbers that are not finite as null.

    Raises the errors of `dembound.files.created`.
    """
    write_text(path, json.dumps(strict(values), indent=2, allow_nan=False) + "\n")


def strict(value: Any) -> Any:
    """A plain value with None in place of every number that is not finite."""
    if isinstance(value, Mapping):
        return {name: strict(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [strict(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
