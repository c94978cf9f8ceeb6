"""Records that a library responds to: read from text files, checked, and brought to its spacing."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from pydantic import ValidationError

from dembound.errors import CaseError
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
        raise ValueError(
            f"ends with {values[-1]:g} before the library does, must end with 0; put a line with 0 after it"
        )
    points = np.interp(np.linspace(0.0, len(places) - 1.0, len(wave.line.values)), np.arange(len(places)), places)
    found = np.interp(np.arange(places[-1] + 1.0), points, wave.line.values, left=0.0)
    if found[: lead + 1].any():
        first = spacing * (np.flatnonzero(found)[0] - 1)
        needed = (
            f"the wave of [incident] passes the first disks before its point; it must be 0 up to {lead * spacing:g} s"
        )
        raise ValueError(f"begins at {first:g} s, but {needed}")
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
