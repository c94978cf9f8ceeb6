"""A message while kernels are being compiled, which takes much longer than loading compiled ones."""

import time
from collections.abc import Callable
from functools import cache

from numba.core import event
from rich.status import Status
from rich.text import Text

from dembound.cli.console import err

MESSAGE = "compiling the solver: 10 to 40 s, once per installation, less for a new law"


class Compilation(event.Listener):
    """Prints the message when the first kernel is compiled; on a terminal also what is compiled, and for how long.

    Kernels that are loaded from the disk, and functions of other packages, are not counted.

    Parameters
    ----------
    now : clock in s.

    Attributes
    ----------
    beside_bar : whether a bar of progress is shown, which has `note` in it.
    """

    def __init__(self, now: Callable[[], float] = time.monotonic) -> None:
        self.now, self.beside_bar = now, False
        self._printed, self._began, self._spent = False, 0.0, 0.0
        self._open: list[str] = []
        """Names of the functions that are being compiled, each within the one before."""
        self._shown: Status | None = None

    def note(self) -> str:
        """Seconds of compiling up to now, and the function that is being compiled; empty if there is none."""
        if not self._open:
            return ""
        return f"compiling for {self._spent + self.now() - self._began:.0f} s: {self._open[-1]}"

    def __rich__(self) -> Text:
        """The note at the time at which it is drawn."""
        return Text(self.note(), no_wrap=True, overflow="ellipsis")

    def on_start(self, event: event.Event) -> None:
        """Numba begins to compile a function, perhaps within another one."""
        if not _is_own(event):
            return
        if not self._printed:
            self._printed = True
            err.print(MESSAGE)
        if not self._open:
            self._began = self.now()
        self._open.append(event.data["dispatcher"].py_func.__name__.strip("_").replace("_", " "))
        if err.is_terminal and not self.beside_bar and len(self._open) == 1:
            self._shown = err.status(self)
            self._shown.start()

    def on_end(self, event: event.Event) -> None:
        """Numba has compiled it."""
        if not _is_own(event):
            return
        self._open.pop()
        if not self._open:
            self._spent += self.now() - self._began
            if self._shown is not None:
                self._shown.stop()
                self._shown = None


def _is_own(event: event.Event) -> bool:
    """Whether the function is one of this package."""
    return bool(event.data["dispatcher"].py_func.__module__.startswith("dembound."))


COMPILATION = Compilation()
"""The compilation of this process."""


@cache
def report_compiling() -> None:
    """Print one line, once in a process, if a kernel of this package is compiled from now on."""
    event.register("numba:compile", COMPILATION)
