"""Reading the summary of a run, ``summary.json``, which may have been changed by hand or come from elsewhere."""

import json
from pathlib import Path
from typing import Any

from dembound.errors import CaseError, RecordError

FILE = "summary.json"

LARGEST = 2**26
"""Bytes of the longest file that is read."""


class Summary(dict[str, Any]):
    """An object of a summary; an entry that it lacks is an error of the file."""

    def __missing__(self, name: str) -> Any:
        raise RecordError([f"{self.path}: is damaged, or of another version of dembound; it has no {name}"])

    path: Path


def read_json(path: Path) -> dict[str, Any]:
    """The object in a file of JSON, in which `Summary` objects take the place of all others.

    Raises RecordError, in one line, for any other file.
    """
    try:
        if path.stat().st_size > LARGEST:
            raise RecordError([f"{path}: is longer than {LARGEST:,} bytes, as no such file is"])
        found = json.loads(path.read_text(encoding="utf-8"), object_hook=Summary)
    except (ValueError, RecursionError):
        raise RecordError([f"{path}: is damaged, no JSON"]) from None
    if not isinstance(found, Summary):
        raise RecordError([f"{path}: is damaged, it does not hold an object of JSON"])
    for each in _objects(found):
        each.path = path
    return found


def _objects(found: Any) -> list[Summary]:
    """An object and all in it."""
    waiting, objects = [found], []
    while waiting:
        each = waiting.pop()
        if isinstance(each, Summary):
            objects.append(each)
            waiting += each.values()
        elif isinstance(each, list):
            waiting += each
    return objects


def read_summary(folder: Path) -> dict[str, Any]:
    """The summary of a complete run in its folder.

    Raises CaseError where there is none, RecordError as `read_json`, and for an entry that is asked for and missing.
    """
    path = folder / FILE
    if not path.is_file():
        raise CaseError([f"{path}: is missing, the run is not complete"])
    return read_json(path)
