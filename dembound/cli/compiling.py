"""Prints that kernels are being compiled, which takes much longer than loading compiled ones."""

from functools import cache

from numba.core import event

from dembound.cli.console import err

MESSAGE = "compiling the solver: some 10 to 40 s, once after an installation, less for each further law"


class FirstCompilation(event.Listener):
    """Prints the message when the first kernel is compiled; kernels loaded from the disk are not."""

    def __init__(self) -> None:
        self.printed = False

    def on_start(self, event: event.Event) -> None:
        """Numba begins to compile a function."""
        if not self.printed and event.data["dispatcher"].py_func.__module__.startswith("dembound."):
            self.printed = True
            err.print(MESSAGE)

    def on_end(self, event: event.Event) -> None:
        """Numba has compiled it."""


@cache
def report_compiling() -> None:
    """Print one line, once in a process, if a kernel of this package is compiled from now on."""
    event.register("numba:compile", FirstCompilation())
