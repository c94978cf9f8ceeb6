"""Signals that end a run: it stops between two steps, when its state can be kept."""

import signal
import threading
from types import FrameType, TracebackType
from typing import Self

ENDING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Ctrl-C; the request to end, by batch systems before they kill; a closed terminal."""

INTERRUPTED = 130
"""Exit code after Ctrl-C."""


class Stopped(KeyboardInterrupt):
    """Raised in place of KeyboardInterrupt for a signal, and when a run has been ended by one and its state is kept."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.exit_code = 128 + number


def exit_code_of(stop: KeyboardInterrupt) -> int:
    """Exit code of a process that ends with it."""
    return stop.exit_code if isinstance(stop, Stopped) else INTERRUPTED


def end_at_signals() -> None:
    """Let all signals that end a run raise `Stopped` from now on, as Ctrl-C raises KeyboardInterrupt."""
    for number in _obeyed():
        if signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _stop)


def _stop(number: int, frame: FrameType | None) -> None:
    raise Stopped(number)


def _obeyed() -> list[int]:
    """The signals that end a run, without those that the process was started to ignore, such as by ``nohup``."""
    return [number for number in ENDING if signal.getsignal(number) is not signal.SIG_IGN]


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
            self._before = {number: signal.signal(number, self._note) for number in _obeyed()}
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
