"""Histories of the monitors of a record."""

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import h5py
import numpy as np

from dembound.errors import CaseError
from dembound.results.reader import open_record, place_in_words

Quantity = Literal["velocity", "displacement", "stress"]

UNITS = {"velocity": ("m/s", "m/s", "rad/s"), "displacement": ("m", "m", "rad"), "stress": ("MPa",)}
"""Units of x, y and rotation; the stress is along x."""

SCALES = {"velocity": 1.0, "displacement": 1.0, "stress": 1e6}
"""SI units in the units shown."""


@dataclass(frozen=True)
class History:
    """What one monitor felt in one run.

    time (k,) s; values in `UNITS`, of a motion (k, 3), of a stress along x (k, 1); place asked for, in words.
    """

    time: np.ndarray
    values: np.ndarray
    place: str


def read_histories(path: Path, quantity: Quantity) -> dict[str, History]:
    """The histories of a run by monitor name; empty for a run without monitors.

    Raises CaseError when the file cannot be read or holds no stress that is asked for.
    """
    with open_record(path) as file:
        groups = dict(file.get("histories", {}).items())
        if any(quantity not in group for group in groups.values()):
            raise CaseError([f"{path}: holds no {quantity} of its monitors; runs of bars do"])
        return {name: _read(group, quantity, file.attrs["size"].tolist()) for name, group in groups.items()}


def _read(group: h5py.Group, quantity: Quantity, size: list[float]) -> History:
    """A monitor's history."""
    time, values = group["time"][:], group[quantity][:]
    columns = values.reshape(len(time), -1) / SCALES[quantity]
    return History(time, columns, place_in_words(group.attrs["wanted"], size))
