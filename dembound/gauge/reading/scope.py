"""Columns of numbers in text files of oscilloscopes and spreadsheets, with any separators and headers.

A file may begin with lines about the instrument, a line of names and a line of units. These stand above the columns or,
as Tektronix writes them, in columns to the left of the numbers.
"""

import csv
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from dembound.errors import CaseError
from dembound.gauge.reading.units import time_unit, value_unit

SIGNS = str.maketrans({"−": "-", "∞": "inf", "：": ":"})
"""Characters in numbers that float() does not read, and the colon of Chinese text."""

CHINESE = re.compile(rb"(?:[\xa1-\xfe]{2}){2}")
"""Two characters of Chinese text in GB18030 or GBK; Latin-1 has no four letters with accents in a row."""

UNIT_IN_NAME = re.compile(r"^(.*?)\s*[(\[]\s*([^()\[\]]+?)\s*[)\]]\s*$")
"""A name with its unit in brackets, or only a unit in brackets."""

UNIT = r"[(\[][^()\[\]]+[)\]]"
WORD_WITH_UNIT = re.compile(rf"[^\s()\[\]]+(?: ?{UNIT})?")
WORDS_WITH_UNIT = re.compile(rf"[^()\[\]]*[^\s()\[\]] ?{UNIT}")
"""Names between blanks: of one word, with a unit in brackets or without, and of several words, all with units."""

BROKEN_OFF = 3
"""Number of lines of numbers above other text from which on the text is an interruption and not a header."""


@dataclass(frozen=True)
class Columns:
    """The lines of numbers of a file.

    path : the file; header : lines of fields above the first of them, or left of them; lines : the fields of each line
    of numbers; numbers : of these lines in the file; places : positions of the columns in a line; decimal : the sign
    between whole and part.
    """

    path: Path
    header: list[list[str]]
    lines: list[list[str]]
    numbers: list[int]
    places: list[int]
    decimal: str

    @property
    def names(self) -> list[str]:
        """Names of the columns, without units; empty where there is none."""
        for fields in reversed(self.header):
            found = [_name(fields[place]) if place < len(fields) else "" for place in self.places]
            if not all(map(_is_unit, found)):
                return found
        return [""] * len(self.places)

    def units(self, column: int) -> Iterator[str]:
        """Texts that may be the unit of a column, the most likely first."""
        place = self.places[column]
        for fields in reversed(self.header):
            if place < len(fields):
                bracketed = UNIT_IN_NAME.match(fields[place])
                yield bracketed[2] if bracketed else behind_slash(fields[place]) or fields[place]
        axis = ("x", "horizontal") if column == 0 else ("y", "vertical")
        for fields in self.header:
            words = fields[0].lower().replace(" ", "").rstrip(":")
            if len(fields) > 1 and words in {f"{name}{unit}" for name in axis for unit in ("unit", "units")}:
                yield fields[1]

    def bracketed(self, column: int) -> str | None:
        """The text in brackets in the name of a column, or below it, the last one; None without any."""
        for fields in reversed(self.header):
            if self.places[column] < len(fields) and (found := UNIT_IN_NAME.match(fields[self.places[column]])):
                return found[2]
        return None

    def find(self, option: str, requested: str) -> int:
        """The index of a column by its number, from 1, or name; raises CaseError if there is none or two."""
        names = self.names
        if requested.isdigit() and requested not in names:
            if not 1 <= int(requested) <= len(names):
                raise CaseError([f"{option}: is {requested}, must be 1 to {len(names)} in {self.path}"])
            return int(requested) - 1
        found = [index for index, name in enumerate(names) if name.lower() == requested.strip().lower()]
        if len(found) != 1:
            allowed = ", ".join(filter(None, names)) or "a number, as the columns have no names"
            said = "is the name of several columns, give its number" if found else f"must be {allowed}"
            raise CaseError([f"{option}: is {requested}, {said}"])
        return found[0]

    def values(self, column: int) -> list[float]:
        """The numbers of a column; raises CaseError where a line has none there."""
        place, found = self.places[column], []
        for number, fields in zip(self.numbers, self.lines, strict=True):
            value = _number(fields[place], self.decimal) if place < len(fields) else None
            if value is None:
                raise CaseError([f"{self.path}: line {number} has no number in column {column + 1}"])
            found.append(value)
        return found


def behind_slash(field: str) -> str | None:
    """The unit in a header such as "Time/us" or "ε/%", a quantity over its unit; None for one that is a unit itself."""
    name, _, unit = (part.strip() for part in field.partition("/"))
    last = name.rpartition(" ")[2]
    if _is_unit(field) or (_is_unit(last) and last.lower() not in ("strain", "ε")):
        return None  # such as m/s, or bridge mV/V
    return unit if _is_unit(unit) else None


def read_columns(path: Path) -> Columns:
    """Find the columns of numbers of a text file.

    They are separated by tabs, semicolons, commas or blanks, and numbers may have decimal commas; fields may be in
    quotes. A ``#`` begins a comment.

    Raises CaseError for a file without lines of two numbers and more, and for other text between or behind them.
    """
    text = decoded(content_of(path))
    if "\0" in text:
        raise CaseError([f'"{path}" is not a text of columns of numbers: it has bytes that no text has'])
    separator = _separator(text)
    rows = [(number, fields) for number, fields in enumerate(_fields(text, separator), start=1) if any(fields)]
    return _numbers(path, rows, separator)


