"""Cases made from other cases: the same TOML with some keys changed."""

import os
import tomllib
from collections.abc import Mapping
from copy import deepcopy
from pathlib import Path
from typing import Any

import tomli_w

from dembound.case.model import Case
from dembound.case.reader import loads
from dembound.errors import CaseError
from dembound.waves import Record


def with_changes(case: Case, changes: Mapping[str, Any]) -> Case:
    """The case with some keys changed, checked as if it had been read from a file.

    Parameters
    ----------
    case
        The case to start from; it stays as it is.
    changes
        Dotted key -> value in TOML terms, such as ``{"boundary.right.beta_p": 0.81}``. A value may be a whole
        table; tables that are not there yet are made. Keys set by neither case nor changes stay unset.

    Raises
    ------
    CaseError
        If the changed case is not valid.
    """
    return loads(_changed(case.text, changes), case.folder, case.name)


def to_toml(case: Case, folder: Path | None = None) -> str:
    """The case's TOML text, for a file in `folder` (its own folder when None).

    The text is the one the case was read from, comments and all, unless relative paths in it have to be
    rewritten to lead to the same files from another folder.
    """
    here, there = case.folder.resolve(), (folder or case.folder).resolve()
    moved = {
        f"wave.{name}.path": Path(os.path.relpath(here / wave.path, there)).as_posix()
        for name, wave in case.wave.items()
        if isinstance(wave, Record) and not Path(wave.path).is_absolute() and here != there
    }
    return _changed(case.text, moved) if moved else case.text


def _changed(text: str, changes: Mapping[str, Any]) -> str:
    """TOML text with the values at dotted keys replaced or added."""
    data = tomllib.loads(text)
    for dotted, value in changes.items():
        *path, key = dotted.split(".")
        table = data
        for name in path:
            table = table.setdefault(name, {})
            if not isinstance(table, dict):
                raise CaseError([f"{dotted}: {name} is not a table"])
        table[key] = deepcopy(value)  # a later change may reach into it
    return tomli_w.dumps(data)
