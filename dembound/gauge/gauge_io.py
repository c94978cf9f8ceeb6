"""The signal of a gauge on a bar, and the velocity of its free end: read from text and from records of runs."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from dembound.errors import CaseError
from dembound.gauge.estimates import FEWEST
from dembound.results.reader import history_of, open_record, text_of
from dembound.waves.file_wave import read_samples

FREE = "free"
"""The type of a free end."""

ROUNDING = 1e-9
"""Share of a bar's length within which two positions are equal."""


@dataclass(frozen=True)
class BarMetadata:
    """Data of the bar in the record of a run.

    speed : of waves, m/s; attenuation : 1/m; ends : types of the loaded end and of the other end; broken : time at
    which the first bond broke, s, infinite for an unbroken bar.
    """

    speed: float
    attenuation: float
    ends: tuple[str, str]
    broken: float


@dataclass(frozen=True)
class Gauge:
    """A gauge on a bar, and its signal.

    time, stress : (k,) s and Pa, tension positive; position : from the loaded end, m; length : the bar's, m;
    density : kg/m³, or None; metadata : data of the bar from a record, None for a text file.
    """

    time: np.ndarray
    stress: np.ndarray
    position: float
    length: float
    density: float | None
    metadata: BarMetadata | None = None


class GaugeMetadata(NamedTuple):
    """Data of a gauge from a record; see `Gauge`, None where it is missing."""

    position: float | None = None
    length: float | None = None
    density: float | None = None
    metadata: BarMetadata | None = None


def read_gauge(
    path: Path,
    monitor: str | None = None,
    position: float | None = None,
    length: float | None = None,
    density: float | None = None,
    scale: float = 1.0,
) -> Gauge:
    """Read a gauge from a text file of two columns, or from a monitor in the record of a run.

    Parameters
    ----------
    path : the file.
    monitor : its name in the record; may be left out if there is only one between the ends. position, length, density :
    as for `Gauge`; by default those of the record. scale : factor of the values, not 0.

    Raises CaseError for a file that cannot be read, an unknown monitor, a bar that is not loaded at one end, and a
    gauge that is not on the bar.
    """
    if _is_record(path):
        time, stress, known = _recorded(path, monitor)
    else:
        (time, stress), known = _samples(path, "stress (Pa)"), GaugeMetadata()
        if monitor is not None:
            raise CaseError([f"--monitor: is for results of a run, {path} is a text file"])
    place, long, dense = (
        recorded if given is None else given
        for given, recorded in zip((position, length, density), known[:3], strict=True)
    )
    problems = list(_problems_with_bar(place, long, dense))
    if not np.isfinite(scale) or scale == 0.0:
        problems.append(f"--scale: is {scale:g}, must be finite and not 0")
    if problems:
        raise CaseError(problems)
    assert place is not None
    assert long is not None
    return Gauge(time, scale * stress, place, long, dense, known.metadata)


def read_free_end(path: Path, free_end: str) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) in s and velocities (k,) in m/s, positive outwards, of a bar's free end.

    Parameters
    ----------
    path : the gauge's file, as for `read_gauge`.
    free_end : a monitor in it if it is a record, which must be at the end opposite the loaded one, and this end must be
    free; else the path of a text file of two columns.

    Raises CaseError for anything else.
    """
    if not _is_record(path):
        if not Path(free_end).is_file():
            raise CaseError([f"--free-end: is {free_end}, must be a text file of time (s) and velocity (m/s)"])
        return _samples(Path(free_end), "velocity (m/s)")
    with open_record(path) as file:
        histories = file.get("histories", {}).items()
        there = {name: group for name, group in histories if _is_at(file, group, _length(file))}
        if free_end not in there:
            allowed = f"which is {' or '.join(there)}" if there else "but the results have none there"
            raise CaseError([f"--free-end: is {free_end}, must be a monitor at the end opposite the load, {allowed}"])
        metadata = _bar_metadata(file)
        if metadata is not None and metadata.ends[1] != FREE:
            raise CaseError([f"--free-end: is {free_end}, where the bar's end is {metadata.ends[1]}, must be free"])
        outwards = 1.0 if _loaded_end(file) == "left" else -1.0
        time, velocity = history_of(there[free_end], "velocity")
        return time, outwards * velocity[:, 0]


def _is_record(path: Path) -> bool:
    """Whether a file is a record by its name or contents; else it is a text."""
    return path.suffix == ".h5" or h5py.is_hdf5(path)


def not_above_zero(option: str, value: float | None, unit: str) -> Iterator[str]:
    """Message about an option's value, in its unit, if it is not a positive number."""
    if value is not None and not 0.0 < value < np.inf:
        yield f"{option}: is {value:g} {unit}, must be finite and above 0"


