"""Reading the summary of a run, ``summary.json``, which may have been changed by hand or come from elsewhere."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dembound.errors import CaseError, RecordError
from dembound.files import content_of
from dembound.results.json_files import LARGEST
from dembound.results.named import missing
from dembound.results.reader import open_record, text_of, understood

FILE = "summary.json"


class Summary(dict[str, Any]):
    """An object of a summary; an entry that it lacks is an error of the file."""

    def __missing__(self, name: str) -> Any:
        raise RecordError([f"{self.path}: is damaged, or of another version of dembound; it has no {name}"])

    path: Path


class Entries(Summary):
    """An object of a summary for users, who may have mistyped the name of an entry."""

    def __missing__(self, name: str) -> Any:
        raise missing("entry", name, self, str(self.path))


def read_json(path: Path, kind: type[Summary] = Summary) -> dict[str, Any]:
    """The object in a JSON file, with all objects of a kind.

    Raises RecordError, in one line, for any other file.
    """
    content = content_of(path, LARGEST)
    try:
        found = json.loads(content, object_hook=kind)
    except (ValueError, RecursionError):
        raise RecordError([f"{path}: is damaged, no JSON"]) from None
    if not isinstance(found, Summary):
        raise RecordError([f"{path}: is damaged, it does not hold an object of JSON"])
    for each in _objects(found):
        each.path = path
    return found


def _objects(found: Any) -> list[Summary]:
    """An object and all objects in it."""
    waiting, objects = [found], []
    while waiting:
        each = waiting.pop()
        if isinstance(each, Summary):
            objects.append(each)
            waiting += each.values()
        elif isinstance(each, list):
            waiting += each
    return objects


def read_summary(folder: Path, kind: type[Summary] = Summary) -> dict[str, Any]:
    """The summary of a complete run in its folder, with all objects of a kind.

    Raises CaseError where there is none, RecordError as `read_json`, for a requested entry that is missing, and
    for a summary that belongs to another run than the record beside it.
    """
    path = folder / FILE
    if not path.is_file():
        raise CaseError([f"{path}: is missing, the run is not complete"])
    found = read_json(path, kind)
    if (record := folder / "run.h5").is_file():
        _require_same_run(found, record, path)
    return found


def _require_same_run(summary: Mapping[str, Any], record: Path, path: Path) -> None:
    """Raise RecordError if a summary and a record differ in the keys of their case or in the number of steps."""
    with understood(record), open_record(record) as file:
        there = {"steps": file.attrs.get("steps"), "keys": json.loads(text_of(file.attrs.get("keys", "null")))}
    for name, value in there.items():
        if value is not None and name in summary and summary[name] != value:
            raise RecordError([f"{path}: is of another run than run.h5 beside it: their {name} differ"])
