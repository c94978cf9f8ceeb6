"""What is being computed for an estimate or for advice, and what is known of it, for who started it."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext

from dembound.accuracy.proposal import Proposal
from dembound.formulas.cause import Cause
from dembound.formulas.history import Motions
from dembound.interrupts import look
from dembound.running import Progress


class Watch:
    """Is told what is computed; the default only obeys requests to end.

    Attributes
    ----------
    part : of the whole, such as the bound for which choices are tried; it precedes all that is done for it.
    """

    part = ""

    def begins(self, what: str) -> None:
        """Something that may take seconds begins; overriding methods call this one, which looks for requests to end."""
        look()

    def run(self, what: str) -> AbstractContextManager[Progress]:
        """The progress of a companion that begins."""
        return nullcontext(Progress())

    def knows(self, causes: Sequence[Cause], motions: Motions, missing: str) -> None:
        """Causes are known, of these motions by monitor, while others are still missing, given in words."""

    def given(self, proposal: Proposal) -> None:
        """The errors of the case itself are known."""

    def best(self, bound: float, proposal: Proposal) -> None:
        """The best choice for an error bound is known; bounds come from the largest to the smallest."""
