"""Where commands print: texts appear as they are, without markup, and with their control characters as escapes."""

from __future__ import annotations

import io
import sys
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Column, Table
from rich.text import Text

from dembound.errors import visible

INTERVAL = 10.0
"""Seconds between two lines of progress where there is no terminal."""


class PlainConsole(Console):
    """Prints texts of users: nothing in them is markup, an emoji code or a command to the terminal."""

    def __init__(self, **options: Any) -> None:
        super().__init__(markup=False, emoji=False, highlight=False, soft_wrap=True, **options)

    def render_str(self, text: str, **options: Any) -> Text:
        """The text of anything printed, also of cells and titles, in one line."""
        return super().render_str(visible(text), **options)


out = PlainConsole()
err = PlainConsole(stderr=True)


def compact_table(*columns: Column | str, **looks: Any) -> Table:
    """A table without frame and with narrow gaps between its columns, so that it fits into 80 characters."""
    return Table(*columns, box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False, title_justify="left", **looks)


def escape_unprintable() -> None:
    """Print characters that the terminal's encoding does not have as escapes, too."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
