"""The lines of a text with columns of numbers: the header above, and the numbers with any separator between them."""

import csv
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from dembound.gauge.reading.scope import BROKEN_OFF, SIGNS, UNIT_IN_NAME, joined
from dembound.records.formats.numbers import MOTIONS, Flaw, Unknown, number_of, quantity_named
from dembound.records.formats.source import END, Source
from dembound.waves.unit_names import unit_named

MARKS = "#%!"
"""Signs that begin a comment."""

TOUCHING = re.compile(r"(?<=[.\d])(?=[+-]\d*\.)")
"""Where two numbers of Fortran touch: before the sign of the second one."""

CLOCK = re.compile(r"\d:\d\d|\d{4}-\d\d-\d\d")
"""A date or a time of day."""

VALUE = re.compile(r"[=:]\s*[-+.\d]")
"""A field of the header that states a value and heads no column."""

RULER = re.compile(r"[-=+*_|\s]+")
"""A line that only separates others."""

EITHER = "give --columns NAME,NAME,… for columns or --series for one series"

LONGEST = 40
"""Characters in the longest name of a column."""

LOWEST = 4
"""Lines of the header, from below, among which one may name the columns."""

TIME = re.compile(r"(?i:time|x_value|zeit|tiempo|temps|tempo|zaman|secs?|seconds?|时间)(?![A-Za-z])|t(?![A-Za-z0-9])")
COMPONENT = re.compile(
    r"ns|ew|ud|n-s|e-w|u-d|[xyzhvlrtneu]\d?|[hb][hnl][nez123]|(north|east|up|down|vert|long|trans|rad|comp|ch(?=an|\d))\w*"
    r"|[ns]?\d{1,3}[ew°]?",
    re.IGNORECASE,
)
"""Names of columns of times, and of components."""

OTHER = re.compile(
    r"\b(arias|husid|intensity|cav|energy|power|fourier|spectr\w*|p?s[ave]|sd|vs\d*|depth|response|phase|freq\w*|period"
    r"|wind|shear wave|distance|trig\w*)(?![a-z])|谱",
    re.IGNORECASE,
)
"""Names of columns that are no motion, whatever their unit."""


@dataclass(frozen=True)
class Head:
    """The head of a column: its name, and the unit beside it as it is spelled; empty where there is none."""

    name: str = ""
    unit: str = ""

    @property
    def is_time(self) -> bool:
        """Whether it is that of times."""
        return TIME.match(self.name) is not None or quantity_of(self.unit) == "times"

    @property
    def is_known(self) -> bool:
        """Whether it names times, a component or a quantity, or has a unit of them."""
        return self.is_time or self.is_motion or COMPONENT.fullmatch(self.name) is not None

    @property
    def is_motion(self) -> bool:
        """Whether it names a quantity of motions, has the unit of one, or names a component without any unit."""
        is_component = not self.unit and COMPONENT.fullmatch(self.name) is not None
        return is_component or quantity_of(self.unit) in MOTIONS or quantity_named(self.name) is not None


@dataclass(frozen=True)
class Table:
    """A text of numbers.

    header : numbers and texts of the lines above the numbers, without signs of comments. heads : of the columns, none
    without a line that names them. rows : the numbers of each line. numbers : of these lines in the file.
    """

    header: Sequence[tuple[int, str]]
    heads: Sequence[Head]
    rows: Sequence[Sequence[float]]
    numbers: Sequence[int]

    @cached_property
    def width(self) -> int:
        """Numbers in most lines."""
        return Counter(map(len, self.rows)).most_common(1)[0][0]

    @property
    def total(self) -> int:
        """All numbers."""
        return sum(map(len, self.rows))

    @cached_property
    def ragged(self) -> int:
        """Index of the first line with another number of numbers than most; that of no line without any."""
        return next((at for at, row in enumerate(self.rows) if len(row) != self.width), len(self.rows))