def content_of(path: Path) -> bytes:
    """All bytes of a file; raises CaseError for a path that is no file or cannot be read."""
    if not path.is_file():
        raise CaseError([f'"{path}" is not a regular file' if path.exists() else f'no file "{path}"'])
    try:
        return path.read_bytes()
    except OSError as error:
        raise CaseError([f'"{path}" cannot be read: {error.strerror}']) from None


def decoded(content: bytes) -> str:
    """The text of a file in any usual encoding."""
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return content.decode("utf-16", errors="replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        if CHINESE.search(content):
            return content.decode("gb18030", errors="replace")
        return content.decode("latin-1")  # where µ is the only usual character beyond ASCII


def _separator(text: str) -> str:
    """The separator of the columns, a blank standing for any number of them: seen in the last line with a number."""
    plain = [line for line in (line.partition("#")[0].strip(" \r") for line in text.splitlines()) if line]
    last = next((line for line in reversed(plain) if any(map(str.isdigit, line))), "")
    for separator in ("\t", ";"):
        if separator in last.strip():
            return separator
    fields = next(csv.reader([last]), [])
    numeric = all(not field.strip() or _number(field, ".") is not None for field in fields)
    quoted = '"' in last and len(fields) > 1
    return "," if len(fields) > 1 and (numeric or quoted) else " "


def _fields(text: str, separator: str) -> Iterator[list[str]]:
    """The fields of every line; comments are names of columns, unless they begin with a number."""
    for line in text.splitlines():
        plain = line.lstrip("# ") if line.startswith("#") else line.partition("#")[0]
        if separator == " ":
            fields = plain.split()
        elif '"' in plain:
            fields = [field.strip() for field in next(csv.reader([plain], delimiter=separator))]
        else:
            fields = [field.strip() for field in plain.split(separator)]
        numeric = bool(fields) and _number(fields[0], ",") is not None
        yield [] if numeric and line.startswith("#") else fields


def _numbers(path: Path, rows: Sequence[tuple[int, list[str]]], separator: str) -> Columns:
    """The lines of numbers, with their line numbers: lines that are like the last one."""
    last = next((index for index in reversed(range(len(rows))) if _places(rows[index][1])), None)
    if last is None:
        raise CaseError([f'"{path}" contains no lines of two or more numbers'])
    if last < len(rows) - 1:
        raise CaseError([f'"{path}": line {rows[last + 1][0]} is no line of numbers, there must be none behind them'])
    places, fields = _places(rows[last][1]), rows[last][1]
    decimal = "," if separator != "," or any("," in fields[place] for place in places) else "."
    first = last
    while first > 0 and _is_like(rows[first - 1][1], places, decimal):
        first -= 1
    if sum(_is_like(fields, places, decimal) for _, fields in rows[:first]) >= BROKEN_OFF:
        raise CaseError([f'"{path}": line {rows[first - 1][0]} is no line of numbers like those around it'])
    left = [fields[: places[0]] for _, fields in rows[first:] if any(fields[: places[0]])]
    above = [joined(fields, len(rows[last][1])) if separator == " " else fields for _, fields in rows[:first]]
    numbers, lines = map(list, zip(*rows[first:], strict=True))
    return Columns(path, left or above, lines, numbers, places, decimal)


def joined(fields: list[str], count: int) -> list[str]:
    """Words between blanks joined to a number of column names that end with units in brackets; else unchanged."""
    line = " ".join(fields)
    for names in (WORD_WITH_UNIT, WORDS_WITH_UNIT):
        if len(found := names.findall(line)) == count:
            return found
    return fields


def _places(fields: Sequence[str]) -> list[int]:
    """Positions of the numbers in a line; none for fewer than two."""
    found = [place for place, field in enumerate(fields) if field]
    numeric = [place for place in found if _number(fields[place], ",") is not None]
    return numeric if len(numeric) > 1 else []


def _is_like(fields: Sequence[str], places: Sequence[int], decimal: str) -> bool:
    """Whether a line has a number in the first of these positions, where lines of numbers have their time."""
    return len(fields) > places[0] and _number(fields[places[0]], decimal) is not None


def _number(text: str, decimal: str) -> float | None:
    """The number in a text with a decimal sign; None if it is not a number."""
    try:
        return float(text.translate(SIGNS).replace(",", ".") if decimal == "," else text.translate(SIGNS))
    except ValueError:
        return None


def _name(text: str) -> str:
    """The name of a column, without its unit; empty for only a unit in brackets."""
    if bracketed := UNIT_IN_NAME.match(text):
        return bracketed[1]
    return text.partition("/")[0].strip() if behind_slash(text) else text


def _is_unit(text: str) -> bool:
    """Whether a text is a unit, or empty."""
    return not text or time_unit(text) is not None or value_unit(text) is not None
