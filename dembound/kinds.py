"""The list of all kinds of bodies. Only this file names them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dembound.bar.kind import Bars
from dembound.casefile import Case, reader, writer
from dembound.disks.kind import Disks
from dembound.motion.kind import Kind
from dembound.results.reader import open_record

KINDS: tuple[Kind[Any, Any], ...] = (Bars(), Disks())
"""In the order in which a case file is searched for their tables."""

SCHEMAS = tuple(kind.schema for kind in KINDS)
"""The tables of their case files."""


def load(path: Path) -> Case:
    """Read a case file of any kind; errors as `case.reader.load`."""
    return reader.load(path, SCHEMAS)


def loads(text: str, folder: Path = Path(), name: str = "case") -> Case:
    """Read a case from TOML text, as if it were the file `name` in the folder; errors as `load`."""
    return reader.loads(text, SCHEMAS, folder, name)


def with_changes(case: Case, changes: Mapping[str, Any]) -> Case:
    """The case with some keys changed, see `case.writer.with_changes`."""
    return writer.with_changes(case, changes, SCHEMAS)


def checked(case: Case) -> Case:
    """The case, its tables checked as if they had been read from a file; errors as `load`."""
    return case if case.is_checked else loads(case.text, case.folder, case.name)


def kind_of(case: Case) -> Kind[Any, Any]:
    """The kind of body a case describes."""
    return next(kind for kind in KINDS if isinstance(case, kind.schema.case))


def kind_of_record(path: Path) -> Kind[Any, Any]:
    """The kind of body a record belongs to; raises CaseError when it cannot be read."""
    with open_record(path) as file:
        name = file.attrs.get("kind", "disks")  # files of exact histories have no kind; they belong to cases of disks
    return next(kind for kind in KINDS if kind.name == name)
