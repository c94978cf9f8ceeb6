"""Histories of a record: of its monitors and sides, with estimated errors."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np

from dembound.casefile.disks.load import FREE_FIELD  # ending of a twin's name, also for pictures
from dembound.casefile.messages import choices, show
from dembound.errors import CaseError, NameMissingError
from dembound.results.reader import finite, history_of, is_line, open_record, place_in_words, require_run
from dembound.words import Entries, percent

if TYPE_CHECKING:
    import h5py

T = TypeVar("T")


class Named(dict[str, T]):
    """Values by the names of monitors or sides; another name raises NameMissingError with the existing names.

    what : they are names of; where : the file they are in.
    """

    def __init__(self, values: Mapping[str, T], what: str, where: str = "") -> None:
        super().__init__(values)
        self._what, self._where = what, where

    def __missing__(self, name: str) -> T:
        raise missing(self._what, name, self, self._where)


def missing(what: str, name: str, known: Collection[str], where: str = "") -> NameMissingError:
    """The error for an unknown name."""
    there = f"must be one of {choices(str(name), list(known))}" if known else "there are none"
    return NameMissingError([f"{what}: is {show(name)}, {there}"], where)


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


OPPOSITE = {"left": "right", "right": "left", "bottom": "top", "top": "bottom"}


@dataclass(frozen=True)
class SideHistory:
    """The motion of one side as a whole, and the stress on it.

    Attributes
    ----------
    time : (k,) s.
    displacement : (k, 2) m, mean of its particles along x and y since the start.
    stress : (k, 2) Pa, along the normal, tension positive, and shear stress xy.
    strain : (k,) change of the distance to the opposite side over the distance, extension positive; None if there is no
    such side.
    """

    time: np.ndarray
    displacement: np.ndarray
    stress: np.ndarray
    strain: np.ndarray | None


def read_side_history(path: Path, side: str) -> SideHistory:
    """The history of a side of a run; raises CaseError if the file has none, RecordError as `finite`."""
    with open_record(path) as file:
        require_run(file)
        there = {name: group for name, group in file.get("boundaries", {}).items() if "force" in group}
        if side not in there:
            raise CaseError([f"{path}: has no history of side {side}, sides there: {', '.join(there) or 'none'}"])
        group, axis = there[side], 0 if side in ("left", "right") else 1
        area = group["diameter"][0] if is_line(file.attrs["size"]) else group.attrs["body_length"]
        outward = 1.0 if side in ("right", "top") else -1.0
        traction = outward * finite(group["force"]) / area
        displacement, strain = finite(group["displacement"])[:, :2], None
        if (other := there.get(OPPOSITE[side])) is not None:
            column = file.attrs.get("column", 0)
            means = [each["position"][:][each["particle"][:] >= column, axis].mean() for each in (group, other)]
            strain = (displacement[:, axis] - finite(other["displacement"])[:, axis]) / (means[0] - means[1])
        stress = np.stack([traction[:, axis], traction[:, 1 - axis]], axis=1)
        return SideHistory(finite(group["time"]), displacement, stress, strain)


FILE = "estimate.h5"
"""Histories of the errors, in the folder of the results."""

KEY = "error_estimate"
"""Entry of the summary."""

NAMES = {"disks": "these disks", "rock": "the rock"}
"""Motions relative to which errors are given, in words."""

LEAST = 1e-3
"""Smallest error that is given as a number."""


@dataclass(frozen=True)
class Band:
    """The estimated error of a monitor's history.

    time (k,) s. half_width (k, c), in SI units: largest expected error at every time. corrected (k, c): the history
    without the error of the sides, None where this is not known.
    """

    time: np.ndarray
    half_width: np.ndarray
    corrected: np.ndarray | None


def read_bands(record: Path, quantity: str) -> dict[str, Band]:
    """The bands of a quantity by monitor for the run of a record; none without an estimate.

    Raises RecordError for a file that cannot be read.
    """
    path = record.with_name(FILE)
    if not path.is_file():
        return {}
    with open_record(path) as file:
        return {
            name: Band(
                group["time"][:],
                group[quantity]["band"][:],
                group[quantity]["corrected"][:] if "corrected" in group[quantity] else None,
            )
            for name, group in file["histories"].items()
            if quantity in group
        }


def in_words(share: float) -> str:
    """A share in per cent with two digits, at least `LEAST`."""
    return f"< {percent(LEAST)}" if share < LEAST else percent(share)


def split_in_words(shares: Mapping[str, float]) -> str:
    """Shares by cause, the largest first."""
    ordered = sorted(shares.items(), key=lambda each: -each[1])
    return ", ".join(f"{name} {in_words(share)}" for name, share in ordered)


def entries(estimate: Mapping[str, Any]) -> Entries:
    """The entry of a summary as names and texts: errors at each monitor, their origin, and missing causes."""
    for monitor, quantities in estimate["monitors"].items():
        for quantity, found in quantities.items():
            totals = ", ".join(f"of {NAMES[of]} {_between(each)}" for of, each in found["of"].items())
            yield f"{monitor}, {quantity}", f"{totals} ({split_in_words(found['by'])})"
    yield from ((name, f"{cause['how']}, {cause['words']}") for name, cause in estimate["causes"].items())
    for name, lines in (("notes", estimate["notes"]), ("not estimated", estimate["not_estimated"])):
        if lines:
            yield name, "; ".join(lines)


def _between(share: Mapping[str, float]) -> str:
    """An error and its upper bound, in words."""
    return f"{in_words(share['value'])}, at most {percent(share['upper'])}"
