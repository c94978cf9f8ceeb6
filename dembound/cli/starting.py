"""Commands that write starting points: new, cases, schema."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer
from typer import Argument, Option

from dembound import shipped
from dembound.cli.app import MORE, app, writable
from dembound.cli.console import out, print_written
from dembound.errors import CaseError
from dembound.files import write_text
from dembound.starting import DEFAULT, ENDING, names, starting_point, titles

SCHEMA_FILE = "dembound.schema.json"
"""File name of the schema that is written next to new cases."""

cases = typer.Typer(invoke_without_command=True)
app.add_typer(cases, name="cases", rich_help_panel=MORE)


@app.command("new")
def new(
    path: Annotated[Path, Argument(metavar="FILE", help="File to write.")] = Path("case.toml"),
    start: Annotated[
        str | None,
        Option(
            "--from",
            metavar="NAME",
            help=f"Starting point; by default the one of the file's name, or else {DEFAULT}.",
            autocompletion=lambda: names(),
        ),
    ] = None,
    listed: Annotated[bool, Option("--list", help="List the starting points.")] = False,
    schema: Annotated[bool, Option(help=f"Write {SCHEMA_FILE} next to it, for editors.")] = True,
) -> None:
    """Write a commented case file to start from."""
    if listed:
        _print_titles(titles())
        return
    path = _case_file(path)
    start = start or (path.stem if path.stem in names() else DEFAULT)
    text = _starting_point(start)
    if path.exists():
        raise CaseError([f"{path}: exists already, give another name"])
    if schema:
        _write_schema_beside(path)
        text = f"#:schema ./{SCHEMA_FILE}\n{text}"
    write_text(path, text)
    out.print(f"wrote {path} from the starting point {start}; try: dembound check {path}")


def _case_file(path: Path) -> Path:
    """The file of a new case, with its ending; raises CaseError for a folder and another ending."""
    if path.is_dir():
        raise CaseError([f"FILE: is the folder {path}, must be a file in it, such as {path / 'case.toml'}"])
    if path.suffix == "":
        return path.with_name(f"{path.name}{ENDING}")
    if path.suffix != ENDING:
        raise CaseError([f"FILE: is {path}, must end in {ENDING}, such as {path.with_suffix(ENDING)}"])
    return path


def _starting_point(name: str) -> str:
    """The text of a starting point; for the name of a case the error says how to copy it."""
    try:
        return starting_point(name)
    except CaseError as error:
        if name in shipped.names() or name in shipped.groups():
            error.add_note(f"{name} is one of `dembound cases`; to copy it: dembound cases copy {name}")
        raise


def _write_schema_beside(path: Path) -> None:
    """Write the schema into the folder of a case, replacing one of an earlier version.

    Raises CaseError if a file of that name is not a schema of dembound.
    """
    from dembound.casefile.json_schema import IDENTIFIER

    file, text = path.parent / SCHEMA_FILE, _schema()
    if file.exists():
        if IDENTIFIER not in file.read_text(encoding="utf-8", errors="replace"):
            raise CaseError([f"{file}: exists and is not a schema of dembound; move it, or give --no-schema"])
        if file.read_text(encoding="utf-8") == text:
            return
    writable(file)
    write_text(file, text)
    out.print(f"wrote {file}, with which editors complete and check cases")


def _schema() -> str:
    """The schema as the text of a file."""
    from dembound.casefile.json_schema import json_schema
    from dembound.schemas import SCHEMAS

    return json.dumps(json_schema(SCHEMAS), indent=1, ensure_ascii=False) + "\n"


@app.command("schema", rich_help_panel=MORE)
def schema(
    output: Annotated[Path | None, Option("--output", "-o", help="File (JSON).", callback=writable)] = None,
) -> None:
    """Print the JSON schema of case files, for editors."""
    if output is None:
        typer.echo(_schema(), nl=False)
        return
    write_text(output, _schema())
    print_written(output)


@cases.callback()
def list_cases(context: typer.Context) -> None:
    """List the cases that come with dembound, or copy some."""
    if context.invoked_subcommand is None:
        _print_titles(shipped.titles())
        groups = " or ".join(shipped.groups())
        out.print(f"copy one, or all of {groups}: dembound cases copy NAME [FOLDER]")


@cases.command("copy")
def copy(
    name: Annotated[
        str,
        Argument(
            metavar="NAME",
            help="A case, or a group such as zhou2018.",
            autocompletion=lambda: [*shipped.groups(), *shipped.names()],
        ),
    ],
    folder: Annotated[Path, Argument(metavar="FOLDER", help="Where to.")] = Path(),
) -> None:
    """Copy a case, or a group, with the files they read. Overwrites nothing."""
    print_written(*shipped.copy(name, folder))


def _print_titles(titles: Mapping[str, str]) -> None:
    """Names and titles, one line each."""
    width = max(map(len, titles))
    for name, title in titles.items():
        out.print(f"{name:{width}}  {title}")
