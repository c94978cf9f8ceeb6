"""Histories of the monitors of a record."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from dembound.casefile.disks.monitor import FREE_FIELD as FREE_FIELD  # ending of a twin's name, also for pictures
from dembound.errors import CaseError
from dembound.results.reader import history_of, open_record, place_in_words

if TYPE_CHECKING:
    import h5py

Quantity = Literal["velocity", "displacement", "acceleration", "stress"]

UNITS = {
    "velocity": ("m/s", "m/s", "rad/s"),
    "displacement": ("m", "m", "rad"),
    "acceleration": ("m/s²", "m/s²", "rad/s²"),
    "stress": ("MPa",),
}
"""Units of x, y and rotation; the stress is along x."""

SCALES = {"velocity": 1.0, "displacement": 1.0, "acceleration": 1.0, "stress": 1e6}
"""SI value of the units shown."""

SOURCES = {"acceleration": "velocity"}
"""The recorded quantity from which a quantity that is not recorded is computed."""


@dataclass(frozen=True)
class MonitorRecord:
    """The record of one monitor in one run.

    time (k,) s; values in `UNITS`, of a motion (k, 3), of a stress along x (k, 1); position (2,) m of its particle;
    both this position and the position given in the case as text.
    """

    time: np.ndarray
    values: np.ndarray
    position: np.ndarray
    place: str
    requested: str


def read_histories(path: Path, quantity: Quantity) -> dict[str, MonitorRecord]:
    """The histories of a run by monitor name; empty for a run without monitors.

    Accelerations are central differences of the recorded velocity, one-sided at both ends; with
    `output.history_interval` they are means over this interval on either side.

    Raises CaseError when the file cannot be read, has no stress where it is requested, or too few samples for an
    acceleration.
    """
    source = SOURCES.get(quantity, quantity)
    with open_record(path) as file:
        groups = dict(file.get("histories", {}).items())
        if any(source not in group for group in groups.values()):
            raise CaseError([f"{path}: has no {quantity} of its monitors; only runs of bars have it"])
        if source != quantity and any(len(group["time"]) < 2 for group in groups.values()):
            raise CaseError([f"{path}: has fewer than two samples of its monitors, too few for an {quantity}"])
        return {name: _read(group, quantity, file.attrs["size"].tolist()) for name, group in groups.items()}


def delay_of(path: Path) -> float | None:
    """Time (s) by which all motion of a record is later than if waves entered through the planes of sides.

    None: unknown. Raises CaseError when the file cannot be read.
    """
    with open_record(path) as file:
        late = file.attrs.get("late")
        return float(late) if isinstance(late, float) and np.isfinite(late) else None


def monitor_names(path: Path) -> list[str]:
    """The names of the monitors of a record, without twins in a free-field column."""
    with open_record(path) as file:
        return [name for name in file.get("histories", {}) if not name.endswith(FREE_FIELD)]


def _read(group: h5py.Group, quantity: Quantity, size: list[float]) -> MonitorRecord:
    """A monitor's history."""
    time, values = history_of(group, SOURCES.get(quantity, quantity))
    if quantity in SOURCES:
        values = np.gradient(values, time, axis=0)
    place, requested = (place_in_words(group.attrs[name], size) for name in ("position", "requested"))
    position = np.array(group.attrs["position"], dtype=np.float64)
    return MonitorRecord(time, values.reshape(len(time), -1) / SCALES[quantity], position, place, requested)
