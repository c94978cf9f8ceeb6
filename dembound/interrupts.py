"""Requests to end: they are noted, and obeyed at calls of `look`, between two pieces of work.

An exception raised by a handler of signals would be lost where Python drops exceptions, as in callbacks of compilers,
and could leave a file or a lock half-way. So only the next call of `look` raises: between imports, compiled kernels,
blocks of steps, iterations, files and pictures.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from importlib.machinery import ExtensionFileLoader, ModuleSpec
from types import FrameType, ModuleType, TracebackType
from typing import Any, Self

ENDING = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Ctrl-C; the request to end, by batch systems before they kill; a closed terminal."""

INTERRUPTED = 130
"""Exit code after Ctrl-C."""

TOGETHER = 0.1
"""Seconds within which signals are one request: ``timeout`` sends its signal twice, as do a terminal and a wrapper."""


class Stopped(KeyboardInterrupt):
    """Raised by `look` after a request to end."""

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.exit_code = 128 + number


def exit_code_of(stop: KeyboardInterrupt) -> int:
    """Exit code of a process that ends with this signal."""
    return stop.exit_code if isinstance(stop, Stopped) else INTERRUPTED


def obeyed() -> list[int]:
    """The signals that end a run, without those that the process was started to ignore, such as by ``nohup``."""
    return [number for number in ENDING if signal.getsignal(number) is not signal.SIG_IGN]


class Interrupts:
    """Notes requests to end inside its ``with`` statement; outside nothing is changed.

    A request is a signal, or a file that appears. A second signal acts at once, as it would outside. Inside another
    statement requests to either are noted. Threads other than the main one receive no signals.

    On leaving, a signal that `look` has not raised raises `Stopped`, so that none is lost.

    Parameters
    ----------
    stop : a file that is a request, like SIGTERM, once it exists; on any machine that sees it.
    """

    def __init__(self, stop: str | os.PathLike[str] | None = None) -> None:
        self._stop = stop
        self._signal: int | None = None
        self._outer: Interrupts | None = None
        self._before: dict[int, Any] = {}

    @property
    def caught(self) -> int | None:
        """Number of the signal of the request to end, None before."""
        if self._signal is None and self._stop is not None and os.path.exists(self._stop):
            return signal.SIGTERM
        return self._outer.caught if self._signal is None and self._outer is not None else self._signal

    def __enter__(self) -> Self:
        self._outer = _current.get()
        self._token = _current.set(self)
        if self._outer is None and threading.current_thread() is threading.main_thread():
            self._before = {number: signal.signal(number, self._note) for number in obeyed()}
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._restore()
        _current.reset(self._token)
        if error is None and self._signal is not None:
            raise Stopped(self._signal)

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self._signal is None:
            self._signal = number
            time.sleep(TOGETHER)  # the same request once more calls this again, inside
            self._restore()

    def _restore(self) -> None:
        before, self._before = self._before, {}
        for number, handler in before.items():
            signal.signal(number, handler)


_current: ContextVar[Interrupts | None] = ContextVar("_current", default=None)
_is_put_off: ContextVar[bool] = ContextVar("_is_put_off", default=False)


def caught() -> int | None:
    """Number of the signal of a request to end that has been noted in this thread, None without one."""
    current = _current.get()
    return None if current is None else current.caught


def look() -> None:
    """Raise `Stopped` if a request to end has been noted, unless that is `put_off`."""
    if (current := _current.get()) is not None and not _is_put_off.get() and (number := current.caught) is not None:
        raise Stopped(number)


@contextmanager
def put_off() -> Iterator[None]:
    """Inside, `look` raises nothing: for short work that must not be left half-done."""
    token = _is_put_off.set(True)
    try:
        yield
    finally:
        _is_put_off.reset(token)


class _Imports:
    """A finder of modules that finds none, but checks for requests to end at every import."""

    def find_spec(self, *arguments: Any) -> None:
        """Look."""
        look()


def look_at_imports() -> None:
    """Also check for requests to end between imports from now on."""
    sys.meta_path.insert(0, _Imports())  # type: ignore[arg-type]  # as find_spec is all that importing needs


def end_while_loading() -> None:
    """From now on, have signals end this process at once while it loads a compiled library.

    No handler is called within one, and without memory it may never return.
    """
    load = ExtensionFileLoader.create_module

    def create_module(loader: ExtensionFileLoader, spec: ModuleSpec) -> ModuleType:
        before = {number: signal.signal(number, signal.SIG_DFL) for number in obeyed()}
        try:
            return load(loader, spec)
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    ExtensionFileLoader.create_module = create_module  # type: ignore[assignment, method-assign]


@contextmanager
def whole_process() -> Iterator[None]:
    """Note requests to end of this process from now on, also between imports; a second signal ends it at once.

    To be used once, in the main thread, by a process that does nothing else.
    """
    for number in obeyed():
        signal.signal(number, signal.SIG_DFL)
    with Interrupts():
        look_at_imports()
        try:
            yield
            look()
        except SystemExit as end:
            if not end.code:
                look()
            raise