def read_table(source: Source) -> Table:
    """The header and the numbers of a text.

    Numbers are separated by tabs, semicolons, commas or blanks, and may have decimal commas but between commas. Raises
    Flaw for a text without numbers at its end, for other text between them, and for lines of the header that may be
    numbers of the series.
    """
    lines = [
        (number, text.translate(SIGNS).strip(" \r\f\v"))
        for number, text in enumerate(source.lines[source.given.skip :], start=source.given.skip + 1)
        if text.strip("\t ;,") and not END.match(text)
    ]
    separator = _separator([text for _, text in lines])
    if separator == "\t" and lines[-1][1].startswith("\t"):  # LabVIEW's column of times is empty
        lines = [(number, text.removeprefix("X_Value").removeprefix("\t")) for number, text in lines]
    found = [(number, text, _numbers(text, separator)) for number, text in lines if text]
    first = len(found)
    while first > 0 and found[first - 1][2]:
        first -= 1
    if first == len(found):
        if any(numbers for _, _, numbers in found):
            raise Flaw(f"line {found[-1][0]} is no line of numbers, there must be none behind them")
        last = next(((number, text) for number, text in reversed(lines) if re.search(r"\d", text)), None)
        said = "" if last is None else f', but line {last[0]}: "{last[1][:30]}"'
        if last is not None and CLOCK.search(last[1]):
            said += "; write seconds in place of dates and times of day"
        raise Unknown(f"has no lines of numbers alone{said}")
    rows, beside = [numbers for _, _, numbers in found[first:]], []
    while separator != " " and first > 0 and (parts := _with_text(found[first - 1][1], separator, len(rows[0]))):
        first -= 1
        rows.insert(0, parts[0])
        beside.append((found[first][0], parts[1]))
    above = [len(numbers) for _, _, numbers in found[:first] if numbers]
    if above.count(len(rows[0])) >= (BROKEN_OFF if len(rows[0]) == 1 else 1):
        number, text, _ = found[first - 1]
        advice = f"; --skip {number} leaves out all above" if len(above) < len(rows) / LOWEST else f': "{text[:30]}"'
        raise Flaw(f"line {number} is no line of numbers like those around it{advice}")
    if separator == "," and all(value.is_integer() for row in rows for value in row) and len(rows[0]) > 1:
        advice = "if these are decimal commas, write points, or semicolons between columns"
        raise Flaw(f"has whole numbers between commas; {advice}")
    if not source.given.series:
        _require_no_header(rows, [text for _, text, _ in found[first:]], found[first][0])
    for number, text, numbers in found[:first]:
        if not numbers and _numbers(separator.join(filter(None, _fields(text, separator))) or MARKS, separator):
            raise Flaw(f"line {number} has empty fields beside numbers; --skip {number} leaves it out")
    for number, text, _ in found[max(0, first - 1) : first] if separator != " " and len(rows[0]) > 1 else ():
        if all(number_of(field.replace(",", ".")) is not None for field in _fields(text, separator)[: len(rows[0])]):
            raise Flaw(f"line {number} has text behind its numbers; remove the text")
    header = [(number, text.lstrip(MARKS + " ")) for number, text, _ in found[:first] if not RULER.fullmatch(text)]
    header = beside + header  # above the names of columns
    table = Table(header, (), rows, [number for number, _, _ in found[first:]])
    if source.given.columns or source.given.series:
        return table
    return Table(header, _heads([text for _, text in header], separator, table.width), rows, table.numbers)


def _separator(texts: Sequence[str]) -> str:
    """The separator of the numbers, a blank standing for any number of them: seen in the last line with a digit."""
    last = next((text for text in reversed(texts) if any(map(str.isdigit, text))), "")
    for separator in ("\t", ";"):
        if separator in last:
            in_pairs = all(number_of(field.replace(",", ".")) is not None for field in last.split("\t\t"))
            return " " if in_pairs and "\t\t" in last else separator
    fields = _fields(last, ",")
    if len(fields) == 2 and "." not in last and any(re.search(r"=\s*\d+,\d|;", text) for text in texts):
        return " "  # a single column with decimal commas, as the header has
    return "," if len(fields) > 1 and all(number_of(text.replace(",", ".")) is not None for text in fields) else " "


def _fields(text: str, separator: str) -> list[str]:
    """The fields of a line, without empty ones at its end."""
    if separator == " ":
        return text.split()
    fields = [field.strip() for field in next(csv.reader([text], delimiter=separator, skipinitialspace=True), [])]
    while fields and not fields[-1]:
        fields.pop()
    return fields


def _numbers(text: str, separator: str) -> list[float]:
    """The numbers of a line; none for a line with other fields, and for a comment."""
    fields = [] if text[0] in MARKS else _fields(text.partition("#")[0], separator)
    fields = [field.replace(",", ".") for field in fields]  # between commas only those in quotes have any
    if separator == " ":  # fields of Fortran may touch
        fields = [part for field in fields for part in (TOUCHING.split(field) if field.count(".") > 1 else [field])]
    numbers = [number for field in fields if (number := number_of(field)) is not None]
    return numbers if len(numbers) == len(fields) else []


def _with_text(text: str, separator: str, width: int) -> tuple[list[float], str] | None:
    """The numbers of a line, as many as in others, and the text behind an empty field beside them; None for others."""
    fields = _fields(text, separator)
    numbers = [number_of(field.replace(",", ".")) for field in fields[:width]]
    if len(fields) <= width or fields[width] or any(number is None for number in numbers):
        return None
    return [number for number in numbers if number is not None], " ".join(filter(None, fields[width:]))


