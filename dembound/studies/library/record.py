"""Records that a library responds to: read from text files, checked, and brought to its spacing."""

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from dembound.errors import CaseError
from dembound.waves.file_wave import read_text, samples_of

WHOLE = 1e-6
"""Part of the spacing by which a record's time may differ from a whole multiple, as files round times."""


class Record(NamedTuple):
    """A record for some inputs of a library.

    name : of its results. values : input -> velocities (k,) m/s, or factors of a load, at the times 0, Δ, 2Δ … files :
    input -> path and text of the file.
    """

    name: str
    values: dict[str, np.ndarray]
    files: dict[str, tuple[Path, str]]


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


def on_spacing(samples: np.ndarray, clock: RecordTimes) -> np.ndarray:
    """The values of a record at the times 0, Δ, 2Δ … up to its end, Δ being the spacing.

    samples (k, 2), times and values, are joined by straight lines; their times must be whole multiples of the spacing,
    so that nothing changes. Before and after it a record is zero, so it begins and ends with zero; one that lasts the
    whole duration may end with another value.

    Raises ValueError, with the problem.
    """
    spacing, duration, lead = clock
    times, values = samples.T
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
    found = np.interp(np.arange(places[-1] + 1.0), places, values, left=0.0)
    if found[: lead + 1].any():
        first = spacing * (np.flatnonzero(found)[0] - 1)
        needed = (
            f"the wave of [incident] passes the first disks before its point; it must be 0 up to {lead * spacing:g} s"
        )
        raise ValueError(f"begins at {first:g} s, but {needed}")
    return found


def _record(argument: str, inputs: Sequence[str], clock: RecordTimes) -> Record:
    """The record of one argument; raises CaseError for its mistakes."""
    paths = _paths(argument, inputs)
    values, files, problems = {}, {}, []
    for name, path in paths.items():
        try:
            text = read_text(path)
            values[name] = on_spacing(samples_of(text, path), clock)
            files[name] = path, text
        except ValueError as error:
            message = str(error).removeprefix("path: ")
            problems.append(message if str(path) in message else f"{path}: {message}")
    if problems:
        raise CaseError(problems)
    return Record("_".join(dict.fromkeys(path.stem for path in paths.values())), values, files)


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
