"""Result files: opening records, and writing what is made of them whole or not at all."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np

from dembound.errors import CaseError

COMPONENTS = ("x", "y", "rotation")
"""The columns of every displacement and velocity in a record."""


def open_record(path: Path) -> h5py.File:
    """Open a record (``run.h5``, ``calibration.h5``) for reading; use it in a ``with`` statement.

    Raises CaseError when it is not there or not readable.
    """
    try:
        return h5py.File(path, "r")
    except OSError as error:
        raise CaseError([f"{path}: cannot be read as a record of results: {error}"]) from None


def snapshot_of(file: h5py.File, number: int) -> h5py.Group:
    """A snapshot of an open record by its number; negative ones count from the last.

    Raises CaseError when there is no such snapshot.
    """
    snapshots = list(file.get("snapshots", {}).values())
    if not -len(snapshots) <= number < len(snapshots):
        raise CaseError([f"{file.filename}: has no snapshot {number}, it has {len(snapshots)}"])
    return snapshots[number]


def liveliest_snapshot(file: h5py.File, field: str) -> h5py.Group:
    """The snapshot of an open record in which a disk's `field` (velocity or displacement) is largest in x or y.

    Raises CaseError when there is no snapshot.
    """
    groups = list(snapshot_of(file, -1).parent.values())
    return max(groups, key=lambda group: float(np.abs(group[field][:, :2]).max()))


def record_names(paths: Sequence[Path]) -> list[str]:
    """A name for each record, for legends: its case's name, where two share it its folder's, else its path."""
    names = []
    for path in paths:
        with open_record(path) as file:
            names.append(str(file.attrs["name"]))
    folders = [path.resolve().parent.name for path in paths]
    return [
        name if names.count(name) == 1 else folder if folders.count(folder) == 1 else str(path)
        for name, folder, path in zip(names, folders, paths, strict=True)
    ]


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a neighbouring path to write to, which takes the place of `path` when all went well."""
    part = path.with_name(f"{path.name}.part")
    try:
        yield part
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
