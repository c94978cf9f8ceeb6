"""A library: the responses of a scene to its inputs, and histories under any record as sums of them.

Records are read from text files, checked, and brought to the spacing of the library.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import ConfigDict, Field, ValidationError

from dembound.casefile.disks import DiskCase
from dembound.casefile.model import as_kind
from dembound.errors import CaseError, RecordError
from dembound.kinds import loads
from dembound.results.reader import open_record
from dembound.results.text_files import read_json
from dembound.studies.library.build import FILE, HAT, REST, inputs_of, is_at_rest
from dembound.version import __version__
from dembound.waves import FileWave
from dembound.words import percent

WHOLE = 1e-6
"""Part of the spacing by which a record's time may differ from a whole multiple, as files round times."""


class Record(NamedTuple):
    """A record for some inputs of a library.

    name : of its results. values : input -> velocities (k,) m/s, or factors of a load, at the times 0, Δ, 2Δ … files :
    input -> path and text of the file. losses : by a spacing too coarse for the record, a sentence for each file.
    """

    name: str
    values: dict[str, np.ndarray]
    files: dict[str, tuple[Path, str]]
    losses: tuple[str, ...] = ()


class RecordTimes(NamedTuple):
    """Requirements on records: spacing and duration, s; lead : number of zeros after the first value, see `Library`."""

    spacing: float
    duration: float
    lead: int = 0


def read_records(arguments: Sequence[str], inputs: Sequence[str], clock: RecordTimes) -> list[Record]:
    """The records of a command line.

    Parameters
    ----------
    arguments : of a library with one input the path of a text file; else, or also, ``INPUT=PATH``, of several inputs
        separated by commas; inputs without a file remain silent.
    inputs, clock : of the library.

    Raises CaseError with a line for each mistake, see `on_spacing`, and for two records of one name.
    """
    records, problems = [], []
    for argument in arguments:
        try:
            records.append(_record(argument, inputs, clock))
        except CaseError as error:
            problems += error.problems
    names = [record.name for record in records]
    problems += [f"RECORD: two records are called {name}, so one would replace the other" for name in _twice(names)]
    if problems:
        raise CaseError(problems)
    return records


def on_spacing(wave: FileWave, clock: RecordTimes) -> np.ndarray:
    """The values of a record at the times 0, Δ, 2Δ … up to its end, Δ being the spacing.

    The times of its samples must be whole multiples of the spacing. Then straight lines between samples do not change,
    nor do those of the band-limited function if the spacing is a whole fraction of theirs. Before and after it a record
    is zero, so it begins and ends with zero; one that lasts the whole duration may end with another value.

    Raises ValueError, with the problem.
    """
    spacing, duration, lead = clock
    times, values = wave.samples.times, wave.samples.values
    places = np.round(times / spacing)
    if times[0] < 0.0:
        raise ValueError(f"begins at {times[0]:g} s, must not begin before 0")
    if times[-1] > duration + WHOLE * spacing:
        raise ValueError(f"lasts {times[-1]:g} s, the library only {duration:g} s")
    if (away := np.abs(times - places * spacing) > WHOLE * spacing).any():
        first = times[np.argmax(away)]
        raise ValueError(f"has a value at {first:.10g} s, no whole multiple of the library's spacing, {spacing:g} s")
    if (np.diff(places) < 1.0).any():
        raise ValueError(f"has values closer than the library's spacing, {spacing:g} s")
    if values[0] != 0.0:
        raise ValueError(f"begins with {values[0]:g}, must begin with 0; put a line with 0 before it")
    if values[-1] != 0.0 and times[-1] < duration - WHOLE * spacing:
        must = "must end with 0; put a line with 0 after it"
        raise ValueError(f"ends with {values[-1]:g} before the library does, {must}")
    points = np.interp(np.linspace(0.0, len(places) - 1.0, len(wave.line.values)), np.arange(len(places)), places)
    found = np.interp(np.arange(places[-1] + 1.0), points, wave.line.values, left=0.0)
    if found[: lead + 1].any():
        first, until = spacing * (np.flatnonzero(found)[0] - 1), f"it must be 0 up to {lead * spacing:g} s"
        passes = "the wave of [incident] passes the first disks before its point"
        raise ValueError(f"begins at {first:g} s, but {passes}; {until}")
    return found


