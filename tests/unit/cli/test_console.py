"""Texts are printed unchanged: without markup and commands to the terminal; compiling is reported once."""

import io
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from rich.table import Table

from dembound.cli.compiling import MESSAGE
from dembound.cli.console import PlainConsole, compact_table, prepare_streams
from dembound.errors import HIDDEN, visible


def printed(content: object) -> str:
    console = PlainConsole(file=io.StringIO(), width=100)
    console.print(content)
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue().strip()


def test_texts_cells_and_titles_appear_as_they_are() -> None:
    for text, shown in (
        ("[/bold] [red]x[/red]", "[/bold] [red]x[/red]"),
        (":smile:", ":smile:"),
        ("a\x1b[2Jb\x00c\nd\x9b", r"a\x1b[2Jb\x00c\nd\x9b"),
        ("x\udcff\u2028", r"x\udcff\u2028"),
        ("β = 0.8, 中文", "β = 0.8, 中文"),
    ):
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


def ended(code: str, **options: Any) -> subprocess.CompletedProcess[str]:
    """Run a command line, given by its arguments, in a process of its own."""
    return subprocess.run([sys.executable, "-c", code], text=True, check=False, stderr=subprocess.PIPE, **options)


def command(*arguments: str) -> str:
    return f"import sys; sys.argv = ['dembound', *{list(arguments)!r}]; from dembound.__main__ import main; main()"


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no full device")
def test_what_nobody_reads_any_more_is_dropped_and_a_full_disk_one_line() -> None:
    reading, writing = os.pipe()
    os.close(reading)
    done = ended(command("cases"), stdout=writing)
    assert (done.returncode, done.stderr) == (0, "")
    os.close(writing)
    with open("/dev/full", "w") as full:
        done = ended(command("cases"), stdout=full)
    assert (done.returncode, done.stderr) == (5, "output: No space left on device\n")


def test_text_that_reorders_itself_does_not_reach_the_terminal() -> None:
    done = ended(command("check", "--no\u202esuch", "x\u2066.toml"), stdout=subprocess.DEVNULL, encoding="utf-8")
    assert done.returncode == 2
    assert "\\u202e" in done.stderr
    assert not HIDDEN.search(done.stderr)
    assert visible("a\u202eb\u200bc") == "a\\u202eb\\u200bc"


COMPUTE = """
import numpy as np
from dembound.cli.app import prepare_computing
prepare_computing(None)
prepare_computing(None)
from dembound.kernels.common import column_sum, largest
column_sum(np.ones((2, 2)), 0)
largest(np.ones(2))
"""


@pytest.mark.slow
def test_only_the_first_kernel_compiled_is_reported(tmp_path) -> None:
    def printed() -> str:
        kept = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
        return subprocess.run(
            [sys.executable, "-c", COMPUTE], capture_output=True, text=True, check=True, env=kept
        ).stderr

    assert printed() == f"{MESSAGE}\n"
    assert printed() == ""  # loaded


@pytest.mark.parametrize(("is_terminal", "rows"), [(False, 1), (True, 3)])
def test_rows_of_tables_have_a_line_each_where_there_is_no_terminal(is_terminal, rows, monkeypatch) -> None:
    monkeypatch.delenv("COLUMNS", raising=False)
    file = io.StringIO()
    console = PlainConsole(file=file, force_terminal=is_terminal, color_system=None)
    table = compact_table(show_header=False)
    table.add_row("sides", "word " * 40)
    console.print(table)
    lines = [line for line in file.getvalue().splitlines() if line.strip()]
    assert len(lines) == rows
    assert is_terminal or lines[0].endswith(" word")
