"""The list of all kinds of bodies, and their case files: reading and changing them.

Only this file names the kinds. Reading, describing and listing cases does not import their runs.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from dembound.casefile import Case, edit, reader
from dembound.casefile.bar import SCHEMA as BAR
from dembound.casefile.disks import SCHEMA as DISKS
from dembound.casefile.model import K, Schema, as_kind


class Body(NamedTuple):
    """A kind of body: the tables of its case files, and where its `Kind` and its `Judge` are, imported when needed."""

    schema: Schema
    kind: str
    judge: str


BODIES: Mapping[str, Body] = {
    "bar": Body(BAR, "dembound.kinds.bar.kind:Bars", "dembound.accuracy.of_bars.judge:BarJudge"),
    "disks": Body(DISKS, "dembound.kinds.disks.kind:Disks", "dembound.accuracy.of_disks.judge:DiskJudge"),
}
"""Kinds of bodies by name, in the order in which a case file is searched for their tables."""

SCHEMAS = tuple(body.schema for body in BODIES.values())
"""The tables of each kind."""


def body_of(case: Case) -> Body:
    """The kind of body that a case describes."""
    return next(body for body in BODIES.values() if isinstance(case, body.schema.case))


def load(path: Path) -> Case:
    """Read a case file of any kind; errors as `case.reader.load`."""
    return reader.load(path, SCHEMAS)


def loads(text: str, folder: Path = Path(), name: str = "case", files: Mapping[str, str] | None = None) -> Case:
    """Read a case from TOML text, as if it were the file `name` in the folder; see `case.reader.loads`."""
    return reader.loads(text, SCHEMAS, folder, name, files)


def with_changes(case: K, changes: Mapping[str, Any]) -> K:
    """The case with some keys changed, see `case.writer.with_changes`; its kind of body remains.

    Also raises CaseError for changes that make it a case of another kind.
    """
    return _of_same(case, edit.with_changes(case, changes, SCHEMAS))


def checked(case: K) -> K:
    """The case, its tables checked as if they had been read from a file; errors as `load`."""
    if case.is_checked:
        return case
    return _of_same(case, loads(case.text, case.folder, case.name, case.files))


def _of_same(case: K, made: Case) -> K:
    """A case made from another one, with the kind, origin and silent waves of the other."""
    return replace(
        as_kind(made, type(case), "is of another kind of body after these changes, must be of the same"),
        origin=case.origin,
        silent=case.silent,
    )
