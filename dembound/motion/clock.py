"""The time of the parts of a run, compilation among them."""

import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from contextlib import contextmanager

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


class Clock:
    """Adds up the seconds spent in sections; time in a nested section is not counted for the outer one.

    Parameters
    ----------
    now : the clock in s, by default that of the wall; `time.process_time` counts the CPU time of all threads.

    Attributes
    ----------
    seconds : by section.
    """

    def __init__(self, now: Callable[[], float] | None = None) -> None:
        self._now = now or time.perf_counter
        self.seconds: defaultdict[str, float] = defaultdict(float)
        self._open: list[str] = []
        self._since = 0.0

    @contextmanager
    def of(self, section: str) -> Iterator[None]:
        """Add the time spent inside to a section."""
        self._begin(section)
        try:
            yield
        finally:
            self._end()

    @contextmanager
    def with_compiling(self) -> Iterator[None]:
        """Count the time for compiling or loading kernels inside as a separate section "compile"."""
        with event.install_listener("numba:compiler_lock", _Compiling(self)):
            yield

    def _begin(self, section: str) -> None:
        self._count()
        self._open.append(section)

    def _end(self) -> None:
        self._count()
        self._open.pop()

    def _count(self) -> None:
        """Add the time since the last change to the current section."""
        now = self._now()
        if self._open:
            self.seconds[self._open[-1]] += now - self._since
        self._since = now


class _Compiling(event.Listener):
    """Starts and ends a section of a clock when numba compiles or loads, nested compilations included."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def on_start(self, event: event.Event) -> None:
        """Numba begins to compile."""
        self._clock._begin("compile")

    def on_end(self, event: event.Event) -> None:
        """Numba has finished."""
        self._clock._end()
