"""The application all commands belong to, and the options they share."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option
from typer.core import TyperCommand, TyperGroup

from dembound.cli.console import ending_with, out
from dembound.errors import CaseError
from dembound.version import __version__

if TYPE_CHECKING:
    from dembound.casefile import Case
    from dembound.casefile.disks import DiskCase

EXIT_CODES = (  # in one line: line breaks within a paragraph stay in the help
    "Exit codes: 0 done; 1 a bug; 2 bad input, nothing was written; 3 a run, calibration or choice failed; 4 a "
    "packing could not be made; 5 a file could not be read or "
    "written; 130 stopped with Ctrl-C, 143 by SIGTERM, 129 by SIGHUP."
)

OPTIONS = "Options: --version; -h, --help; --install-completion, --show-completion: for the current shell."
"""In the help below the commands."""


MORE = "More"
"""Panel of the help for less usual commands."""

ORDER = (
    *("new", "check", "run", "advise", "plot", "report", "calibrate", "chart", "sweep", "test"),
    *("cases", "paper", "schema", "material", "packing", "boundary", "stability", "dispersion", "exact"),
    *("resume", "rerun", "library", "respond"),
    *("estimate", "compare", "signals", "movie", "wave", "gauge", "hopkinson", "cache"),
)
"""All commands in the order of work: the usual steps, then the panel `MORE`."""


GONE = {"view": "open paraview/ of the results in ParaView, or take dembound plot --field, report or movie"}
"""What to do in place of commands of earlier versions."""


class _Commands(TyperGroup):
    """All commands; signals end them with one line, also while options are read."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Names of the commands, as the help lists them."""
        return sorted(super().list_commands(ctx), key=lambda name: ORDER.index(name) if name in ORDER else len(ORDER))

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Print the commands first: the options, whose panel would be above them, are in a line below."""
        for option in self.get_params(ctx):
            option.hidden = True  # type: ignore[attr-defined]
        super().format_help(ctx, formatter)

    def resolve_command(self, ctx: Any, args: Any) -> Any:
        """The command of the first argument; raises CaseError for those of earlier versions, with their replacement."""
        if args[0] in GONE:
            raise CaseError([f"{args[0]}: is no longer a command; {GONE[args[0]]}"])
        return super().resolve_command(ctx, args)

    def make_context(self, *arguments: Any, **more: Any) -> Any:
        """Read the options."""
        with ending_with("dembound: stopped"):
            return super().make_context(*arguments, **more)

    def invoke(self, ctx: Any) -> Any:
        """Run the command that was given."""
        with ending_with("dembound: stopped"):
            return super().invoke(ctx)


class _Command(TyperCommand):
    """A command whose options that are numbers must be finite."""

    def invoke(self, ctx: Any) -> Any:
        """Run it; raises CaseError for options that are infinite, or nan, before anything else."""
        for option in self.params:
            value = ctx.params.get(option.name)
            for number in value if isinstance(value, list | tuple) else (value,):
                if isinstance(number, float) and not math.isfinite(number):
                    name = next(name for name in option.opts if name.startswith("--"))
                    raise CaseError([f"{name}: is {number}, must be a finite number"])
        return super().invoke(ctx)


class _App(typer.Typer):
    """An application of such commands."""

    def command(self, *arguments: Any, **more: Any) -> Callable[[Any], Any]:
        """A decorator that registers a function as a command."""
        return super().command(*arguments, cls=_Command, **more)


app = _App(
    name="dembound",
    cls=_Commands,
    help="Waves in bonded particles, with artificial boundaries that absorb, and in bars of rock that break.",
    epilog=f"{OPTIONS}\n\n{EXIT_CODES}",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def writable(path: Path | None) -> Path | None:
    """A file to write, if its folder exists; checked before anything is computed.

    A link of the user, which is not in the folder of a run, is followed.

    Raises FileNotFoundError if it does not exist.
    """
    if path is not None:
        from dembound.files import is_link, require_folder

        require_folder(path)
        if is_link(path) and not (path.parent / "run.h5").exists():
            return path.resolve()
    return path


def ending_in(*endings: str) -> Callable[[typer.CallbackParam, Path | None], Path | None]:
    """A check of a file to write, whose folder must exist; raises CaseError if its name has none of these endings."""

    def check(param: typer.CallbackParam, path: Path | None) -> Path | None:
        if path is not None and path.suffix.lower() not in endings:
            raise CaseError([f"{param.opts[0]}: is {path}, must end in {endings[0]}"])
        return writable(path)

    return check


png = ending_in(".png")
PICTURE = Option("--output", "-o", help="Picture (PNG).", callback=png)
PictureTitle = Annotated[str | None, Option("--title", help="Title of the picture.")]


def at_most(limit: int) -> Callable[[typer.CallbackParam, Any], Any]:
    """A check of a number, of which a larger one than a limit raises CaseError."""

    def check(param: typer.CallbackParam, value: Any) -> Any:
        if value is not None and value > limit:
            raise CaseError([f"{param.opts[0]}: is {value:g}, must be at most {limit}"])
        return value

    return check


few = at_most(10_000)
"""A check of a number of samples, or of runs that are repeated."""

Cases = Annotated[list[Path], Argument(metavar="CASE...", help="Case files (TOML).")]
Output = Annotated[Path, Option("--output", "-o", help="Folder for the results.")]
Threads = Annotated[int | None, Option(min=1, help="Cores to use; all by default. Results do not depend on it.")]
Settings = Annotated[
    list[str] | None,
    Option("--set", metavar="KEY=VALUE", help="Change a key, e.g. boundary.right.beta_p=0.8. May be repeated."),
]
Vary = Annotated[
    list[str] | None,
    Option(
        metavar="KEY=A,B,…",
        help="Values of a key, or a range, e.g. packing.radius=0.25,0.5 or packing.seed=1:20. May be repeated: all "
        "combinations are run.",
    ),
]
Scheduler = Annotated[
    str | None, Option(metavar="ADDRESS", help="Use an existing Dask cluster, e.g. tcp://node1:8786.")
]
Name = Annotated[str | None, Option(help="Name of the results; by default the case file's.")]


class Side(StrEnum):
    """The sides of a scene; an enumeration, as lists of options need one."""

    left, right, bottom, top = "left", "right", "bottom", "top"


@app.callback(invoke_without_command=True)
def _version(version: Annotated[bool, Option("--version", help="Print the version and stop.")] = False) -> None:
    if version:
        out.print(f"dembound {__version__}")
        raise typer.Exit


def require_one_place(scheduler: str | None, processes: int | None) -> None:
    """Raise CaseError if both a cluster and a number of processes are given."""
    if scheduler and processes:
        raise CaseError(["--processes: is for this machine, not allowed together with --scheduler"])


def load_case(path: Path, changes: list[str] | None, name: str | None = None) -> Case:
    """Read a case file, and change its keys and its name as given by the options."""
    from dembound.schemas import load

    return changed(load(path), changes, name)


def changed(case: Case, changes: list[str] | None, name: str | None) -> Case:
    """The case with keys and name changed as given by the options."""
    from dembound.schemas import with_changes

    if changes:
        case = with_changes(case, settings_of(changes))
    if name is None:
        return case
    from dembound.results.folder import problem_of

    if problem := problem_of(name):
        raise CaseError([f"--name: is {name!r}, {problem}"])
    return replace(case, name=name)


def text_for(target: Path, path: Path, case: Case, changes: Sequence[str] | None) -> str:
    """The text of a case file with the changes of ``--set``, for a file in the folder of another one.

    case : the changed case of the file.
    """
    from dembound.casefile import to_toml
    from dembound.casefile.edit import edited

    text = edited(path.read_bytes().decode("utf-8-sig"), settings_of(changes))
    return to_toml(replace(case, text=text), target.parent)


def load_disks(path: Path, changes: list[str] | None, name: str | None = None) -> DiskCase:
    """Read a case for a command that accepts only disks."""
    from dembound.casefile.disks import DiskCase
    from dembound.casefile.model import as_kind

    case = load_case(path, changes, name)
    return as_kind(case, DiskCase, "is the case of a bar, this command is for disks", str(path))


def settings_of(changes: Sequence[str] | None) -> dict[str, Any]:
    """Keys and values of the options ``--set``."""
    return dict(_setting(text) for text in changes or ())


def _setting(text: str) -> tuple[str, Any]:
    """Key and value of ``--set key=value``; the value is TOML, or else a plain string."""
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise CaseError([f"--set: is {text}, must be KEY=VALUE, e.g. boundary.right.beta_p=0.8"])
    from dembound.casefile.reader import value_of

    return key.strip(), value_of(value, f"--set {key.strip()}")


def prepare_computing(threads: int | None) -> None:
    """Set the number of threads, at most the available ones, and report compiling."""
    from dembound.cli.compiling import report_compiling

    report_compiling()
    if threads is not None:
        import numba

        most = numba.get_num_threads()
        if threads > most:
            raise CaseError([f"--threads: is {threads}, must not be above {most}, the cores here"])
        numba.set_num_threads(threads)


logging.getLogger("dembound").setLevel(logging.INFO)
