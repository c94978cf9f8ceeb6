"""Errors of bars at every frequency, without a run, and bars to compare them with: extended ones and finer ones."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from dembound.accuracy.choice import Choice, Named
from dembound.accuracy.judge import Extended, Judge, movable, must_not_exceed, same_step, sentence_of
from dembound.accuracy.of_bars.causes import PulseInBar, causes_of_bar
from dembound.accuracy.of_bars.options import bar_choices
from dembound.accuracy.of_bars.search import advice_for_bar
from dembound.accuracy.proposal import Advice, Request, Watch
from dembound.accuracy.runner import STEP_AND_END, Run
from dembound.bar.scene import BarScene, build_bar
from dembound.bar.stability import choose_step, front_of_bar, sources_of_bar
from dembound.casefile.bar.bar import MOST_CELLS, Bar
from dembound.casefile.bar.model import BarCase
from dembound.casefile.model import Case
from dembound.errors import CaseError
from dembound.formulas.cause import Causes
from dembound.formulas.history import History, Motions
from dembound.kinds.bar.kind import SPALL_PLACE, SPALL_TIME
from dembound.motion.endings import monitored
from dembound.motion.paths import plane_needed
from dembound.places import nearest_number
from dembound.results.histories import Quantity
from dembound.schemas import with_changes


def _lengthened(bar: Bar, longer: Mapping[str, float], length: float) -> Bar:
    """A bar of another length (m), its end ranges longer by `longer` (m) if it has ranges."""
    ranges = list(bar.range)
    for side, index in (("left", 0), ("right", -1)):
        if ranges:
            ranges[index] = ranges[index].model_copy(update={"length": ranges[index].length + longer[side]})
    return bar.model_copy(update={"length": length, "range": tuple(ranges)} if ranges else {"length": length})


FINER, MOST = 4, 8
"""Number of its spacings in the finest spacing of all choices: at least, and at most."""


@dataclass(frozen=True)
class Finer:
    """The case of the reference, with a monitor ``node_<number>`` wherever a choice has one; spacing (m), and cells."""

    case: Case
    spacing: float
    cells: int

    def motions(self, run: Run, choice: Run) -> dict[str, History]:
        """Histories at the monitors of a choice, from a run of this case, which may have been extended."""
        nodes = {name: _node(history, self.spacing, self.cells) for name, history in choice.motions.items()}
        return {
            name: replace(run.motions[_name(node)], place=np.array([node * self.spacing, 0.0]))
            for name, node in nodes.items()
        }


def _cells(of_choices: set[int]) -> int:
    """Number of spacings in the length of the bar, given the numbers of the choices."""
    most, common = max(of_choices), math.lcm(*of_choices)
    cells = common * math.ceil(FINER * most / common)
    return cells if cells <= MOST * most else FINER * most


def _node(history: History, spacing: float, cells: int) -> int:
    """Number of the node nearest to a history's place; the last node for histories beyond it."""
    return min(nearest_number(float(history.place[0]) / spacing), cells)


def _name(node: int) -> str:
    return f"node_{node}"


class BarJudge(Judge[BarCase, BarScene]):
    """Errors of bars."""

    from_left_end: ClassVar[Sequence[str]] = (SPALL_PLACE,)
    first_break = SPALL_TIME
    quantities: ClassVar[Sequence[Quantity]] = ("velocity", "displacement", "stress")

    def causes(
        self, case: BarCase, recorded: Motions, time_step: float, work: float, watch: Watch, longest: float | None
    ) -> Causes:
        """Errors of ends, nodes and steps, from the waves of the linear bar."""
        return causes_of_bar(case, recorded, time_step)

    def advise(self, case: BarCase, asked: Request) -> Advice:
        """The cheapest nodes, steps and absorbing ends."""
        return advice_for_bar(case, asked)

    def extended(self, case: BarCase, most: int) -> Extended:
        """The bar with more spacings beyond ends that are neither loaded nor driven."""
        scene = build_bar(case)
        bar, step = case.bar, choose_step(scene)[0]
        moving = movable(case, [load.side for load in case.load])
        front = front_of_bar(scene, step)
        spacing = {side: bar.end(side).length / bar.end(side).cells for side in ("left", "right")}
        targets = monitored(scene) if case.monitor else scene.positions[[0, -1]]
        cells = {"left": 0, "right": 0}
        for side in moving:
            plane = bar.length if side == "right" else 0.0
            needed = plane_needed(side, sources_of_bar(case), targets, front, case.run.duration)
            beyond = needed - plane if side == "right" else plane - needed
            cells[side] = max(0, int(np.ceil(beyond / spacing[side] - 1e-9))) if np.isfinite(beyond) else 0
        count = bar.nodes - 1 + sum(cells.values())
        longer = {side: cells[side] * spacing[side] for side in cells}
        length = bar.length + sum(longer.values()) if bar.range else count * spacing["left"]
        must_not_exceed(count + 1, min(most, MOST_CELLS), f"{length:g} m", case)
        sentence = sentence_of(case, f"the same bar {length:g} m long, {count + 1:,} nodes", moving)
        if not any(cells.values()):
            return Extended(case, sentence, (0.0, 0.0, bar.length, 0.0))
        shift = longer["left"]
        moved = [(monitor, min(monitor.position + shift, length)) for monitor in case.monitor]
        monitors = tuple(monitor.model_copy(update={"position": place}) for monitor, place in moved)
        longer_bar, run = _lengthened(bar, longer, length), same_step(case.run, step)
        larger = replace(case, bar=longer_bar, monitor=monitors, run=run, name=f"{case.name}_extended")
        return Extended(larger, sentence, (shift, 0.0, shift + bar.length, 0.0))

    def exact(self, case: BarCase) -> PulseInBar | None:
        """The exact motion under a pulse at the left end of a bar without attenuation; None for other bars."""
        return PulseInBar.of(case)

    def finer(self, case: BarCase, choices: Sequence[Choice[BarCase]], outcomes: Sequence[Run]) -> Finer:
        """The bar by finite differences at Courant number 1.

        Raises CaseError if the bar would have too many nodes, and for a bar with ranges, whose Courant numbers differ.
        """
        if case.bar.range:
            raise CaseError(["reference: finer is not available for a bar with ranges"], case.name)
        bars = [choice.case.bar for choice in choices]
        cells = _cells({bar.cells for bar in bars if bar.length == case.bar.length})
        spacing = case.bar.length / cells
        nodes = {_node(history, spacing, cells) for outcome in outcomes for history in outcome.motions.values()}
        monitors = [{"name": _name(node), "position": min(node * spacing, case.bar.length)} for node in sorted(nodes)]
        run = {key: value for key, value in case.run.given().items() if key not in STEP_AND_END}
        changes: dict[str, Any] = {"bar.spacing": spacing, "method": {"type": "finite_difference"}}
        changes |= {"run": run | {"courant": 1.0}, "monitor": monitors, "output.history_interval": 0.0}
        changes |= {f"load.{load.name}.nodes": 1 for load in case.load}
        return Finer(with_changes(case, changes), spacing, cells)

    def chart_choices(self, case: BarCase) -> Named:
        """All methods with several spacings."""
        return bar_choices(case)
