"""The signal of a gauge on a bar, and the velocity of its free end: read from text and from records of runs.

Signals and numbers that would silently give a wrong result are refused.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import h5py
import numpy as np

from dembound.errors import CaseError
from dembound.gauge.baseline import Treatment, treated
from dembound.gauge.estimates import FEWEST
from dembound.gauge.peaks import NOISE_FACTOR, longest, white_noise, width_of
from dembound.gauge.reading.signal import Reading, Signal, read_signal
from dembound.meanings import MEANINGS
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
) -> tuple[Signal, tuple[float, float, float | None], BarMetadata | None]:
    """The stress at a monitor, its position and the bar's length, m, and density, kg/m³, and data of the bar.

    The density and the last are None where the record does not have them.
    """
    with open_record(path) as file:
        group = _gauge(file, name)
        time, stress = history_of(group, "stress")
        if len(time) < FEWEST:
            raise CaseError([f"{path}: contains {len(time)} samples, must contain three or more"])
        if "range" in group.attrs:
            raise CaseError([f"{path}: has a bar of several ranges, must have one without interfaces"])
        density = None if "density" not in file.attrs else float(file.attrs["density"])
        bar = _from_loaded_end(file, group), bar_length(file), density
        return Signal(time, stress, "Pa"), bar, bar_metadata(file)


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


LONGEST = 100.0
"""Length of a bar, m, above which it was probably given in millimetres."""


@dataclass(frozen=True)
class Gauge:
    """A gauge on a bar, and its signal.

    time, stress : (k,) s and Pa, or the unit measured, tension positive; position : from the loaded end, m; length :
    the bar's, m; density : kg/m³, or None; metadata : data of the bar from a record, None for a text file; unit : Pa,
    V, strain, or empty if unknown; modulus : E in Pa of strains, None for ρc²; notes : what was done to the signal.
    """

    time: np.ndarray
    stress: np.ndarray
    position: float
    length: float
    density: float | None
    metadata: BarMetadata | None = None
    unit: str = "Pa"
    modulus: float | None = None
    notes: tuple[str, ...] = ()

    def in_pascals(self, speed: float) -> "Gauge":
        """The gauge with stresses in Pa: strains times E, by default ρc² with c = speed, m/s.

        Raises CaseError where they cannot be computed.
        """
        if self.unit == "Pa":
            return self
        if self.unit != "strain":
            said = f"the values are in {self.unit}" if self.unit else "the file does not say what its values are"
            raise CaseError([f"--unit: {said}, strengths need stresses: give --unit, --scale or --gauge-factor"])
        modulus = self.modulus
        if modulus is None and self.density is not None:
            modulus = self.density * speed**2
        if modulus is None:
            raise CaseError(["--youngs-modulus: is missing, or --density for E = ρc², to make stresses of strains"])
        return replace(self, stress=modulus * self.stress, unit="Pa", modulus=modulus)


def read_gauge(
    path: Path,
    monitor: str | None = None,
    position: float | None = None,
    length: float | None = None,
    density: float | None = None,
    reading: Reading | None = None,
    treatment: Treatment | None = None,
    modulus: float | None = None,
    *,
    may_be_clipped: bool = False,
) -> Gauge:
    """Read a gauge from a text file, or from a monitor in the record of a run.

    Parameters
    ----------
    path : the file.
    monitor : its name in the record; may be left out if there is only one between the ends. position, length, density,
    modulus : attributes of `Gauge`; the first three by default from the record. reading : how a text file is read.
    treatment : baseline and filters to remove from its signal, by default the baseline; from a record only filters
    apply.
    may_be_clipped : accept a text file's signal with a plateau.

    Raises CaseError for a file that cannot be read, an unknown monitor, a bar that is not loaded at one end, a gauge
    that is not on the bar, and a signal that is clipped or too coarse.
    """
    reading = reading or Reading()
    if is_record(path):
        require_for_results(path, reading, column=reading.column, modulus=modulus)
        signal, bar, metadata = recorded_gauge(path, monitor)
        both = zip((position, length, density), bar, strict=True)
        position, length, density = (known if given is None else given for given, known in both)
        treatment = treatment and replace(treatment, baseline=False)
    else:
        signal, metadata = read_signal(path, reading), None
        if monitor is not None:
            raise CaseError([f"--monitor: is for results of a run, {path} is a text file"])
    problems = list(_problems_with_bar(position, length))
    if is_record(path):
        problems += not_above_zero("--density", density, "kg/m³")
    else:
        problems += implausible_size("--density", density, "density", "kg/m³")
        problems += implausible_size("--youngs-modulus", modulus, "modulus", "Pa")
        problems += unfit_signal(signal.values, may_be_clipped=may_be_clipped) if not problems else []
    if problems or position is None or length is None:
        raise CaseError(problems)
    if treatment is not None or not is_record(path):
        signal = treated(signal, treatment)
    return Gauge(signal.time, signal.values, position, length, density, metadata, signal.unit, modulus, signal.notes)


def read_free_end(path: Path, free_end: str) -> tuple[np.ndarray, np.ndarray]:
    """Times (k,) in s and velocities (k,) in m/s, positive outwards, of a bar's free end.

    Parameters
    ----------
    path : the gauge's file.
    free_end : a monitor in it if it is a record, which must be at the end opposite the loaded one, and this end must be
    free; else the path of a text file of two columns.

    Raises CaseError if `free_end` is neither.
    """
    if not is_record(path):
        if not Path(free_end).is_file():
            raise CaseError([f"--free-end: is {free_end}, must be a text file of time (s) and velocity (m/s)"])
        signal = read_signal(Path(free_end), usual="m/s")
        if signal.unit not in ("m/s", ""):
            raise CaseError([f"--free-end: has values in {signal.unit}, must be velocities"])
        return signal.time, signal.values
    return recorded_free_end(path, free_end)


def not_on_bar(option: str, place: float, length: float) -> Iterator[str]:
    """Message about an option's position, m from the loaded end, if it is not between the ends of a bar."""
    if not 0.0 < place < length:
        yield f"{option}: is {place:g} m, must be above 0 and below the length, {length:g} m"


