"""Datasets of a record: arrays with units and checksums; damage of records in words."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from dembound.errors import RecordError

if TYPE_CHECKING:
    import h5py

MOTION = ("histories", "snapshots", "particles", "energy")
"""Groups of a record whose numbers are all finite."""

UNREADABLE = "cannot be read as a record of results"

CHECKSUM = "filter returned failure"
"""Part of HDF5's message for numbers that do not match their checksum, the only filter used."""


def is_of_checksum(error: Exception) -> bool:
    """Whether an error reports numbers that do not match their checksum."""
    return CHECKSUM in str(error)


def damage_in_words(error: Exception, size: int) -> str:
    """An error in reading a record in words; size : of the file, bytes."""
    reason = str(error) or type(error).__name__
    if found := re.search(r"truncated file: .*stored_eof = (\d+)", reason):
        return f"is truncated, it has {size:,} of {int(found[1]):,} bytes"
    if isinstance(error, OSError) and error.errno in (errno.EAGAIN, errno.EACCES):
        is_locked = error.errno == errno.EAGAIN
        return f"{UNREADABLE}: {'another process is writing it' if is_locked else os.strerror(error.errno).lower()}"
    if "file signature not found" in reason:
        return f"{UNREADABLE}: it is {'no HDF5 file' if size else 'empty'}"
    if is_of_checksum(error):
        return "is damaged (a checksum of its numbers does not fit)"
    if "metadata checksum" in reason:
        return "is damaged (a checksum of its groups or attributes does not fit)"
    return f"{UNREADABLE}: {reason[:200]}"


def require_readable(file: h5py.File) -> None:
    """Read all numbers of a record, whose checksums are then compared.

    Raises RecordError, with the first dataset that cannot be read.
    """
    import h5py

    def read(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if isinstance(item, h5py.Dataset):
            try:
                item[()]
            except OSError as error:
                reason = "its checksum does not fit" if is_of_checksum(error) else str(error)
                raise RecordError([f"{file.filename}: is damaged in {name} ({reason})"]) from None

    file.visititems(read)


def require_finite(file: h5py.File) -> None:
    """Raise RecordError for the first number of the motion in a record that is not finite."""
    import h5py

    def look_into(name: str, item: h5py.Group | h5py.Dataset) -> None:
        if not isinstance(item, h5py.Dataset) or item.dtype.kind != "f" or name.partition("/")[0] not in MOTION:
            return
        good = np.isfinite(item[()])
        if not good.all():
            row = f" in row {int(np.argmin(good.reshape(len(good), -1).all(axis=1)))}" if good.ndim else ""
            raise RecordError([f"{file.filename}: is damaged: {name} has a number that is not finite{row}"])

    file.visititems(look_into)


def require_places(file: h5py.File) -> None:
    """Raise RecordError for particles without size, and for monitors of particles that the record does not have."""
    import h5py

    particles = file.get("particles")
    if not isinstance(particles, h5py.Group) or "position" not in particles:
        return
    if "radius" in particles and not np.all((radius := particles["radius"][:]) > 0.0):
        row = int(np.argmin(radius > 0.0))
        raise RecordError([f"{file.filename}: is damaged: particles/radius is {radius[row]:g} in row {row}"])
    count = len(particles["position"])
    for name, group in file.get("histories", {}).items():
        index = group.attrs.get("particle", 0)
        if not -1 <= int(index) < count:  # −1 in a continuum
            where = f"histories/{name} is of particle {int(index)}"
            raise RecordError([f"{file.filename}: is damaged: {where}, there are {count}"])


CHUNK_BYTES = 2**20
"""Largest size (bytes) of a chunk, the unit of HDF5's reading and checksums."""

GROWING_BYTES = 2**13
"""Bytes of a chunk of a dataset that grows, whose last chunk is rewritten often."""

Columns = Iterable[tuple[str, tuple[int, ...], str, str]]
"""Datasets of a group: their names, widths of a row, types and units."""


def text(value: str) -> np.bytes_:
    """A text in UTF-8 of fixed length, which has a checksum; texts of variable length have none in HDF5."""
    return np.bytes_(value.encode() or b"\0")


def describe(item: h5py.HLObject, facts: Mapping[str, Any]) -> None:
    """Write the attributes of a group or dataset: numbers, texts, or several of them."""
    for name, value in facts.items():
        several = isinstance(value, list | tuple) and any(isinstance(each, str) for each in value)
        item.attrs[name] = (
            text(value) if isinstance(value, str) else np.array([text(each) for each in value]) if several else value
        )


def write(group: h5py.Group, name: str, values: np.ndarray, unit: str) -> None:
    """Write an array with its unit, and checksums (Fletcher's) that HDF5 compares when it reads."""
    if values.size == 0 or values.ndim == 0:
        group.create_dataset(name, data=values).attrs["unit"] = text(unit)
        return
    chunks = (chunk_rows(values.shape[1:], values.dtype, CHUNK_BYTES, len(values)), *values.shape[1:])
    group.create_dataset(name, data=values, chunks=chunks, fletcher32=True).attrs["unit"] = text(unit)


def make(group: h5py.Group, columns: Columns) -> dict[str, h5py.Dataset]:
    """Empty datasets of a group that rows can be appended to."""
    kept = {}
    for name, width, kind, unit in columns:
        rows = chunk_rows(width, np.dtype(kind), GROWING_BYTES)
        kept[name] = group.create_dataset(
            name, shape=(0, *width), maxshape=(None, *width), dtype=kind, chunks=(rows, *width), fletcher32=True
        )
        kept[name].attrs["unit"] = text(unit)
    return kept


def datasets_of(group: h5py.Group) -> dict[str, h5py.Dataset]:
    """The datasets of a group by name, without those of groups in it."""
    return {name: item for name, item in group.items() if hasattr(item, "dtype")}


def extend(dataset: h5py.Dataset, values: np.ndarray) -> None:
    """Append rows to a dataset."""
    if len(values) == 0:
        return
    count = len(dataset)
    dataset.resize(count + len(values), axis=0)
    dataset[count:] = values


def chunk_rows(width: tuple[int, ...], kind: np.dtype, most_bytes: int, most: int = 2**62) -> int:
    """Rows of a chunk."""
    row = kind.itemsize * int(np.prod(width, dtype=np.int64))
    return max(1, min(most, most_bytes // max(1, row)))