def not_on_bar(option: str, place: float, length: float) -> Iterator[str]:
    """Message about an option's position, m from the loaded end, if it is not between the ends of a bar."""
    if not 0.0 < place < length:
        yield f"{option}: is {place:g} m, must be above 0 and below the length, {length:g} m"


def _problems_with_bar(position: float | None, length: float | None, density: float | None) -> Iterator[str]:
    """Missing or impossible data of a gauge on a bar."""
    if position is None:
        yield "--position: is missing, must be the gauge's place (m) from the loaded end"
    if length is None:
        yield "--length: is missing, must be that of the bar (m)"
    unfit = list(not_above_zero("--length", length, "m"))
    yield from unfit
    if position is not None and length is not None and not unfit:
        yield from not_on_bar("--position", position, length)
    yield from not_above_zero("--density", density, "kg/m³")


def _recorded(path: Path, name: str | None) -> tuple[np.ndarray, np.ndarray, GaugeMetadata]:
    """Time, stress and metadata of a monitor in a record."""
    with open_record(path) as file:
        group = _gauge(file, name)
        time, stress = history_of(group, "stress")
        _enough(time, path)
        if "range" in group.attrs:
            raise CaseError([f"{path}: has a bar of several ranges, must have one without interfaces"])
        density = file.attrs.get("density")
        known = GaugeMetadata(
            position=_from_loaded_end(file, group),
            length=_length(file),
            density=None if density is None else float(density),
            metadata=_bar_metadata(file),
        )
        return time, stress, known


def _gauge(file: h5py.File, name: str | None) -> h5py.Group:
    """The history of a monitor between the ends of a recorded bar, by its name or as the only one."""
    signals = {
        each: group
        for each, group in file.get("histories", {}).items()
        if "stress" in group and not _is_at(file, group, 0.0) and not _is_at(file, group, _length(file))
    }
    if not signals:
        raise CaseError([f"{file.filename}: contains no history of stress between the ends of a bar"])
    if name is None and len(signals) > 1:
        raise CaseError([f"--monitor: is not named, must be one of {', '.join(signals)}"])
    if name is not None and name not in signals:
        raise CaseError([f"--monitor: is {name}, must be between the bar's ends, which is {' or '.join(signals)}"])
    return signals[next(iter(signals)) if name is None else name]


def _bar_metadata(file: h5py.File) -> BarMetadata | None:
    """Data of the bar in a record; None if it has no wave speed."""
    if "wave_speed" not in file.attrs:
        return None
    left, right = map(text_of, file.attrs["ends"])
    return BarMetadata(
        speed=float(file.attrs["wave_speed"]),
        attenuation=float(file.attrs["attenuation"]),
        ends=(left, right) if _loaded_end(file) == "left" else (right, left),
        broken=float(np.min(file["cracks/time"][:], initial=np.inf)),
    )


def _length(file: h5py.File) -> float:
    """Length of a recorded bar, m."""
    return float(np.ravel(file.attrs["size"])[0])


def _loaded_end(file: h5py.File) -> str:
    """The end of a recorded bar from which all positions are measured."""
    loaded = text_of(file.attrs.get("loaded", ""))
    if loaded not in ("left", "right"):
        where = {"both": "both ends", "none": "neither end"}.get(loaded, "an end that the record does not name")
        raise CaseError([f"{file.filename}: has a bar loaded at {where}, must be loaded at the left or the right"])
    return loaded


def _from_loaded_end(file: h5py.File, group: h5py.Group) -> float:
    """Distance of a recorded monitor from the loaded end, m."""
    x = float(np.ravel(group.attrs["position"])[0])
    return x if _loaded_end(file) == "left" else _length(file) - x


def _is_at(file: h5py.File, group: h5py.Group, place: float) -> bool:
    """Whether a recorded monitor is at a position, m from the loaded end."""
    return abs(_from_loaded_end(file, group) - place) < ROUNDING * _length(file)


def _samples(path: Path, quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of a text file."""
    try:
        time, values = read_samples(path, quantity).T
    except ValueError as error:
        raise CaseError([str(error).removeprefix("path: ")]) from None
    _enough(time, path)
    return time, values


def _enough(time: np.ndarray, path: Path) -> None:
    """Raise CaseError for a history (k,) of too few samples."""
    if len(time) < FEWEST:
        raise CaseError([f"{path}: contains {len(time)} samples, must contain three or more"])
