"""What a gauge on a bar has felt, and how the bar's free end has moved: read from text and from records of runs."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np

from dembound.errors import CaseError
from dembound.gauges import FEWEST
from dembound.results import open_record
from dembound.waves.record import read_samples


@dataclass(frozen=True)
class Gauge:
    """A gauge on a bar, and what it has felt.

    time, stress : (k,) s and Pa, tension positive; position : from the loaded end, m; length : the bar's, m;
    density : kg/m³, None where it is not known.
    """

    time: np.ndarray
    stress: np.ndarray
    position: float
    length: float
    density: float | None


class Known(NamedTuple):
    """What a record knows of a gauge: its position and the bar's length, m, and density, kg/m³; None is unknown."""

    position: float | None = None
    length: float | None = None
    density: float | None = None


def read_gauge(
    path: Path,
    monitor: str | None = None,
    position: float | None = None,
    length: float | None = None,
    density: float | None = None,
    scale: float = 1.0,
) -> Gauge:
    """Read a gauge from a text file of two columns, or a monitor's from the record of a run.

    Parameters
    ----------
    path : the file.
    monitor : its name in the record; may be left out where only one has felt stresses.
    position, length, density : as of `Gauge`; by default what the record says.
    scale : factor of the values, not 0.

    Raises CaseError for a file that cannot be read, an unknown monitor, a bar that is not loaded at one end, and a
    gauge that is not on the bar.
    """
    if h5py.is_hdf5(path):
        time, stress, known = _recorded(path, monitor)
    else:
        (time, stress), known = _samples(path, "stress (Pa)"), Known()
        if monitor is not None:
            raise CaseError([f"--monitor: is for results of a run, {path} is a text file"])
    place, long, dense = (
        recorded if given is None else given for given, recorded in zip((position, length, density), known, strict=True)
    )
    problems = list(_problems_with_bar(place, long, dense))
    if not np.isfinite(scale) or scale == 0.0:
        problems.append(f"--scale: is {scale:g}, must be finite and not 0")
    if problems:
        raise CaseError(problems)
    assert place is not None
    assert long is not None
    return Gauge(time, scale * stress, place, long, dense)


def read_free_end(path: Path, free_end: str) -> np.ndarray:
    """Velocity (k,) in m/s, positive outwards, of a monitor in a record; else from a text file of that name.

    Raises CaseError for a file that cannot be read, an unknown monitor, and one that is not at the end opposite the
    loaded one.
    """
    if not h5py.is_hdf5(path):
        return _samples(Path(free_end), "velocity (m/s)")[1]
    with open_record(path) as file:
        group = _monitor(file.get("histories", {}), free_end, "--free-end")
        position, length = _from_loaded_end(file, group), _length(file)
        if not np.isclose(position, length):
            place = f"{position:g} m from the loaded end of a bar of {length:g} m"
            raise CaseError([f"--free-end: is {free_end}, {place}, must be at its other end"])
        outwards = 1.0 if _loaded_end(file) == "left" else -1.0
        return outwards * group["velocity"][:, 0]


def not_above_zero(option: str, value: float | None, unit: str) -> Iterator[str]:
    """What is wrong with an option's value, in its unit, if it is not a positive number."""
    if value is not None and not 0.0 < value < np.inf:
        yield f"{option}: is {value:g} {unit}, must be finite and above 0"


def not_on_bar(option: str, place: float, length: float) -> Iterator[str]:
    """What is wrong with an option's place, m from the loaded end, if it is not between the ends of a bar."""
    if not 0.0 < place < length:
        yield f"{option}: is {place:g} m, must be between 0 and the length, {length:g} m"


def _problems_with_bar(position: float | None, length: float | None, density: float | None) -> Iterator[str]:
    """What keeps a gauge from being one on a bar."""
    for option, value in (("--position", position), ("--length", length)):
        if value is None:
            yield f"{option}: is not known, give it"
    unfit = list(not_above_zero("--length", length, "m"))
    yield from unfit
    if position is not None and length is not None and not unfit:
        yield from not_on_bar("--position", position, length)
    yield from not_above_zero("--density", density, "kg/m³")


def _recorded(path: Path, name: str | None) -> tuple[np.ndarray, np.ndarray, Known]:
    """Time, stress and what else is known of a monitor in a record."""
    with open_record(path) as file:
        felt = {name: group for name, group in file.get("histories", {}).items() if "stress" in group}
        if not felt:
            raise CaseError([f"{path}: holds no history of stress, which monitors on bars have"])
        if name is None and len(felt) > 1:
            raise CaseError([f"--monitor: is not named, must be one of {', '.join(felt)}"])
        group = _monitor(felt, name or next(iter(felt)), "--monitor")
        time, stress = group["time"][:], group["stress"][:]
        _enough(time, path)
        density = file.attrs.get("density")
        known = Known(
            position=_from_loaded_end(file, group),
            length=_length(file),
            density=None if density is None else float(density),
        )
        return time, stress, known


def _monitor(groups: dict[str, h5py.Group], name: str, option: str) -> h5py.Group:
    """A monitor's history by its name, which an option has given."""
    if name not in groups:
        raise CaseError([f"{option}: is {name}, must be one of {', '.join(groups)}"])
    return groups[name]


def _length(file: h5py.File) -> float:
    """Length of a recorded bar, m."""
    return float(np.ravel(file.attrs["size"])[0])


def _loaded_end(file: h5py.File) -> str:
    """The end of a recorded bar from which all places count."""
    loaded = file.attrs.get("loaded")
    if loaded not in ("left", "right"):
        where = {"both": "both ends", "none": "neither end"}.get(loaded, "an end that is not told")
        raise CaseError([f"{file.filename}: is of a bar loaded at {where}, must be loaded at the left or the right"])
    return str(loaded)


def _from_loaded_end(file: h5py.File, group: h5py.Group) -> float:
    """Where a recorded monitor is, m."""
    x = float(np.ravel(group.attrs["position"])[0])
    return x if _loaded_end(file) == "left" else _length(file) - x


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
        raise CaseError([f"{path}: holds {len(time)} samples, must hold three or more"])
