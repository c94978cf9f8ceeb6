"""JSON files for scripts: strict JSON, which has no NaN and no infinity, written completely or not at all."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import TypeAdapter, ValidationError

from dembound.errors import RecordError
from dembound.files import content_of, write_text

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
