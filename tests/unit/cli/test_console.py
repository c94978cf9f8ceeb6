"""What is printed is what is there: no markup, no emoji codes, no commands to the terminal."""

import io
import sys

import pytest
from rich.table import Table

from dembound.cli.console import PlainConsole, prepare_streams


def printed(content: object) -> str:
    console = PlainConsole(file=io.StringIO(), width=100)
    console.print(content)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue().strip()


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("[/bold] [red]x[/red]", "[/bold] [red]x[/red]"),
        (":smile:", ":smile:"),
        ("a\x1b[2Jb\x00c\nd\x9b", r"a\x1b[2Jb\x00c\nd\x9b"),
        ("x\udcff\u2028", r"x\udcff\u2028"),
        ("β = 0.8, 中文", "β = 0.8, 中文"),
    ],
)
def test_texts_cells_and_titles_appear_as_they_are(text: str, shown: str) -> None:
    table = Table("head", title=text)
    table.add_row(text)

    assert printed(text) == shown
    assert printed(table).count(shown) == 2


def test_what_an_encoding_lacks_is_escaped(monkeypatch) -> None:
    stream = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", stream)
    prepare_streams()
    print("β", file=stream, flush=True)

    assert stream.buffer.getvalue() == b"\\u03b2\n"  # type: ignore[attr-defined]
