"""The case file of a record: its place relative to the folder of results, and whether it has changed."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dembound.casefile import Case
from dembound.files import opened

PLACE, DIGEST = "source", "source_digest"
"""Attributes of a record: the case file's path relative to the parent of the folder of results, and its SHA-256."""


def file_of(case: Case) -> Path:
    """The file that a case was read from, if there is one."""
    return case.folder / f"{case.origin}.toml"


def source_of(case: Case, results: Path) -> dict[str, str]:
    """The attributes of a record in a folder within `results`; none for a case that is in no file."""
    path = file_of(case)
    if not path.is_file():
        return {}
    try:
        place = Path(os.path.relpath(path.resolve(), results.resolve())).as_posix()
    except ValueError:  # on another drive
        return {}
    return {PLACE: place, DIGEST: _digest(path)}


def recorded_source(attributes: Mapping[str, Any], results: Path) -> tuple[Path, bool] | None:
    """The case file of a record, and whether it has changed since; None if it no longer exists."""
    if PLACE not in attributes or not (path := results / str(attributes[PLACE])).is_file():
        return None
    plain = Path(os.path.normpath(path))  # another place if the folder of results is a link
    path = plain if plain.is_file() and plain.samefile(path) else path.resolve()
    return path, _digest(path) != attributes.get(DIGEST)


def _digest(path: Path) -> str:
    with opened(path, follow=True) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
