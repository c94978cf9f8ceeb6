"""The list of all kinds of bodies. Only this file and `schemas`, for their case files, name them."""

from pathlib import Path
from typing import Any

from dembound.bar.kind import Bars
from dembound.casefile import Case
from dembound.disks.kind import Disks
from dembound.motion.kind import Kind
from dembound.results.reader import open_record
from dembound.schemas import SCHEMAS as SCHEMAS  # with the following, for who needs the kinds as well
from dembound.schemas import checked as checked
from dembound.schemas import load as load
from dembound.schemas import loads as loads
from dembound.schemas import with_changes as with_changes

KINDS: tuple[Kind[Any, Any], ...] = (Bars(), Disks())
"""In the order of `SCHEMAS`."""


def kind_of(case: Case) -> Kind[Any, Any]:
    """The kind of body a case describes."""
    return next(kind for kind in KINDS if isinstance(case, kind.schema.case))


def kind_of_record(path: Path) -> Kind[Any, Any]:
    """The kind of body a record belongs to; raises CaseError when it cannot be read."""
    with open_record(path) as file:
        name = file.attrs.get("kind", "disks")  # files of exact histories have no kind; they belong to cases of disks
    return next(kind for kind in KINDS if kind.name == name)
