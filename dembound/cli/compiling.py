"""A message while kernels are being compiled, which takes much longer than loading compiled ones."""

import time
from collections.abc import Callable
from functools import cache

from numba.core import event
from rich.status import Status

from dembound.cli.console import err

MESSAGE = "compiling the solver: 10 to 40 s, once per installation, less for a new law"


class Compilation(event.Listener):
    """Prints the message when the first kernel is compiled, and on a terminal shows for how long that has taken.

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
        self._printed, self._open, self._began, self._spent = False, 0, 0.0, 0.0
        self._shown: Status | None = None

    def note(self) -> str:
        """A note with the seconds of compiling up to now; empty if nothing is being compiled."""
        return f"compiling the solver, {self._spent + self.now() - self._began:.0f} s" if self._open else ""

    def on_start(self, event: event.Event) -> None:
        """Numba begins to compile a function, perhaps within another one."""
        if not _is_own(event):
            return
        if not self._printed:
            self._printed = True
            err.print(MESSAGE)
        if self._open == 0:
            self._began = self.now()
        self._open += 1
        if err.is_terminal and not self.beside_bar and self._open == 1:
            self._shown = err.status(self.note())
            self._shown.start()

    def on_end(self, event: event.Event) -> None:
        """Numba has compiled it."""
        if not _is_own(event):
            return
        self._open -= 1
        if self._open == 0:
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
