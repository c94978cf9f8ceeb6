"""The command line as it is called: warnings and failures in one line each, exit codes."""

from __future__ import annotations

import atexit
import gc
import logging
import os
import sys
import warnings
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from dembound.cli.app import app
from dembound.cli.console import err, flush, prepare_streams
from dembound.errors import DemboundError, RunError, UnusableTypeWarning
from dembound.machine import address_limit, give_back_at_once, memory_ran_out

CANNOT_WRITE = 5


COLLECT_EVERY = 100_000
"""Number of new objects after which Python searches for unused cycles: most objects belong to packages and remain."""


def _show_only_own_warnings() -> None:
    """Show only Python warnings about types of other packages, unless Python's option -W requests others.

    Warnings of numpy and matplotlib concern code, which a user cannot mend.
    """
    warnings.showwarning = _in_one_line
    if not sys.warnoptions:
        warnings.simplefilter("ignore")
        warnings.simplefilter("default", UnusableTypeWarning)


def _in_one_line(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
    """Print a Python warning without the place in the source that it comes from."""
    err.print(f"warning: {' '.join(str(message).split())}")


class _Printed(logging.Handler):
    """Prints the log messages of the package about long work, for example packing a brick."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print a message on a separate line."""
        err.print(record.getMessage())


logging.getLogger("dembound").addHandler(_Printed(logging.INFO))


def main() -> None:
    """Run the command line; every failure a user can cause is one message and its exit code."""
    give_back_at_once()
    gc.set_threshold(COLLECT_EVERY)
    atexit.register(gc.freeze)  # else everything is searched once more at the end
    prepare_streams()
    os.environ["MPLBACKEND"] = "agg"  # pictures are files; a backend for windows may not even be there
    try:
        with warnings.catch_warnings():
            _show_only_own_warnings()
            try:
                app(prog_name="dembound")  # the name in help and completion, however it was started
            finally:
                flush()
    except DemboundError as error:
        source = f"{error.source}: " if error.source else ""
        _print_failure(error, [f"{source}{line}" for line in str(error).splitlines()])
        sys.exit(error.exit_code)
    except (OSError, MemoryError, ImportError, SystemError) as error:
        if memory_ran_out(error):
            _print_failure(error, [_of_memory(error)])
            sys.exit(RunError.exit_code)
        if not isinstance(error, OSError):
            raise
        _print_failure(error, [_of_system(error)])
        sys.exit(CANNOT_WRITE)


def _of_system(error: OSError) -> str:
    """One line on an error of the system, as of a full disk; with its cause for a missing folder or file."""
    try:
        Path.cwd()
    except FileNotFoundError:
        return "the current folder has been deleted; change to another one"
    named = Path(str(error.filename or ""))
    for path in (named, *named.parents):
        if path.is_symlink() and not path.exists():
            return f"{path}: is a link to {path.readlink()}, which does not exist"
    return f"{error.filename or 'output'}: {error.strerror or error}"


def _of_memory(error: Exception) -> str:
    """One line on an error of missing memory."""
    limit, what = address_limit(), " ".join(str(error).split()) or type(error).__name__
    within = "" if limit is None else f" within the {limit / 1e6:.0f} MB of addresses allowed (ulimit -v)"
    return f"dembound: memory ran out{within}: {what}"


def _print_failure(error: Exception, lines: Sequence[str]) -> None:
    """Print the failure and the notes of commands on remedies."""
    with suppress(OSError):  # the exit code remains where nothing can be printed
        for line in (*lines, *getattr(error, "__notes__", ())):
            err.print(line, style="red")
