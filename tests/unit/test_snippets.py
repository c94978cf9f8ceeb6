"""Examples in the documents are valid: cases are accepted, commands exist with their options and arguments.

A TOML block is a whole case if it has a table ``[run]``, else a fragment. A translation has the code of its page.

Outputs that pages show, in English and in Chinese, are those that the commands print today. Compared are blocks
``console``, and blocks ``text`` right after one of ``sh``, of commands that need no run; ``…`` stands for anything, and
a page may leave lines out.
"""

import contextlib
import io
import re
import shlex
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.core import TyperGroup

from dembound.cli.app import app
from dembound.schemas import loads

PROGRAM = typer.main.get_command(app)
UsageError = typer.BadParameter.__base__  # wherever this version of typer has it

ROOT = Path(__file__).parents[2]
GALLERY = ROOT / "docs" / "gallery"
"""Its pages show shipped cases, which read files beside them."""

START, TASKS, CHINESE = (ROOT / "docs" / name for name in ("start", "tasks", "zh"))

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
BLOCK = re.compile(r"^```(?P<language>\w*)\n(?P<text>.*?)^```", re.DOTALL | re.MULTILINE)
ENDS = {"&&", "||", ";", "|", ">", ">>", "2>", "&"}
"""Words of a shell after which the arguments of a command are over."""


def blocks(page: Path, language: str) -> list[str]:
    """The blocks of a page in one language."""
    return [block["text"] for block in BLOCK.finditer(page.read_text()) if block["language"] == language]


def commands(text: str) -> Iterator[list[str]]:
    """The arguments of each `dembound` in the lines of a shell."""
    for line in text.replace("\\\n", " ").splitlines():
        words: list[str] = []
        for word in [*shlex.split(line, comments=True), ";"]:
            if word not in ENDS:
                words.append(word)
                continue
            if words and words[0] == "dembound":
                yield words[1:]
            words = []


def parse(command: Any, arguments: list[str], name: str = "dembound") -> None:
    """Parse arguments without running anything, and without what options of a group do, such as installing completion.

    Raises UsageError, or typer.Exit after the help of a command.
    """
    if isinstance(command, TyperGroup):
        context = command.context_class(command, info_name=name)
        _, rest, _ = command.make_parser(context).parse_args(list(arguments))
        if rest:
            chosen, found, left = command.resolve_command(context, rest)
            parse(found, left, f"{name} {chosen}")
    else:
        command.make_context(name, list(arguments))


def test_whole_cases_are_accepted() -> None:
    texts = [text for page in PAGES if GALLERY not in page.parents for text in blocks(page, "toml")]
    whole = [text for text in texts if "[run]" in text.splitlines()]
    assert len(whole) > 5
    for text in whole:
        loads(text)


@pytest.mark.parametrize(
    "page", [page for page in PAGES if blocks(page, "sh")], ids=lambda page: page.relative_to(ROOT).as_posix()
)
def test_commands_have_these_options_and_arguments(page, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    wrong = []
    for arguments in (each for text in blocks(page, "sh") for each in commands(text)):
        try:
            with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(typer.Exit):
                parse(PROGRAM, arguments)
        except UsageError as error:
            wrong.append(f"dembound {shlex.join(arguments)}: {error.format_message()}")
    assert not wrong


@pytest.mark.parametrize("page", sorted({*CHINESE.glob("*.md")} - {CHINESE / "index.md"}), ids=lambda page: page.stem)
def test_the_code_of_a_chinese_page_is_that_of_the_english_one_or_of_a_shipped_case(page: Path) -> None:
    originals = [START / page.name, TASKS / page.name, *(ROOT / "cases").glob("*.toml")]
    texts = [path.read_text() for path in originals if path.is_file()]
    codes = [*blocks(page, "toml"), *blocks(page, "python")]
    assert not [code for code in codes if not any(code in text for text in texts)]


CONSOLE = re.compile(r"^```console\n(?P<text>.*?)^```", re.DOTALL | re.MULTILINE)

QUICK = (["check"], ["paper", "lu2016", "--figure", "6"], ["paper", "zhou2018"])
"""The beginnings of commands that need no run."""

CASES = {"bar.toml": ["new", "bar.toml"], "first_tunnel.toml": ["cases", "copy", "first_tunnel"]}
"""Commands that write the cases of the pages."""


def shown() -> list[tuple[str, list[str], str]]:
    """Page, arguments of a quick command, and the output that the page shows."""
    found = []
    for page in [*PAGES, ROOT / "README.zh.md"]:
        text, name = page.read_text(), page.relative_to(ROOT).as_posix()
        pairs = []
        for one, other in pairwise(BLOCK.finditer(text)):
            if (one["language"], other["language"], text[one.end() : other.start()].strip()) == ("sh", "text", ""):
                pairs += [(arguments, other["text"]) for arguments in [*commands(one["text"])][-1:]]
        for block in CONSOLE.finditer(text):
            for part in re.split(r"^\$ dembound ", block["text"], flags=re.MULTILINE)[1:]:
                command, _, output = part.partition("\n")
                pairs.append((shlex.split(command, comments=True), output))
        found += [(name, *pair) for pair in pairs if any(pair[0][: len(quick)] == quick for quick in QUICK)]
    return found


SHOWN = shown()


def test_both_languages_show_outputs() -> None:
    assert {"README.md", "docs/tasks/papers.md", "docs/zh/papers.md", "docs/zh/first_wave.md"} <= {
        page for page, *_ in SHOWN
    }


@pytest.mark.parametrize(
    ("page", "arguments", "output"), SHOWN, ids=[" ".join([page, *words]) for page, words, _ in SHOWN]
)
def test_outputs_on_pages_are_those_of_today(page, arguments, output, dembound, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    for name, writes in CASES.items():
        if name in arguments:
            assert dembound(*writes).code == 0
    answer = dembound(*arguments)
    assert answer.code == 0
    printed = " ".join(answer.out.split())
    pieces = [" ".join(piece.split()) for line in output.splitlines() for piece in line.split("…")]
    assert not [piece for piece in pieces if piece not in printed]
