"""Signals that end a run: it stops between two steps, when its state can be kept."""

import signal
import threading
from types import FrameType, TracebackType
from typing import Self

ENDING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Ctrl-C; the request to end, by batch systems before they kill; a closed terminal."""


class Stopped(KeyboardInterrupt):
    """Raised in place of KeyboardInterrupt when a run has been ended by a signal and its state has been kept."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.exit_code = 128 + number


class Interrupts:
    """Notes signals inside its ``with`` statement; a second one acts at once, as it would outside.

    In other threads than the main one, which receive no signals, it does nothing.

    Attributes
    ----------
    caught : number of the signal, None before.
    """

    def __init__(self) -> None:
        self.caught: int | None = None
        self._before: dict[int, object] = {}

    def __enter__(self) -> Self:
        if threading.current_thread() is threading.main_thread():
            self._before = {number: signal.signal(number, self._note) for number in ENDING}
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._restore()

    def _note(self, number: int, frame: FrameType | None) -> None:
        self.caught = number
        self._restore()

    def _restore(self) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)  # type: ignore[arg-type]  # what signal.signal has returned
        self._before = {}
