"""Numbers in text files with a header, as spreadsheets and programs write them.

They are columns, one of times and others of values, or values alone with the time step or the sampling rate in the
header; or one series of values, any number of them to a line. Units count beside the name of a column, in a line of
units, and, for a single channel, beside its quantity; the number of samples and the peak that a header states must be
those of the file.
"""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from dembound.records.channel import Channel, Record
from dembound.records.formats.column_checks import (
    NUMBER,
    PEAK,
    compare_peaks,
    require_motions,
    require_no_card,
    require_order,
)
from dembound.records.formats.numbers import (
    BARE,
    COUNT,
    MOTIONS,
    QUANTITY,
    SECONDS,
    Flaw,
    quantities_named,
    require_increasing,
    seconds_of,
)
from dembound.records.formats.source import SAME, Format, Source
from dembound.records.formats.table import EITHER, OTHER, Head, Table, head_of, increases, quantity_of, read_table
from dembound.table import LARGEST, SMALLEST
from dembound.waves.unit_names import unit_named

STEP = re.compile(
    r"(?:\bdt\b|Δt|\bdelta ?t|\btime ?step|\bstep(?=\s*[=:])|\bdelta x(?=\t)"
    r"|\b(?:sampl\w*|time|digiti\w*) ?(?:interval|period|step)"
    r"|\b(?:interpolated|resampled) (?:at|to|every)(?= *[\d.,]+ *m?s)"
    rf"|\bintervals? of|\bspac(?:ing|ed)(?: of| at)?)\s*[\[(]?(?:{SECONDS}\b)?[\])]?\s*[=:,]?\s*{NUMBER}"
    rf"(?![.\d\s]*/)\s*[\[(]?(?:{SECONDS}\b)?",
    re.IGNORECASE,
)
"""The time step in a header, its unit before or behind it."""

RATE = re.compile(
    r"\b(?:sampl(?:ing|es?)? ?(?:rate|freq\w*)?|(?:interpolated|resampled) (?:at|to)|fs|(?:mess|abtast)?rate)\s*"
    rf"(?:[\[(](?:hz|sps)[\])]\s*[=:,]?\s*{NUMBER}|[=:,]?\s*{NUMBER}\s*(?:hz|sps)\b)"
    rf"|{NUMBER}\s*(?:samples\s*(?:/|per)\s*s(?:ec(?:ond)?)?\b|sps\b)",
    re.IGNORECASE,
)
"""The sampling rate in a header, Hz or samples/s."""

SAMPLES = re.compile(
    r"(?:\b(?:npts?|ndata|(?:number|no\.?) of (?:points|samples|data(?: points)?|values)"
    r"|n?samples(?=\s*[=:]|\t)|anzahl (?:der )?werte|nombre de points)|点数)"
    rf"\s*[=:]?\s*{COUNT}\b(?!\s*(?:/|per|hz|sps))"
    rf"|\b{COUNT}\s+(?:(?:data )?points|pts|samples|values)\b(?!\s*(?:/|per))",
    re.IGNORECASE,
)
"""The number of samples in a header."""


DURATION = re.compile(
    r"(?:(?:^|[,;|]|=\s*[\d.]+\s|\b(?:s|secs?|sps|total)\s)\s*(?:dura(?:tion|ci[oó]n)|(?:record )?length)(?: time)?\s*"
    rf"(?:[=:]?\s*(?={NUMBER[1:-1]}\s*s)|[\[(]s(?:ec\w*)?[\])]\s*[=:]\s*)|\bsps[,;]\s*(?={NUMBER[1:-1]}\s*s)){NUMBER}(?![.\d])",
    re.IGNORECASE,
)
"""The length of the record in a header, s, and not that of the strong motion in it."""


MISSING = frozenset(("999", "9999", "99999", "999999", "1e+06"))
"""Sizes of numbers that stand for missing samples, where they are far from all others."""

UNIT = re.compile(
    r"(?:\bunits?\b(?:\s*(?:are|is|of|:|=))*|\bdata(?= in )|单位|(?:"
    + "|".join(pattern.pattern for pattern in QUANTITY.values())
    + r")(?:\s+time (?:series|history))?)\s*(?:,\s*)?(?:in(?:\s+units\s+of)?\s+|[:=/]\s*)?"
    r"(?:[\[(]([^\])]+)[\])]|([^\s,;]+))(?!\s*[=:]?\s*[+-]?[.\d])",
    re.IGNORECASE,
)
"""The unit of a single channel, behind the name of its quantity or the word unit, and not before a number."""

