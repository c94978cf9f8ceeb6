"""Cases made from other cases: the same TOML with some keys changed."""

from collections.abc import Mapping, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any

import tomli_w

from dembound.casefile.messages import unknown
from dembound.casefile.model import Case
from dembound.casefile.reader import loads
from dembound.casefile.schema import Schema
from dembound.casefile.toml import DEEPEST, parsed
from dembound.errors import CaseError


def with_changes(case: Case, changes: Mapping[str, Any], schemas: Sequence[Schema]) -> Case:
    """The case with some keys changed, checked as if it had been read from a file of one of the schemas' kinds.

    Parameters
    ----------
    case
        The case to start from; it is not changed.
    changes
        Dotted key -> value in TOML terms, such as ``{"boundary.right.beta_p": 0.81}``. A value may be a whole
        table; missing tables are created. A load, monitor or hole is identified by its name or its number, from 1:
        ``load.blow.pressure`` or ``load.1.pressure``. None leaves a key out. Keys set by neither case nor changes stay
        unset.

    Raises
    ------
    CaseError
        If a key does not exist or the changed case is not valid.
    """
    return loads(_changed(case.text, changes), schemas, case.folder, case.name, case.files)


def to_toml(case: Case, folder: Path | None = None) -> str:
    """The case's TOML text, for a file in `folder` (its own folder when None).

    The text is the one the case was read from, with its comments, unless relative paths in it have to be rewritten to
    refer to the same files from another folder.
    """
    here, there = case.folder.resolve(), (folder or case.folder).resolve()
    moved = {
        f"wave.{name}.{key}": path for name, wave in case.wave.items() for key, path in wave.moved(here, there).items()
    }
    return _changed(case.text, moved) if moved else case.text


def _changed(text: str, changes: Mapping[str, Any]) -> str:
    """TOML text with the values at dotted keys replaced or added."""
    data = parsed(text)
    for dotted, value in changes.items():
        *path, last = dotted.split(".")
        if not all((*path, last)):
            raise CaseError([f"{dotted}: is no key, must be names with one dot between two, such as run.duration"])
        if len(path) > DEEPEST:
            raise CaseError([f"{dotted[:40]}…: has {len(path)} dots, must have at most {DEEPEST}"])
        table: Any = data
        for name in path:
            table = _inner(table, name, dotted)
        key = _key(table, last, dotted)
        table[key] = deepcopy(value)  # as a later change may modify it
        if value is None:
            del table[key]  # which may not have been there, either
    return tomli_w.dumps(data)


def _inner(table: Any, name: str, dotted: str) -> Any:
    """The table, or list of tables, with this name; a missing table is created."""
    key = _key(table, name, dotted)
    inner = table.setdefault(key, {}) if isinstance(table, dict) else table[key]
    tables = inner if isinstance(inner, list) else [inner]
    if not tables or not all(isinstance(each, dict) for each in tables):
        raise CaseError([f"{dotted}: {name} is not a table"])
    return inner


def _key(table: Any, name: str, dotted: str) -> Any:
    """Key or index of a name in a table; in a list of tables it may be a table's name, or its number from 1."""
    if isinstance(table, dict):
        return name
    names = [str(each.get("name", "")) for each in table]
    numbers = [str(number) for number in range(1, len(table) + 1)]
    for known in (names, numbers):
        if name in known:
            return known.index(name)
    kind, _, _ = dotted.partition(".")
    raise CaseError([f"{dotted}: {unknown(kind, name, names)}, or a number up to {len(table)}"])