def loss_on_spacing(wave: FileWave, spacing: float) -> str:
    """What straight lines at a spacing (s) take from a record's highest frequency, in words.

    Empty for one joined by lines, and if the spacing is not above that of its own points.
    """
    own = (wave.line.times[-1] - wave.line.times[0]) / (len(wave.line.times) - 1)
    if wave.joined_by == "lines" or spacing < own * (1.0 + WHOLE):
        return ""
    highest = wave.highest_frequency()
    loss = percent(1.0 - float(np.sinc(highest * spacing)) ** 2)
    return (
        f"straight lines at the library's spacing, {spacing:g} s, take {loss} of its amplitude at its highest "
        f"frequency, {highest:.3g} Hz; with --spacing {own:.6g} histories are those of a direct run"
    )


def _record(argument: str, inputs: Sequence[str], clock: RecordTimes) -> Record:
    """The record of one argument; raises CaseError for its mistakes."""
    paths = _paths(argument, inputs)
    values, files, losses, problems = {}, {}, [], []
    for name, path in paths.items():
        try:
            wave = _read(path)
            values[name] = on_spacing(wave, clock)
            (text,) = wave.files().values()
            files[name] = path, text
            losses += [f"{path}: {loss}"] if (loss := loss_on_spacing(wave, clock.spacing)) else []
        except ValueError as error:
            message = str(error).removeprefix("path: ")
            problems.append(message if str(path) in message else f"{path}: {message}")
    if problems:
        raise CaseError(problems)
    return Record("_".join(dict.fromkeys(path.stem for path in paths.values())), values, files, tuple(losses))


def _read(path: Path) -> FileWave:
    """The file wave of a direct run; raises ValueError with its only problem."""
    try:
        return FileWave.model_validate({"type": "file", "path": path.as_posix()})
    except ValidationError as error:
        raise ValueError(error.errors()[0]["msg"].removeprefix("Value error, ")) from None


def _paths(argument: str, inputs: Sequence[str]) -> dict[str, Path]:
    """Input -> file, from an argument."""
    pairs = [part.partition("=") for part in argument.split(",")]
    if all(name in inputs for name, _, _ in pairs) and all(equals for _, equals, _ in pairs):
        if twice := _twice([name for name, _, _ in pairs]):
            raise CaseError([f"RECORD: {argument}: names the input {twice[0]} twice"])
        return {name: Path(path) for name, _, path in pairs}
    if len(inputs) == 1:
        return {inputs[0]: Path(argument)}
    several = ", ".join(inputs)
    raise CaseError([f"RECORD: is {argument}, must be INPUT=FILE, or several with commas between; inputs: {several}"])


def _twice(names: Sequence[str]) -> list[str]:
    """The names that occur more than once."""
    return sorted({name for name in names if names.count(name) > 1})


MOST_LEAD = 10**6
"""Largest number of spacings before the values of a record."""

WIDTH = 6
"""Columns of a monitor: displacement x, y, rotation (m, rad), velocity x, y, rotation (m/s, rad/s)."""


@dataclass
class _Facts:
    """The contents of the file of a library."""

    version: str
    name: str
    spacing: Annotated[float, Field(gt=0.0)]
    lead: Annotated[int, Field(ge=0, le=MOST_LEAD)]
    inputs: Annotated[list[str], Field(min_length=1)]
    case: str

    __pydantic_config__ = ConfigDict(allow_inf_nan=False)


