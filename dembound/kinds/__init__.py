"""The kinds of bodies; `schemas` lists them."""

from functools import cache
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

from dembound.casefile import Case
from dembound.errors import RecordError
from dembound.motion.kind import Kind
from dembound.results.reader import open_record, text_of
from dembound.schemas import BODIES, body_of
from dembound.schemas import SCHEMAS as SCHEMAS  # with the following, for who needs the kinds as well
from dembound.schemas import checked as checked
from dembound.schemas import load as load
from dembound.schemas import loads as loads
from dembound.schemas import with_changes as with_changes


@cache
def _made(place: str) -> Kind[Any, Any]:
    """The kind at a place such as "package.module:Class"."""
    return resolve_name(place)()


def kind_of(case: Case) -> Kind[Any, Any]:
    """The kind of body a case describes; a run imports only the kind it needs."""
    return _made(body_of(case).kind)


def kind_of_record(path: Path) -> Kind[Any, Any]:
    """The kind of body a record belongs to; raises RecordError when it cannot be read, or is of an unknown kind."""
    with open_record(path) as file:
        name = text_of(
            file.attrs.get("kind", "disks")
        )  # files of exact histories have no kind; they belong to cases of disks
    if name not in BODIES:
        raise RecordError([f"{path}: is of the kind {name}, must be of {' or '.join(BODIES)}"])
    return _made(BODIES[name].kind)