def _problems_with_bar(position: float | None, length: float | None) -> Iterator[str]:
    """Missing or impossible data of a gauge on a bar."""
    if position is None:
        yield "--position: is missing, must be the gauge's place (m) from the loaded end"
    if length is None:
        yield "--length: is missing, must be that of the bar (m)"
    unfit = list(not_above_zero("--length", length, "m"))
    yield from unfit
    if length is not None and LONGEST < length < np.inf:
        yield f"--length: is {length:g} m, must be at most {LONGEST:g} m; positions and lengths are in m, not mm"
    elif position is not None and length is not None and not unfit:
        yield from not_on_bar("--position", position, length)


COARSE = 5
"""Least number of samples of the largest wave above half its height."""

SHARE_CLIPPED, LEAST_CLIPPED = 0.1, 5
"""Equal samples at an extreme value from which on it is taken for clipped: over the wave's width, and their number."""

ABRUPT = 8.0
"""Fall beside a crest, in steps of the digitiser, that indicates clipping; a round crest falls by four."""


def not_above_zero(option: str, value: float | None, unit: str) -> Iterator[str]:
    """Message about an option's value, in its unit, if it is not a positive number."""
    if value is not None and not 0.0 < value < np.inf:
        yield f"{option}: is {value:g} {unit}, must be finite and above 0"


def implausible_size(option: str, value: float | None, means: str, unit: str) -> Iterator[str]:
    """Message about an option whose value is not positive, or of a size unlikely for its meaning."""
    yield from (unfit := list(not_above_zero(option, value, unit)))
    if value is not None and not unfit and (doubt := MEANINGS[means].doubt(value, unit)):
        yield f"{option}: {doubt}"


def unfit_signal(values: np.ndarray, *, may_be_clipped: bool = False) -> Iterator[str]:
    """Messages about a signal (k,) that is noise, clipped, or sampled too coarsely for its largest wave."""
    sizes, noise = np.abs(values - np.median(values)), white_noise(values)
    if width_of(sizes) < COARSE and sizes.max() < NOISE_FACTOR * noise:
        yield f"the signal is noise: its largest value is {sizes.max() / noise:.2g} standard deviations, and no wave"
        return
    if (width := width_of(np.abs(values))) < COARSE:
        has = f"the largest wave has {width} samples above half its height, needs {COARSE}"
        yield f"the sampling is too coarse: {has}; or it is a spike"
    for sense, extreme in ((1.0, "largest"), (-1.0, "smallest")):
        if not may_be_clipped and (count := clipped(sense * values)):
            row = f"{count} samples in a row have its {extreme} value, {sense * float((sense * values).max()):.4g}"
            advice = "record it with a larger range, or allow it with --clipped if it is the wave's own plateau"
            yield f"the signal is clipped: {row}; {advice}"


def clipped(values: np.ndarray) -> int:
    """Number of equal samples at the largest value of a signal (k,) whose slope breaks off there; 0 if it does not."""
    top = float(values.max())
    first, end = longest(values == top) or (0, 0)
    count = end - first
    if top <= 0.0 or count < max(LEAST_CLIPPED, SHARE_CLIPPED * width_of(np.maximum(values, 0.0))):
        return 0
    step = float(np.diff(np.unique(values)[-50:]).min())
    fall = top - float(values[max(first - count // 2, 0)])
    return count if fall > ABRUPT * step else 0
