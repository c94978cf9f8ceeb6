"""Datasets of a record: arrays with units and checksums, some of which grow."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import h5py

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