def _require_no_header(rows: Sequence[Sequence[float]], texts: Sequence[str], number: int) -> None:
    """Raise Flaw if the first lines seem to state the number of samples or the time step, or to name columns.

    These have the number of all others, or fewer numbers than other lines, or other digits behind the point than all.
    """
    widths, total = [len(row) for row in rows], sum(map(len, rows))
    are_pairs = len(rows) > 3 and set(widths) == {2}
    if are_pairs and rows[0][0] > rows[1][0] and increases(np.array([row[0] for row in rows[1:]])):
        raise Flaw(f"line {number} precedes times and is none: --skip {number} leaves it out")
    for lines in (1, 2):
        top = [value for row in rows[:lines] for value in row]
        stands_out = len(rows) > lines and widths[0] < widths[lines] and len(set(widths[:lines])) == 1
        if total - len(top) in top or stands_out:
            said = f"--skip {number + lines - 1} leaves it out, --dt gives the time step"
            raise Flaw(f"line {number} may state the number of samples: {said}")
    # digits behind the point of each number in a line
    first, *others = [[len(digits) for digits in re.findall(r"\d+[.,]?(\d*)", text)] for text in texts]
    if len(others) > 2 and first != others[0] and all(each == others[0] for each in others) and any(rows[0]):
        said = f"--skip {number} leaves it out, --series takes all as one series"
        raise Flaw(f"line {number} has other digits than all lines below: {said}")


def increases(values: np.ndarray) -> bool:
    """Whether numbers (n,) increase evenly, as times and numbers of samples do."""
    steps = np.diff(values)
    return len(values) > 2 and bool((steps >= 0.0).all() and steps.mean() > 0.0 and np.ptp(steps) <= 0.5 * steps.mean())


def _heads(header: Sequence[str], separator: str, width: int) -> list[Head]:
    """The heads of the columns: names with units of one line, and units of another line below it."""
    units: list[Head] = []
    for text in reversed(header[-LOWEST:]):
        fields = _fields(text, separator)
        if separator == " " and width > 1:
            fields = joined(fields, width)
        if len(fields) == width + 1 and fields[-1] == "Comment":  # of LabVIEW, without numbers
            fields.pop()
        if any(VALUE.search(field) for field in fields):
            continue
        heads = [head_of(field) for field in fields]
        if any(len(head.name) > LONGEST for head in heads):  # a sentence with commas
            continue
        if len(fields) != width:
            if separator != " " and len(fields) > 1 < width and 2 * sum(head.is_known for head in heads) > len(fields):
                raise Flaw(f'"{text}" names {len(fields)} columns, lines have {width} numbers: {EITHER}')
            continue
        if not units and any(head.unit for head in heads) and not any(head.name.strip("-1[]") for head in heads):
            units = heads
        elif (separator != " " and width > 1) or 2 * sum(head.is_known for head in heads) > width:
            return [Head(one.name, one.unit or two.unit) for one, two in zip(heads, units or heads, strict=True)]
    return units


def head_of(text: str) -> Head:
    """The name and the unit in the head of a column: "acc (gal)", "acc [gal]", "a/gal", "acc_gal", "acc in gal"."""
    parts = [Head(name.strip(" /,"), unit.strip()) for name, unit in _partitions(text)]
    parts = [head for head in parts if quantity_of(head.unit) in (*MOTIONS, "times")]
    if COMPONENT.fullmatch(text):
        return Head(text)
    if known := next((head for head in parts if head.name and (Head(head.name).is_known or text[-1] in "])")), None):
        return known  # before "NS g" is taken as a unit
    if quantity_of(whole := text.strip("[]()")) in (*MOTIONS, "times", "strains"):
        return Head("", whole)
    bracketed = UNIT_IN_NAME.match(text)
    if not parts and bracketed and bracketed[1] and not COMPONENT.fullmatch(bracketed[2].strip()):
        return Head(bracketed[1].strip(), bracketed[2].strip())  # a unit that is not known
    return parts[0] if parts else Head(text)


def _partitions(text: str) -> Iterator[tuple[str, str]]:
    """A text in two parts that may be a name and a unit."""
    if bracketed := UNIT_IN_NAME.match(text):
        yield bracketed[1], bracketed[2]
        return
    name, slash, unit = text.partition("/")
    if slash:
        yield name, unit
    for gap in re.finditer(r"(?:\s+in)?[\s_]+", text):
        yield text[: gap.start()], text[gap.end() :].replace("_", "/")


def quantity_of(unit: str) -> str:
    """The quantity that a unit measures; empty for other texts."""
    found = unit_named(unit) if unit else None
    return "" if found is None else found.quantity
