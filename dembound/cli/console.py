"""Consoles of commands: texts appear unchanged, without markup, and control characters as escapes."""

from __future__ import annotations

import io
import os
import sys
import textwrap
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import typer
from rich import box
from rich.console import Console, ConsoleDimensions
from rich.table import Column, Table
from rich.text import Text

from dembound.errors import HIDDEN, escaped, visible
from dembound.interrupts import exit_code_of
from dembound.words import columns

INTERVAL = 10.0
"""Seconds between two lines of progress where there is no terminal."""


NARROWEST = 24
"""Characters in a line of names that are broken between words, at least."""


WIDEST = 100_000
"""Characters in a line where there is no terminal and no COLUMNS says how many: rows of tables have a line each."""


class PlainConsole(Console):
    """Prints texts of users: nothing in them is markup, an emoji code or a command to the terminal."""

    def __init__(self, **options: Any) -> None:
        super().__init__(markup=False, emoji=False, highlight=False, soft_wrap=True, **options)

    @property
    def size(self) -> ConsoleDimensions:
        """Characters in a line, and lines."""
        if self.is_terminal or self._width is not None or "COLUMNS" in os.environ:
            return super().size
        return ConsoleDimensions(WIDEST, 25)

    @size.setter
    def size(self, new: tuple[int, int]) -> None:
        self._width, self._height = new

    def print(self, *objects: Any, **options: Any) -> None:
        """Print; texts are broken between words on a terminal, and elsewhere have one line each, for scripts.

        So have rows of tables there, without blanks at their ends.
        """
        if self.is_terminal and all(isinstance(each, str) for each in objects):
            options.setdefault("soft_wrap", False)
        if self.is_terminal or not any(isinstance(each, Table) for each in objects):
            super().print(*objects, **options)
            return
        with self.capture() as padded:
            super().print(*objects, **options)
        for line in padded.get().splitlines():
            super().print(line.rstrip(), soft_wrap=True)

    def render_str(self, text: str, **options: Any) -> Text:
        """The text of anything printed, also of cells and titles, in one line."""
        return super().render_str(visible(text), **options)


out = PlainConsole()
err = PlainConsole(stderr=True)


def print_written(*paths: Path) -> None:
    """Print each file that was written."""
    for path in paths:
        out.print(f"wrote {path}")


def seldom() -> Callable[[], bool]:
    """Answers, whenever it is asked, whether `INTERVAL` seconds are over since its last yes, or since it was made."""
    said = time.monotonic()

    def is_due() -> bool:
        nonlocal said
        if (now := time.monotonic()) - said < INTERVAL:
            return False
        said = now
        return True

    return is_due


def print_lines(*lines: str) -> None:
    """Print lines that are not broken, also on a terminal."""
    for line in lines:
        out.print(line, soft_wrap=True)


@contextmanager
def ending_with(words: str | Callable[[], str]) -> Iterator[None]:
    """Inside, a signal ends the command with its exit code, and with one line of these words, or of those then made."""
    try:
        yield
    except KeyboardInterrupt as stop:
        err.print(words if isinstance(words, str) else words())
        raise typer.Exit(exit_code_of(stop)) from None


def compact_table(*columns: Column | str, **looks: Any) -> Table:
    """A table without frame and with narrow gaps between its columns, so that it fits into 80 characters."""
    return Table(*columns, box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, title_justify="left", **looks)


def print_rows(title: str, rows: Sequence[Sequence[str]], left: int = 1) -> None:
    """Print a title and rows, the first of which is the head, in aligned columns; the first `left` are names.

    Names are never cut, so lines may be wider than a terminal. There the cells of the first column are broken, but only
    between words; elsewhere every row is one line, for scripts.
    """
    lines = columns(rows, left)
    if out.is_terminal and (excess := max(map(len, lines)) - out.width) > 0:
        lines = columns(
            [line for row in rows for line in _broken(row, max(len(row[0]) for row in rows) - excess)], left
        )
    print_lines(title, "", *lines)


def _broken(row: Sequence[str], width: int) -> list[Sequence[str]]:
    """The rows of which a row consists after its first cell is broken between words to be at most so wide."""
    first, *more = textwrap.wrap(row[0], max(width, NARROWEST), break_long_words=False, break_on_hyphens=False) or [""]
    return [[first, *row[1:]], *([f"  {part}", *[""] * (len(row) - 1)] for part in more)]


class _UntilClosed(io.FileIO):
    """An output that drops all text after its reader has ended, as ``head`` does, or after the first error."""

    is_over = False

    def write(self, data: Any) -> int:
        """The number of bytes written or dropped. Raises OSError, once, for an error other than the reader's end."""
        if not self.is_over:
            try:
                return super().write(data)
            except BrokenPipeError:
                self.is_over = True
            except OSError:
                self.is_over = True
                raise
        return memoryview(data).nbytes


class _Readable(io.TextIOWrapper):
    """An output without characters that hide or reorder text."""

    def write(self, text: str) -> int:
        """The number of characters."""
        return super().write(HIDDEN.sub(escaped, text))


def flush() -> None:
    """Print buffered text; raises OSError where this is not possible."""
    if sys.stdout is not None:  # as it is where it has been closed
        sys.stdout.flush()


def prepare_streams() -> None:
    """Print characters that the terminal's encoding does not have as escapes, and go on without a reader."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if not isinstance(stream, io.TextIOWrapper):
            continue
        stream.reconfigure(errors="backslashreplace")
        if type(getattr(stream.buffer, "raw", stream.buffer)) is io.FileIO:  # itself with Python's option -u
            file = io.BufferedWriter(_UntilClosed(stream.fileno(), "w", closefd=False))
            in_lines = stream.line_buffering or stream.write_through
            setattr(sys, name, _Readable(file, stream.encoding, stream.errors, line_buffering=in_lines))
