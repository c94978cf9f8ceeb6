"""What is being computed for an estimate or for advice, and what is known of it, for who started it.

Formulas, companions and the search are far apart, so that they find the receiver in the context, as requests to end.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from contextvars import ContextVar

from dembound.formulas.cause import Cause
from dembound.formulas.history import Motions
from dembound.interrupts import look
from dembound.running import Progress


class Watch:
    """Receives what is computed; the default ignores it.

    Attributes
    ----------
    part : of the whole, such as the bound for which choices are tried; it precedes all that is done for it.
    """

    part = ""

    def begins(self, what: str) -> None:
        """Something that may take seconds begins."""

    def run(self, what: str) -> AbstractContextManager[Progress]:
        """The progress of a companion that begins."""
        return nullcontext(Progress())

    def knows(self, causes: Sequence[Cause], motions: Motions, missing: str) -> None:
        """Causes are known, of these motions by monitor, while others are still missing, given in words."""


_current: ContextVar[Watch | None] = ContextVar("_current", default=None)


def current() -> Watch:
    """The receiver in this context."""
    return _current.get() or Watch()


@contextmanager
def watched_by(watch: Watch) -> Iterator[None]:
    """Inside, a receiver hears of all that is computed."""
    token = _current.set(watch)
    try:
        yield
    finally:
        _current.reset(token)


def begins(what: str) -> None:
    """Inform the receiver that something begins, after looking for requests to end."""
    look()
    current().begins(what)
