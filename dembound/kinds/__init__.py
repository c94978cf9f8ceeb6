"""The list of all kinds of bodies. Only this file and `schemas`, for their case files, name them."""

from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from dembound.casefile import Case
from dembound.errors import RecordError
from dembound.motion.kind import Kind
from dembound.results.reader import open_record, text_of
from dembound.schemas import SCHEMAS as SCHEMAS  # with the following, for who needs the kinds as well
from dembound.schemas import checked as checked
from dembound.schemas import load as load
from dembound.schemas import loads as loads
from dembound.schemas import with_changes as with_changes


@cache
def _bars() -> Kind[Any, Any]:
    from dembound.kinds.bar.kind import Bars

    return Bars()


@cache
def _disks() -> Kind[Any, Any]:
    from dembound.kinds.disks.kind import Disks

    return Disks()


KINDS: Mapping[str, Callable[[], Kind[Any, Any]]] = {"bar": _bars, "disks": _disks}
"""Kinds of bodies by name, in the order of `SCHEMAS`; a run imports only the kind it needs."""


def kind_of(case: Case) -> Kind[Any, Any]:
    """The kind of body a case describes."""
    return next(kind() for kind, schema in zip(KINDS.values(), SCHEMAS, strict=True) if isinstance(case, schema.case))


def kind_of_record(path: Path) -> Kind[Any, Any]:
    """The kind of body a record belongs to; raises RecordError when it cannot be read, or is of an unknown kind."""
    with open_record(path) as file:
        name = text_of(
            file.attrs.get("kind", "disks")
        )  # files of exact histories have no kind; they belong to cases of disks
    if name not in KINDS:
        raise RecordError([f"{path}: is of the kind {name}, must be of {' or '.join(KINDS)}"])
    return KINDS[name]()
