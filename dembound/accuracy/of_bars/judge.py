"""Errors of bars: causes are computed at every frequency, without a run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from dembound.accuracy.cause import Causes, Truth
from dembound.accuracy.choice import Choice, Named
from dembound.accuracy.history import Motions
from dembound.accuracy.judge import Judge
from dembound.accuracy.moved_sides import Extended
from dembound.accuracy.of_bars.causes import causes_of_bar
from dembound.accuracy.of_bars.chart_choices import bar_choices
from dembound.accuracy.of_bars.extended import extended_bar
from dembound.accuracy.of_bars.finer import Finer, finer
from dembound.accuracy.of_bars.pulse import PulseInBar
from dembound.accuracy.of_bars.search import advice_for_bar
from dembound.accuracy.proposal import Advice, Receiver
from dembound.accuracy.runner import Run
from dembound.bar.kind import SPALL_PLACE, SPALL_TIME
from dembound.bar.scene import BarScene
from dembound.casefile.bar import BarCase
from dembound.results.histories import Quantity


class BarJudge(Judge[BarCase, BarScene]):
    """Errors of bars."""

    from_left_end: ClassVar[Sequence[str]] = (SPALL_PLACE,)
    first_break = SPALL_TIME
    quantities: ClassVar[Sequence[Quantity]] = ("velocity", "displacement", "stress")

    def causes(self, case: BarCase, recorded: Motions, time_step: float, work: float, most: float) -> Causes:
        """Errors of ends, nodes and steps, from the waves of the linear bar."""
        return causes_of_bar(case, recorded, time_step)

    def advise(
        self,
        case: BarCase,
        bounds: Sequence[float],
        of: Truth,
        kept: Sequence[str],
        longest: float | None,
        receiver: Receiver,
    ) -> Advice:
        """The cheapest nodes, steps and absorbing ends."""
        return advice_for_bar(case, bounds, kept, longest, receiver)

    def extended(self, case: BarCase, most: int) -> Extended:
        """The bar with more spacings beyond ends that are neither loaded nor driven."""
        return extended_bar(case, most)

    def exact(self, case: BarCase) -> PulseInBar | None:
        """The exact motion under a pulse at the left end of a bar without attenuation; None for other bars."""
        return PulseInBar.of(case)

    def finer(self, case: BarCase, choices: Sequence[Choice[BarCase]], outcomes: Sequence[Run]) -> Finer:
        """The bar by finite differences at Courant number 1."""
        return finer(case, choices, outcomes)

    def chart_choices(self, case: BarCase) -> Named:
        """All methods with several spacings."""
        return bar_choices(case)
