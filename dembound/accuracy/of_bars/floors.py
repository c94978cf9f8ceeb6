"""Lower bounds of the errors of choices for a bar, from errors of others, so that most need not be computed.

Two rules, for choices with the same method and Courant number:

- Spacings. Errors of nodes, steps and ends fall with the square of the spacing at most, as all schemes of bars are of
  second order. So an error e at the spacing Δx is at least e (Δx'/Δx)² at a finer Δx'; coarser nodes are not better.
- Ends. Until something may come back from an absorbing end, ends of all kinds move alike. The error until then follows
  the rule of spacings with any ends, and with coarser nodes it is at least as large.

Two kinds of errors vary otherwise and are left out: at monitors that are not at nodes, and near the Courant number at
which nodes do not disperse waves, where only errors of corners of waves remain, which may coincide with steps. The
error of an endless bar is no lower bound: where a wave enters, errors of ends and nodes may have opposite signs.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

import numpy as np

from dembound.accuracy.of_bars.motions import AT_PLACE
from dembound.accuracy.of_bars.options import BarOption
from dembound.bar.layers import ENDS
from dembound.bar.scene import BarScene
from dembound.methods.rod import Range

MARGIN = 2.0
"""Factor by which rules for finer nodes and other ends may be wrong: 1.31 of all pairs of choices for 40 bars with
nodes up to four times as far apart as given, 1.64 with up to 32 times (benchmarks/error_bound_bars.py --every)."""

DISPERSES = 0.95
"""Square of the Courant number, over that at which waves are not dispersed, above which the rules are not used."""

Kind = tuple[str, ...]


class Floors:
    """Lower bounds of the errors of choices."""

    def __init__(self) -> None:
        self._known: dict[Kind, list[tuple[float, float]]] = defaultdict(list)

    def add(self, choice: BarOption, error: float, without_echo: float) -> None:
        """Add a choice whose error is known; without_echo : its error before `first_echo`."""
        for kind, size in zip(_kinds(choice), (error, without_echo), strict=True):
            self._known[kind].append((choice.spacing, size))

    def of(self, choice: BarOption) -> float:
        """Lower bound of the error of a choice; 0 where no bound is known."""
        same, alike = (self._known[kind] for kind in _kinds(choice))
        finer = [error * (choice.spacing / at) ** 2 / MARGIN for at, error in same if choice.spacing <= at]
        coarser = [error for at, error in same if choice.spacing > at]
        others = [error * min(1.0, choice.spacing / at) ** 2 / MARGIN for at, error in alike]
        return max([*finer, *coarser, *others], default=0.0)


def _kinds(choice: BarOption) -> tuple[Kind, Kind]:
    """Keys of the choices that are comparable: with the same ends, and with any ends."""
    same = choice.method, f"{choice.courant:.2f}"
    return (choice.ends, *same), same


def is_regular(choice: BarOption, places: Mapping[str, float]) -> bool:
    """Whether the rules hold for finer and coarser nodes than those of a choice; places : m, by monitor."""
    scene, rod = choice.scene, choice.scene.rod
    away = max(abs(float(scene.positions[scene.monitors[name], 0]) - place) for name, place in places.items())
    return away <= AT_PLACE * rod.ranges[-1].end and all(
        (choice.step * part.speed / part.spacing) ** 2 < DISPERSES * without for part, without in _undispersed(scene)
    )


def _undispersed(scene: BarScene) -> Iterator[tuple[Range, float]]:
    """Ranges, each with the square of the Courant number ν at which waves do not disperse.

    Of shares φ_p of the stress that bonds of p spacings carry, long waves lag by (kΔx)²(Σφ_p p² − ν²)/24; Σφ_p p² is 1
    for finite differences and (m² + 1)/2 for L's bonds (L eq. 12).
    """
    bonds = scene.case.method.begin(scene.rod)
    for part in scene.rod.ranges:
        if part.cells > 2 * bonds.horizon:
            shares = np.array(bonds.shares(part))
            yield part, float(shares @ np.arange(1, len(shares) + 1) ** 2)


def first_echo(scene: BarScene) -> dict[str, float]:
    """By monitor the time (s) at which a wave may first come back from an absorbing end; infinite without one."""
    case, rod = scene.case, scene.rod
    ends = {"left": 0, "right": rod.count - 1}
    pushed = {ends[side] for side in case.driving}
    for load in case.load:
        pushed |= {0, load.nodes - 1} if load.side == "left" else {rod.count - load.nodes, rod.count - 1}
    returning = [ends[side] for side in ENDS if case.side(side).is_artificial]
    found = {}
    for name, node in scene.monitors.items():
        ways = [_time(scene, start, end) + _time(scene, end, node) for start in pushed for end in returning]
        found[name] = min(ways, default=np.inf)
    return found


def _time(scene: BarScene, first: int, last: int) -> float:
    """Travel time (s) of waves from one node to another."""
    low, high = sorted((first, last))
    return sum(
        max(0, min(high, part.last) - max(low, part.first)) * part.spacing / part.speed for part in scene.rod.ranges
    )