class Library:
    """A library in a folder.

    Attributes
    ----------
    folder : with the runs. name : of the case it was made from. case : the case with silent inputs. inputs : names of
    the waves that records replace. spacing : of records, s; lead : number of spacings after their first value
    during which they are zero. monitors : their names. time : (k,) s, of the samples of histories. attributes : of the
    runs' record; places : attributes of each monitor's history.

    Raises CaseError where there is no library, or one of another version.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        if not (folder / FILE).is_file():
            raise CaseError([f"{folder}: contains no library, must be a folder written by `dembound library`"])
        facts = read_json(folder / FILE, _Facts)
        self.name, self.spacing, self.inputs, self.lead = facts.name, facts.spacing, facts.inputs, facts.lead
        if facts.version != __version__:
            said = f"is a library of dembound {facts.version}, this is {__version__}"
            raise CaseError([f"{folder}: {said}; make it anew"])
        try:
            self.case = as_kind(loads(facts.case, folder, self.name), DiskCase, "is the case of a bar")
        except CaseError as error:
            raise RecordError([f"{folder / FILE}: is damaged, its case: {error.problems[0]}"]) from None
        if facts.inputs != inputs_of(self.case):
            raise RecordError([f"{folder / FILE}: is damaged: its inputs are not those of its case"])
        with open_record(self.record(f"{HAT}{self.inputs[0]}")) as file:
            groups = file["histories"]
            self.monitors = list(groups)
            times = groups[self.monitors[0]]["time"][:]
            self.attributes = dict(file.attrs)
            self.places = {name: dict(group.attrs) for name, group in groups.items()}

        self._per_spacing = max(1, round(self.spacing / (times[1] - times[0]))) if len(times) > 1 else 1
        self.time = times[: len(times) - self.lead * self._per_spacing]

    @property
    def clock(self) -> RecordTimes:
        """Spacing, lead and duration of records."""
        return RecordTimes(self.spacing, self.case.run.duration, self.lead)

    @cached_property
    def rest(self) -> np.ndarray:
        """Motion (k, monitors, 6) without waves, see `WIDTH`."""
        return self._rest_of_runs[: len(self.time)]

    @cached_property
    def _rest_of_runs(self) -> np.ndarray:
        """Motion without waves, as long as the runs."""
        if not is_at_rest(self.case):
            return self._motion(REST)
        return np.zeros((len(self.time) + self.lead * self._per_spacing, len(self.monitors), WIDTH))

    def response(self, name: str) -> np.ndarray:
        """Motion (k, monitors, 6) that one triangle of unit height of an input adds, which rises from time 0."""
        added = self._motion(f"{HAT}{name}") - self._rest_of_runs
        return added[self.lead * self._per_spacing :]

    def motion(self, values: Mapping[str, np.ndarray]) -> np.ndarray:
        """Motion (k, monitors, 6) under records.

        values : input -> velocities at the times 0, Δ, 2Δ …, the first `lead` + 1 of which are 0.

        Samples of histories and times of records lie on common times, so every `_per_spacing`-th sample is a
        discrete convolution of the record with the response at such samples, computed by Fourier transforms.
        """
        from scipy.fft import irfft, rfft

        summed: np.ndarray | float = 0.0
        for name, record in values.items():
            crests = record[1 : self._rows + 1]  # the first triangle has its crest at Δ
            summed = summed + rfft(crests, self._length)[:, None] * self._spectra[name]
        rows = np.asarray(irfft(np.atleast_2d(summed), self._length, axis=0))[: self._rows]
        samples = rows.reshape(-1, len(self.monitors), WIDTH)[: len(self.time)]
        moved: np.ndarray = samples + self.rest
        return moved

    @property
    def _rows(self) -> int:
        """Number of spacings in the histories."""
        return -(-len(self.time) // self._per_spacing)

    @cached_property
    def _length(self) -> int:
        """Length of the transforms, in spacings, with as many zeros as a convolution needs."""
        from scipy.fft import next_fast_len

        return int(next_fast_len(2 * self._rows, real=True))

    @cached_property
    def _spectra(self) -> dict[str, np.ndarray]:
        """Transforms (length/2 + 1, samples in a spacing · columns) of each input's response, along its spacings."""
        from scipy.fft import rfft

        found = {}
        for name in self.inputs:
            response = self.response(name).reshape(len(self.time), -1)
            padded = np.zeros((self._rows * self._per_spacing, response.shape[1]))
            padded[: len(response)] = response
            found[name] = np.asarray(rfft(padded.reshape(self._rows, -1), self._length, axis=0))
        return found

    def _motion(self, run: str) -> np.ndarray:
        """Motion (k, monitors, 6) in one of the library's runs."""
        with open_record(self.record(run)) as file:
            each = [np.hstack([group["displacement"][:], group["velocity"][:]]) for group in file["histories"].values()]
        return np.stack(each, axis=1)

    def record(self, run: str) -> Path:
        """The record of one of the library's runs."""
        return self.folder / run / "run.h5"
