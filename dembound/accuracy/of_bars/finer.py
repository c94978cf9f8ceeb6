"""A reference for bars: the same bar by finite differences at Courant number 1, with a finer spacing than all choices.

At Courant number 1 central differences are d'Alembert's solution at the nodes, whatever the spacing, between loaded,
free, held and absorbing ends. With attenuation or a prescribed velocity the error is of second order in the spacing;
the place of the first spall is one of the planes between nodes. Loads act on the last node alone, as in the exact
solution: the nodes over which a case spreads them belong to its method.

Its nodes coincide with those of all choices, if a spacing down to 1/MOST of the finest one allows it, and it records at
the nodes of every choice's monitors, so that no error is due to a monitor at another place.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dembound.accuracy.choice import Choice
from dembound.accuracy.history import History
from dembound.accuracy.runner import STEP_AND_END, Run
from dembound.casefile import Case
from dembound.casefile.bar import BarCase
from dembound.errors import CaseError
from dembound.kinds import with_changes
from dembound.nearest import nearest_number

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


def finer(case: BarCase, choices: Sequence[Choice[BarCase]], outcomes: Sequence[Run]) -> Finer:
    """The reference for choices with these outcomes; case : of the bar, loads and ends.

    Raises CaseError if the bar would have too many nodes, and for a bar with ranges, whose Courant numbers differ.
    """
    if case.bar.range:
        raise CaseError(["reference: finer is not available for a bar with ranges"], case.name)
    bars = [choice.case.bar for choice in choices]
    cells = _cells({bar.cells for bar in bars if bar.length == case.bar.length})
    spacing = case.bar.length / cells
    nodes = {_node(history, spacing, cells) for outcome in outcomes for history in outcome.motions.values()}
    run = {key: value for key, value in case.run.given().items() if key not in STEP_AND_END}
    changes: dict[str, Any] = {
        "bar.spacing": spacing,
        "method": {"type": "finite_difference"},
        "run": {**run, "courant": 1.0},
        "monitor": [{"name": _name(node), "position": min(node * spacing, case.bar.length)} for node in sorted(nodes)],
        "output.history_interval": 0.0,
        **{f"load.{load.name}.nodes": 1 for load in case.load},
    }
    return Finer(with_changes(case, changes), spacing, cells)


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
