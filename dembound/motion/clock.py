"""What a run spends its time on."""

import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager

from numba.core import event


class Clock:
    """Adds up the seconds spent in sections; a section within another one does not count for that one.

    Attributes
    ----------
    seconds : by section.
    """

    def __init__(self) -> None:
        self.seconds: defaultdict[str, float] = defaultdict(float)
        self._open: list[str] = []
        self._since = 0.0

    @contextmanager
    def of(self, section: str) -> Iterator[None]:
        """Count the time within for a section."""
        self._begin(section)
        try:
            yield
        finally:
            self._end()

    @contextmanager
    def with_compiling(self) -> Iterator[None]:
        """Count compiling kernels within, and loading those compiled before, as a section of its own, "compile"."""
        with event.install_listener("numba:compiler_lock", _Compiling(self)):
            yield

    def _begin(self, section: str) -> None:
        self._count()
        self._open.append(section)

    def _end(self) -> None:
        self._count()
        self._open.pop()

    def _count(self) -> None:
        """Give the time since the last change to the section that is open."""
        now = time.perf_counter()
        if self._open:
            self.seconds[self._open[-1]] += now - self._since
        self._since = now


class _Compiling(event.Listener):
    """Starts and ends a section of a clock where numba compiles or loads; what that compiles in turn is within it."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def on_start(self, event: event.Event) -> None:
        """Numba is about to compile."""
        self._clock._begin("compile")

    def on_end(self, event: event.Event) -> None:
        """It is done."""
        self._clock._end()
