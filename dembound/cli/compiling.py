"""A message when kernels are compiled, which takes much longer than loading compiled ones."""

from functools import cache

from numba.core import event

from dembound.cli.console import err

MESSAGE = "compiling the solver: 10 to 40 s, once per installation, less for a new law"


class _First(event.Listener):
    """Prints the message when the first kernel is compiled; loaded ones, and those of other packages, do not count."""

    _printed = False

    def on_start(self, event: event.Event) -> None:
        """Numba begins to compile a function."""
        if not self._printed and event.data["dispatcher"].py_func.__module__.startswith("dembound."):
            self._printed = True
            err.print(MESSAGE)

    def on_end(self, event: event.Event) -> None:
        """Numba has compiled it."""


@cache
def report_compiling() -> None:
    """Print one line, once in a process, if a kernel of this package is compiled from now on."""
    event.register("numba:compile", _First())
