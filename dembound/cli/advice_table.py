"""The table of advice, printed as it becomes known."""

import textwrap
from collections.abc import Sequence

from dembound.accuracy.proposal import Proposal
from dembound.accuracy.table import WIDTH, lines_of
from dembound.cli.console import out
from dembound.cli.progress import Shown, Watching
from dembound.words import percent, with_unit


class Table(Watching):
    """Shows what is computed, and prints errors of a case and the cheapest choice by bound, once known."""

    def __init__(self, bounds: Sequence[float], name: str, shown: Shown) -> None:
        super().__init__(name, shown)
        self._left, self._before = sorted(bounds, reverse=True), ""

    def given(self, proposal: Proposal) -> None:
        """Print the errors of the case, and the head of the table of choices."""
        self._print(
            f"{self.name}: its steps take about {with_unit(proposal.cost, 's', 2)}",
            *lines_of(proposal.budget),
            "",
            "   requested  predicted  at most      time   what changes",
        )

    def best(self, bound: float, best: Proposal) -> None:
        """Print the choice for a bound."""
        share = best.budget.worst().share
        numbers = f"{share.expected:>9} {share.most:>8}  {with_unit(best.cost, 's', 2):>8}   "
        words = best.choice.name if best.choice.changes else "nothing"
        if not best.holds(bound):
            words = f"no choice holds it, least error: {words if best.choice.changes else 'the case as it is'}"
        self._before, words = words, "the same" if words == self._before != "nothing" else words
        first = f"{percent(bound, 3):>12}  {numbers}"
        self._left.remove(bound)
        self._print(*textwrap.wrap(words, WIDTH, initial_indent=first, subsequent_indent=" " * 8))

    def _print(self, *lines: str) -> None:
        """Print lines of at most 80 characters."""
        left = ", ".join(percent(each, 3) for each in self._left)
        self.missing = f"the cheapest choices within {left}" if left else "nothing"
        with self.shown.aside():
            for line in lines:
                out.print(line, markup=False, soft_wrap=True)
