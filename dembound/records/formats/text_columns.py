"""Columns of numbers in text files with a header, as spreadsheets and programs write them.

A column of times and one or more of values, or values alone and the time step or the sampling rate in the header, as
"dt = 0.01 s" or "100 samples/s".
"""

import re
from collections.abc import Collection, Iterable, Sequence

import numpy as np

from dembound.errors import CaseError
from dembound.gauge.reading.scope import BROKEN_OFF, Columns, read_columns
from dembound.records.channel import Channel, Record
from dembound.records.formats.format import Format
from dembound.records.formats.source import DECIMAL, MOTIONS, NUMBER, Flaw, Source
from dembound.table import LARGEST, SMALLEST
from dembound.waves.unit_names import unit_named, units_in

TIME = re.compile(r"(t|time|sec|seconds?)(?![a-z])", re.IGNORECASE)
STEP = re.compile(
    r"\b(?:dt|delta ?t|time ?step|step|sampling interval)\b\s*[\[(]?(m?s(?:ec)?)?[\])]?\s*[=:,]?\s*"
    rf"({DECIMAL})\s*(m?s(?:ec)?\b)?",
    re.IGNORECASE,
)
"""The time step in a header, its unit before or behind it."""

RATE = re.compile(
    r"\b(?:sampl(?:ing|e)(?: rate| frequency)?|fs)\b\s*"
    rf"(?:[\[(]hz[\])]\s*[=:,]?\s*({DECIMAL})|[=:,]?\s*({DECIMAL})\s*hz\b)"
    rf"|({DECIMAL})\s*(?:samples\s*(?:/|per)\s*s(?:ec(?:ond)?)?\b|sps\b)",
    re.IGNORECASE,
)
"""The sampling rate in a header, Hz or samples/s."""

MOST_UNNAMED = 4
"""Columns that a file without their names may have; more of them are rather one series in lines."""


class TextColumns(Format):
    """Of any separator; each column of values is a channel, called as in the header, without a unit behind "_"."""

    name = "columns of text"

    def recognises(self, lines: Sequence[str]) -> bool:
        """True: whatever no other format is."""
        return True

    def read(self, source: Source) -> Record:
        """The channels of a file; raises CaseError for one without columns of numbers."""
        filled = [line for line in source.lines if line.strip()]
        if filled and NUMBER.fullmatch(filled[-1].strip()):
            channels = [_of_one_column(source)]
        else:
            channels = _of_columns(source, read_columns(source.path))
        return Record("columns of text", "", tuple(channels))


def _of_one_column(source: Source) -> Channel:
    """The values of a file with one number in a line."""
    numbers = [index for index, line in enumerate(source.lines) if NUMBER.fullmatch(line.strip())]
    other = [index for index, line in enumerate(source.lines) if line.strip() and not NUMBER.fullmatch(line.strip())]
    first = other[-1] + 1 if other else 0
    if sum(index < first for index in numbers) >= BROKEN_OFF:
        raise Flaw(f"line {first} is no number like the lines around it")
    header = "\n".join(source.lines[:first])
    values = np.array([float(source.lines[index].strip()) for index in numbers if index >= first])
    if (step := _step(header)) is None:
        raise Flaw(
            "has one column and states no time step, must have a line above the values such as "
            '"dt = 0.01 s" or "sampling: 100 Hz"'
        )
    return source.channel("", source.measured(_only_unit(header)), values, step)


def _of_columns(source: Source, columns: Columns) -> list[Channel]:
    """The channels of a file with two or more numbers in a line."""
    names, header = columns.names, "\n".join(" ".join(fields) for fields in columns.header)
    count, step = len(names), _step(header)
    if count > MOST_UNNAMED and not any(names):
        raise Flaw(f"has {count} columns without names, must have a line with their names above them")
    units = [[*columns.units(column), names[column]] for column in range(count)]
    timed = [column for column in range(count) if TIME.match(names[column]) or _unit(units[column], ("times",))]
    try:
        values = [np.array(columns.values(column)) for column in range(count)]
    except CaseError as error:
        raise Flaw(error.problems[0].removeprefix(f"{source.path}: ")) from None
    if timed or step is None or (not any(names) and (np.diff(values[0]) > 0.0).all()):
        at = timed[0] if timed else 0
        size = unit.size if (unit := unit_named(_unit(units[at], ("times",)))) else 1.0
        time = size * values[at]
    else:
        at, time = -1, step * np.arange(float(len(values[0])))
    found = []
    for column in range(count):
        if column != at:
            spelled = _unit(units[column], MOTIONS) or _only_unit(header)
            even, numbers = source.evenly(time, values[column])
            between = float(f"{(even[-1] - even[0]) / (len(even) - 1):.12g}")
            name = names[column].removesuffix(f"_{spelled}")
            found.append(source.channel(name, source.measured(spelled), numbers, between, float(even[0])))
    return found


def _unit(texts: Iterable[str], quantities: Collection[str]) -> str:
    """The first unit of one of these quantities in texts, as it is spelled; empty without any."""
    for text in texts:
        marked, bare, _ = units_in(text, "m/s²")
        for unit in (unit_named(text), *marked, *bare):
            if unit is not None and unit.quantity in quantities:
                return unit.spelled
    return ""


def _only_unit(header: str) -> str:
    """The unit of a motion that is alone in a header; empty without one, and for several."""
    marked, bare, _ = units_in(header, "m/s²")
    found = {(unit.quantity, unit.size): unit.spelled for unit in (*marked, *bare) if unit.quantity in MOTIONS}
    return next(iter(found.values())) if len(found) == 1 else ""


def _step(header: str) -> float | None:
    """The time step in a header, s; None without one. Raises Flaw for one that is not positive."""
    if found := STEP.search(header):
        unit = (found[1] or found[3] or "s").lower()
        step = float(found[2]) * (1e-3 if unit.startswith("m") else 1.0)
    elif found := RATE.search(header):
        rate = float(next(filter(None, found.groups())))
        step = 1.0 / rate if rate else 0.0
    else:
        return None
    if not SMALLEST <= step <= LARGEST:
        raise Flaw(f"has a time step of {step:g} s, must be positive")
    return step
