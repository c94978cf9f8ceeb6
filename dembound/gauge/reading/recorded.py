"""A gauge and its bar in the record of a run."""

from dataclasses import dataclass
from pathlib import Path

import h5py
import numpy as np

from dembound.errors import CaseError
from dembound.gauge.estimates import FEWEST
from dembound.gauge.reading.signal import Reading
from dembound.results.reader import history_of, open_record, text_of

FREE = "free"
"""The type of a free end."""

ROUNDING = 1e-9
"""Share of a bar's length within which two positions are equal."""


@dataclass(frozen=True)
class BarMetadata:
    """Data of the bar in the record of a run.

    speed : of waves, m/s; attenuation : 1/m; ends : types of the loaded end and of the other end; broken : time at
    which the first bond broke, s, infinite for an unbroken bar; strength : of the case at the slowest and at the
    fastest strain rate, Pa, infinite for an unbreakable bar, None if the record does not have it.
    """

    speed: float
    attenuation: float
    ends: tuple[str, str]
    broken: float
    strength: tuple[float, float] | None = None


def is_record(path: Path) -> bool:
    """Whether a file is a record by its name or contents; else it is a text."""
    return path.suffix == ".h5" or h5py.is_hdf5(path)


def require_for_results(
    path: Path, reading: Reading, *, column: str | None = None, modulus: float | None = None
) -> None:
    """Raise CaseError for options that have no meaning for the record of a run: its stresses are in Pa, its times in s.

    reading : how a text file would be read, without its column, which may be a monitor's name. column : of a text file.
    modulus : E, if it has no effect.
    """
    given = {
        "--column": column,
        "--time-column": reading.time_column,
        "--time-unit": reading.time_unit,
        "--unit": reading.unit,
        "--gauge-factor": reading.bridge,
        "--scale": reading.scale if reading.scale != 1.0 else None,
        "--youngs-modulus": modulus,
    }
    says = f"is for text files, {path} has results of a run, with stresses in Pa and times in s; leave it out"
    if problems := [f"{option}: {says}" for option, value in given.items() if value is not None]:
        raise CaseError(problems)


def recorded_gauge(
    path: Path, name: str | None
) -> tuple[np.ndarray, np.ndarray, float, float, float | None, BarMetadata | None]:
    """Time (k,) s and stress (k,) Pa of a monitor, its position and the bar's length, m, and density, kg/m³, its bar.

    The last two are None where the record does not have them.
    """
    with open_record(path) as file:
        group = _gauge(file, name)
        time, stress = history_of(group, "stress")
        if len(time) < FEWEST:
            raise CaseError([f"{path}: contains {len(time)} samples, must contain three or more"])
        if "range" in group.attrs:
            raise CaseError([f"{path}: has a bar of several ranges, must have one without interfaces"])
        density = None if "density" not in file.attrs else float(file.attrs["density"])
        return time, stress, _from_loaded_end(file, group), bar_length(file), density, bar_metadata(file)


def recorded_free_end(path: Path, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Time (k,) s and velocity (k,) m/s, positive outwards, of a monitor at the free end of a recorded bar."""
    with open_record(path) as file:
        histories = file.get("histories", {}).items()
        there = {each: group for each, group in histories if is_at(file, group, bar_length(file))}
        if name not in there:
            allowed = f"which is {' or '.join(there)}" if there else "but the results have none there"
            raise CaseError([f"--free-end: is {name}, must be a monitor at the end opposite the load, {allowed}"])
        metadata = bar_metadata(file)
        if metadata is not None and metadata.ends[1] != FREE:
            raise CaseError([f"--free-end: is {name}, where the bar's end is {metadata.ends[1]}, must be free"])
        time, velocity = history_of(there[name], "velocity")
        return time, (1.0 if loaded_end(file) == "left" else -1.0) * velocity[:, 0]


def _gauge(file: h5py.File, name: str | None) -> h5py.Group:
    """The history of a monitor between the ends of a recorded bar, by its name or as the only one."""
    signals = {
        each: group
        for each, group in file.get("histories", {}).items()
        if "stress" in group and not is_at(file, group, 0.0) and not is_at(file, group, bar_length(file))
    }
    if not signals:
        raise CaseError([f"{file.filename}: contains no history of stress between the ends of a bar"])
    if name is None and len(signals) > 1:
        raise CaseError([f"--monitor: is not named, must be one of {', '.join(signals)}"])
    if name is not None and name not in signals:
        raise CaseError([f"--monitor: is {name}, must be between the bar's ends, which is {' or '.join(signals)}"])
    return signals[next(iter(signals)) if name is None else name]


def bar_metadata(file: h5py.File) -> BarMetadata | None:
    """Data of the bar in a record; None if it has no wave speed."""
    if "wave_speed" not in file.attrs:
        return None
    left, right = map(text_of, file.attrs["ends"])
    return BarMetadata(
        speed=float(file.attrs["wave_speed"]),
        attenuation=float(file.attrs["attenuation"]),
        ends=(left, right) if loaded_end(file) == "left" else (right, left),
        broken=float(np.min(file["cracks/time"][:], initial=np.inf)),
        strength=tuple(file.attrs["strength"].tolist()) if "strength" in file.attrs else None,
    )


def bar_length(file: h5py.File) -> float:
    """Length of a recorded bar, m."""
    return float(np.ravel(file.attrs["size"])[0])


def loaded_end(file: h5py.File) -> str:
    """The end of a recorded bar from which all positions are measured."""
    loaded = text_of(file.attrs.get("loaded", ""))
    if loaded not in ("left", "right"):
        where = {"both": "both ends", "none": "neither end"}.get(loaded, "an end that the record does not name")
        raise CaseError([f"{file.filename}: has a bar loaded at {where}, must be loaded at the left or the right"])
    return loaded


def _from_loaded_end(file: h5py.File, group: h5py.Group) -> float:
    """Distance of a recorded monitor, whose first coordinate is along the bar, from the loaded end, m."""
    x = float(np.ravel(group.attrs["position"])[0])
    return x if loaded_end(file) == "left" else bar_length(file) - x


def is_at(file: h5py.File, group: h5py.Group, place: float) -> bool:
    """Whether a recorded monitor is at a position, m from the loaded end."""
    return abs(_from_loaded_end(file, group) - place) < ROUNDING * bar_length(file)