LONG = 5
"""Numbers in a line from which on lines without heads of columns are one series."""

SHORT, OFFSET = 1e-5, 1e6
"""Time step and ratio of the first time to it below and above which times are days: no record is sampled so, s."""

FAR = 2.0
"""Ratio of a number to all others from which on it may stand for a missing sample."""

MOST = 0.9
"""Share of the lines of a deck with the next number from which on others are missing."""


class TextColumns(Format):
    """Of any separator; each column of values is a channel, called as in the header."""

    name = "columns of text"

    def recognises(self, lines: Sequence[str]) -> bool:
        """True: whatever no other format is."""
        return True

    def read(self, source: Source) -> Record:
        """The channels of a file; raises Flaw for one that may be read in two ways."""
        if source.given.series and source.given.columns:
            raise Flaw("--series: is not allowed together with --columns")
        require_no_card(source)
        table = _without_counter(source, read_table(source))
        heads = [head_of(name) for name in source.given.columns] or table.heads
        if source.given.columns and (len(heads) != table.width or table.ragged < len(table.rows)):
            at = table.numbers[min(table.ragged, len(table.rows) - 1)]
            raise Flaw(f"--columns: names {len(heads)} columns, line {at} has {len(table.rows[-1])} numbers or another")
        source.require_no_factor(table.header)
        for number, text in table.header:
            spelled = next((unit[unit.lastindex or 0] for unit in UNIT.finditer(text)), "")
            if quantity_of(spelled) in ("counts", "voltages"):
                raise Flaw(f"line {number} has {spelled}, which must be converted to {' or '.join(MOTIONS)} before")
        step, count = _step(source, table), _stated_count(table)
        if _is_series(source, table, heads, step, count):
            numbers = np.array([value for row in table.rows for value in row])
            if table.width > 1:
                source.chosen.append(f"{len(numbers)} numbers in lines of {table.width}, read as one series")
            channels = [_single(source, table, numbers, step)]
        else:
            channels = _columns(source, table, heads, step)
        for samples in {len(channel.values) for channel in channels}:
            if count is not None and samples != count[0]:
                raise Flaw(f"line {count[1]} states {count[0]} samples, there are {samples}; {_skip(count[1])}")
        if len(channels) > 1:
            compare_peaks(source, table, channels)
        return Record("columns of text", "", tuple(channels))


Stated = tuple[float, int] | None
"""A number that the header states and its line; line 0 is an option."""


def _is_series(source: Source, table: Table, heads: Sequence[Head], step: Stated, count: Stated) -> bool:
    """Whether the numbers are one series and no columns; raises Flaw where both are possible."""
    width, lines = table.width, len(table.rows)
    if source.given.series and width % 2 == 0 and increases(np.concatenate(table.rows)[::2]):
        raise Flaw("has pairs of time and value, which are no series; write one pair to a line")
    if source.given.series or source.given.columns:
        return source.given.series
    are_columns = any(heads) or increases(np.array([row[0] for row in table.rows]))
    cut = lines if are_columns or width == 1 else lines - 1
    if table.ragged < cut and (count is None or count[0] != table.total):
        at, has = table.numbers[table.ragged], len(table.rows[table.ragged])
        raise Flaw(f"line {at} has {has} numbers, others have {width}; if all are one series: --series")
    if width == 1 or (table.ragged == lines and are_columns):
        return width == 1
    if step is None:
        raise Flaw(f"has {width} numbers in a line, and neither times nor a time step: give --dt, and {EITHER[5:]}")
    if table.ragged < lines or (count is not None and count[0] == table.total):
        return True
    if (count is not None and count[0] == lines) or width < LONG:
        raise Flaw(f"has {width} numbers in a line without names: {EITHER}")
    require_order(table, series=True)
    return True


