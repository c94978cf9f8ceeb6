"""Tables as CSV files, which spreadsheets open, too."""

import csv
import io
import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from dembound.files import replacing

FORMULAS = ("=", "+", "-", "@", "\t", "\r")
"""Beginnings of texts that spreadsheets take for formulas, which might do anything."""

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+|inf|nan)(e[+-]?\d+)?$", re.IGNORECASE)


def write_csv(path: Path, rows: Iterable[Sequence[Any]]) -> None:
    """Write rows, completely or not at all; missing values (None, nan) are empty.

    A text that a spreadsheet would take for a formula begins with an apostrophe. Raises the errors of
    `dembound.files.created`.
    """
    with replacing(path) as file, io.TextIOWrapper(file, encoding="utf-8", newline="") as text:
        csv.writer(text).writerows([_cell(each) for each in row] for row in rows)


def _cell(value: Any) -> Any:
    """A value as a cell."""
    if value is None or value != value:
        return ""
    return f"'{value}" if isinstance(value, str) and value.startswith(FORMULAS) and not NUMBER.match(value) else value
