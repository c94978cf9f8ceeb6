"""Place and time of spalls, from the steps in which bonds broke."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dembound.laws.peridynamic import CRACKED, ROUNDING
from dembound.methods.bonds import Bonds


@dataclass(frozen=True)
class Spall:
    """One place where local damage has reached 0.3 (L section 1.2).

    time : s, at which this first happened; start : m, range of the cracked nodes at that time; end : m, their range at
    the end of the run.
    """

    time: float
    start: tuple[float, float]
    end: tuple[float, float]

    def describe(self) -> dict[str, Any]:
        """As plain JSON values, rounded to twelve digits; further digits are rounding errors of steps and spacings."""
        ranges = {"start": self.start, "end": self.end}
        return {"time": _short(self.time)} | {key: [_short(x) for x in ends] for key, ends in ranges.items()}


def _short(value: float) -> float:
    """A number rounded to twelve digits."""
    return float(f"{value:.12g}")


def cracked_since(bonds: Bonds) -> np.ndarray:
    """Step (n,) in which the damage of each node reached 0.3; −1 where it did not.

    Next to a crack, damage is often exactly 0.3, so rounding errors are allowed for in the comparison.
    """
    since = np.full(bonds.rod.count, -1)
    for step in np.unique(bonds.breaks(0)[0]):
        reached = (bonds.damage(int(step)) >= CRACKED - ROUNDING) & (since < 0)
        since[reached] = step
    return since


def spalls(bonds: Bonds, positions: np.ndarray, time_step: float) -> list[Spall]:
    """Every spall of a bar in order of time; positions (n,) m of its nodes, time_step s."""
    since = cracked_since(bonds)
    cracked = np.concatenate([[False], since >= 0, [False]])
    edges = np.flatnonzero(np.diff(cracked))
    found = []
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        steps, places = since[first:last], positions[first:last]
        at_first = places[steps == steps.min()]
        found.append(
            Spall(
                float(steps.min() * time_step),
                (float(at_first.min()), float(at_first.max())),
                (float(places.min()), float(places.max())),
            )
        )
    return sorted(found, key=lambda spall: spall.time)


def breaks_at_ends(found: Sequence[Spall], ends: Mapping[str, float]) -> dict[str, Spall]:
    """Those that began at an end whose node is held: the bar has come off there, and no piece has off the bar.

    ends : side -> place (m) of those ends.
    """
    return {side: spall for spall in found for side, place in ends.items() if place in spall.start}