def _columns(source: Source, table: Table, heads: Sequence[Head], step: Stated) -> list[Channel]:
    """The channels of columns."""
    values, heads = np.array(table.rows).T, heads or [Head()] * table.width
    timed = [at for at, head in enumerate(heads) if head.is_time]
    may_be_time = not (heads[0].is_known or OTHER.search(heads[0].name) or source.given.columns)
    if not timed and may_be_time and (step is None or not heads[0].name) and increases(values[0]):
        timed = [0]
    if any((values[at] != values[timed[0]]).any() for at in timed[1:]):
        raise Flaw(f"columns {', '.join(str(at + 1) for at in timed)} have times; name one by --columns, others -")
    spectra = next((head.name for head in heads if re.match(r"freq|period", head.name, re.IGNORECASE)), None)
    if spectra is not None and not source.given.columns:
        raise Flaw(f'has a column "{spectra}", must have times; name the columns by --columns')
    chosen = [at for at in range(len(heads)) if at not in timed and heads[at].name != "-"]
    if not source.given.columns:
        require_motions(table, heads, values, timed, chosen)
    if timed:
        time = _times(source, table, heads[timed[0]], timed[0])
    else:
        if step is None:
            raise Flaw("has no column called time and states no time step; give --dt, or name the columns by --columns")
        if not source.given.columns:
            require_order(table, series=False)
    channels = []
    names = {at: heads[at].name or (f"column {at + 1}" if len(chosen) > 1 else "") for at in chosen}
    for at, name in names.items():
        is_other = len(chosen) > 1 and any(head.is_motion for head in table.heads) and not heads[at].is_motion
        if OTHER.search(name) or increases(values[at]) or (is_other and not source.given.columns):
            raise Flaw(f'column {at + 1}, "{name}", is no motion; name the columns by --columns, this one -')
    for at, name in names.items():
        if timed:
            even, numbers = source.evenly(time, values[at])
            between = float(f"{(even[-1] - even[0]) / (len(even) - 1):.12g}")
            _require_step(step, between, timed[0])
            begin = float(even[0])
        elif step is not None:
            between, numbers, begin = step[0], values[at], 0.0
        unit = heads[at].unit if len(chosen) > 1 or heads[at].unit else _unit_of_title(source, table)
        channels.append(_channel(source, table, Head(name, unit), numbers, between, begin, alone=len(chosen) == 1))
    if not channels:
        raise Flaw("has no column of values; name the columns by --columns")
    return channels


def _single(source: Source, table: Table, numbers: np.ndarray, step: Stated) -> Channel:
    """The channel of a series."""
    if step is None:
        raise Flaw('has one column and states no time step; give --dt, or a line "dt = 0.01 s" or "sampling: 100 Hz"')
    beside = next((head.unit for head in table.heads if table.width == 1 and head.unit), "")
    unit = beside or _unit_of_title(source, table)
    return _channel(source, table, Head("", unit), numbers, step[0], 0.0, alone=True)


def _channel(
    source: Source, table: Table, head: Head, numbers: np.ndarray, step: float, begin: float, *, alone: bool
) -> Channel:
    """A channel; the peak that the header states is that of one which is alone."""
    unit = source.measured(head.unit, head.name)
    stated = length = ""
    for _, text in table.header:
        if found := DURATION.search(text):
            length = found[1].replace(",", ".")
        for found in PEAK.finditer(text) if alone else ():
            named = unit_named(found[1] or found[3] or "") or (unit if " value" in found[0].lower() else None)
            if named is not None and named.quantity == unit.quantity:
                stated = f"{float(found[2].replace(',', '.')) * named.size / unit.size:.4g}"
    sizes = np.abs(numbers)
    if f"{sizes.max():g}" in MISSING and sizes.max() > FAR * sizes[sizes < sizes.max()].max(initial=0.0):
        raise Flaw(f"{head.name or 'a channel'} has {sizes.max():g}, far from all others: a sample is missing?")
    return source.channel(head.name, unit, numbers, step, begin, stated, length=length)


def _without_counter(source: Source, table: Table) -> Table:
    """A table without heads whose lines begin or end with their own number, as in decks of SHAKE, without it."""
    for at, which in ((0, "first"), (-1, "last")):
        counted = np.array([row[at] for row in table.rows])
        if (
            min(map(len, table.rows)) > 1
            and table.width > 2
            and not (any(table.heads) or source.given.columns)
            and counted[0] in (0.0, 1.0)
            and np.isin(steps := np.diff(counted), (1.0, 2.0)).all()
            and (steps == 1.0).mean() > MOST
        ):
            if (steps != 1.0).any():
                at = int(np.argmax(steps))
                raise Flaw(f"line {table.numbers[at]} has the number {counted[at]:g}, the next one {counted[at + 1]:g}")
            source.chosen.append(f"the {which} number of each line is that of the line, left out")
            return replace(table, rows=[row[1:] if at == 0 else row[:-1] for row in table.rows])
    return table


