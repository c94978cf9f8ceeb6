"""Checks for requests to end while kernels are compiled or loaded, from the import of this module on."""

from numba.core import event

from dembound.interrupts import look


class _Looks(event.Listener):
    """Checks before a kernel is compiled or loaded, and before every pass of the compiler."""

    def on_start(self, event: event.Event) -> None:
        """Look."""
        look()

    def on_end(self, event: event.Event) -> None:
        """Do nothing: the next pass or kernel checks."""


for _kind in ("numba:compiler_lock", "numba:run_pass"):
    event.register(_kind, _Looks())
