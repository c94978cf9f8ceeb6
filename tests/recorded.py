"""Contents of a record, to compare two records to the bit."""

from pathlib import Path

import h5py
import numpy as np

COSTS = ("cpu", "wall", "wall_time", "seconds")
"""Datasets of measured times."""


def contents(record: Path, *, attributes: bool = True) -> dict[str, bytes]:
    """All numbers of a record by path but those of costs, and all texts and attributes."""
    found: dict[str, bytes] = {}
    with h5py.File(record) as file:

        def note(name: str, item: h5py.Group | h5py.Dataset) -> None:
            if attributes:
                for key, value in item.attrs.items():
                    found[f"{name}@{key}"] = str(np.asarray(value).tolist()).encode()
            if isinstance(item, h5py.Dataset) and name.rsplit("/", 1)[-1] not in COSTS:
                values = item[()]
                if values.dtype != object:
                    found[name] = values.tobytes()
                elif attributes:
                    found[name] = b"".join(values)

        note("", file)
        file.visititems(note)
    return found