def _unit_of_title(source: Source, table: Table) -> str:
    """The unit of the only channel in the header, as it is spelled; empty without one, and for several.

    Raises Flaw where words beside it, or of all the header, name another quantity, unless the unit is given.
    """
    found = {}
    everywhere = quantities_named("\n".join(text for _, text in table.header))
    for number, text in table.header:
        for match in UNIT.finditer(text):
            spelled = match[match.lastindex or 0].strip(" .")
            is_peak = re.search(r"\b(peak|max(imum|\.)?) *$", text[: match.start()], re.IGNORECASE)
            if quantity_of(spelled) not in MOTIONS or is_peak:
                continue
            named = quantities_named(text) or (everywhere if len(everywhere) == 1 else set())
            if named - {quantity_of(spelled)} and source.given.unit is None:
                raise Flaw(f"line {number} has {' and '.join(sorted(named))} in {spelled}; give the unit by --unit")
            found[unit_named(spelled)] = spelled
    sizes = {unit[1:] for unit in found if unit is not None}
    return next(iter(found.values())) if len(sizes) == 1 else ""


def _step(source: Source, table: Table) -> Stated:
    """The time step that is given or stated, s; raises Flaw for several, one without a unit, and one of no size."""
    found: list[tuple[float, int]] = []
    for number, line in table.header:
        text = line.replace("_", " ")
        for match in STEP.finditer(text):
            found.append((seconds_of(match[2], match[1] or match[3] or "", number), number))
        for match in RATE.finditer(text):
            rate = float(next(filter(None, match.groups())).replace(",", "."))
            found.append((1.0 / rate if rate else 0.0, number))
    given = source.given.time_step
    if given is not None:
        found.insert(0, (given, 0))
    for step, number in found:
        if not SMALLEST <= step <= LARGEST:
            raise Flaw(f"has a time step of {step:g} s, must be positive")
        if abs(step - found[0][0]) > SAME * step:
            said = "--dt: is" if given is not None else f"line {found[0][1]} states"
            raise Flaw(f"{said} {found[0][0]:g} s, line {number} states {step:g} s; {_skip(number)}")
    return found[0] if found else None


def _stated_count(table: Table) -> tuple[int, int] | None:
    """The number of samples that the header states, and the line; None without one."""
    for number, text in table.header:
        if found := SAMPLES.search(text.replace("_", " ")):
            return int(found[1] or found[2]), number
    return None


def _skip(number: int) -> str:
    """How to leave out a line of the header."""
    return f"--skip {number} leaves that line and those above out"


def _times(source: Source, table: Table, head: Head, at: int) -> np.ndarray:
    """The times of a column, s; raises Flaw, with its line, for those that go back, and for steps without a unit."""
    unit = unit_named(head.unit)
    values = np.array([row[at] for row in table.rows])
    otherwise = f"if column {at + 1} has no times, name the columns by --columns and give --dt"
    try:
        require_increasing(values)
    except Flaw as flaw:
        steps = np.diff(values)
        line = f" in line {table.numbers[int(np.argmin(steps)) + 1]}" if (steps < 0.0).any() else ""
        raise Flaw(f"{flaw}{line}; {otherwise}") from None
    step = (values[-1] - values[0]) / (len(values) - 1)
    if step < SHORT and values[0] > OFFSET * step:
        said = f"has times of {values[0]:.10g}, {step:.3g} apart, days of a spreadsheet?"
        raise Flaw(f"{said} Write seconds; {otherwise}")
    if unit is None and (head.unit or re.search(r"/\s*[\d.]", head.name)):
        raise Flaw(f'has times in "{head.unit or head.name}", which is not known; {otherwise}')
    if unit is None and step > BARE:
        raise Flaw(f"has times {step:.4g} apart without a unit: write it in their head, as time (ms); {otherwise}")
    if unit is None and head.unit == "" and not head.name:
        source.chosen.append(f"column {at + 1}: times in s")
    return (1.0 if unit is None else unit.size) * values


def _require_step(step: Stated, between: float, at: int) -> None:
    """Raise Flaw if the header or an option states another time step (s) than that of a column of times."""
    if step is not None and abs(step[0] - between) > SAME * between:
        said = f"line {step[1]} states" if step[1] else "--dt: is"
        raise Flaw(f"{said} {step[0]:g} s, times in column {at + 1} are {between:g} s apart; name them by --columns")
