"""Place and time of spalls, from the steps in which bonds broke.

Without a fracture energy a bar is cracked where local damage has reached 0.3; with one it has spalled where all bonds
across a plane have broken.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from dembound.laws.peridynamic import CRACKED, ROUNDING
from dembound.methods.bonds import Bonds


@dataclass(frozen=True)
class Spall:
    """One place where local damage has reached 0.3 (L section 1.2), or where cracks are open.

    time : s, at which this first happened; start : m, range of the cracked nodes at that time; end : m, range of the
    cracked nodes at the end of the run. began : s, when the first bond across the place began to open; None without a
    fracture energy.
    """

    time: float
    start: tuple[float, float]
    end: tuple[float, float]
    began: float | None = None

    @property
    def reached(self) -> float:
        """Time (s) when the bar reached its strength there."""
        return self.time if self.began is None else self.began

    def describe(self) -> dict[str, Any]:
        """The breaks as plain JSON values, rounded to twelve digits."""
        ranges = {"start": self.start, "end": self.end}
        times = {"time": self.time} | ({} if self.began is None else {"began": self.began})
        return {key: _short(time) for key, time in times.items()} | {
            key: [_short(x) for x in ends] for key, ends in ranges.items()
        }


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
    if any(part.fracture.energy > 0.0 for part in bonds.rod.ranges):
        found = list(_open_cracks(bonds, positions, time_step))
    else:
        found = list(_damaged(cracked_since(bonds), positions, time_step))
    return sorted(found, key=lambda spall: spall.time)


def _damaged(since: np.ndarray, positions: np.ndarray, time_step: float) -> Iterator[Spall]:
    """Spalls from the steps (n,) in which nodes became cracked, −1 for never."""
    cracked = np.concatenate([[False], since >= 0, [False]])
    edges = np.flatnonzero(np.diff(cracked))
    for first, last in zip(edges[::2], edges[1::2], strict=True):
        steps, places = since[first:last], positions[first:last]
        at_first = places[steps == steps.min()]
        yield Spall(
            float(steps.min() * time_step),
            (float(at_first.min()), float(at_first.max())),
            (float(places.min()), float(places.max())),
        )


def _open_cracks(bonds: Bonds, positions: np.ndarray, time_step: float) -> Iterator[Spall]:
    """Spalls from the planes across which all bonds have broken; planes closer than the horizon are one spall.

    The material between such planes is shorter than the bonds that broke.
    """
    began, since = opened_planes(bonds)
    planes = np.flatnonzero(since >= 0)
    for group in np.split(planes, np.flatnonzero(np.diff(planes) > max(bonds.horizon, 1)) + 1):
        if len(group) == 0:
            continue
        first = group[since[group] == since[group].min()]
        yield Spall(
            float(since[group].min() * time_step),
            (float(positions[first[0]]), float(positions[first[-1] + 1])),
            (float(positions[group[0]]), float(positions[group[-1] + 1])),
            float(began[group].min() * time_step),
        )


def opened_planes(bonds: Bonds) -> tuple[np.ndarray, np.ndarray]:
    """Steps (n − 1,) in which the first bond across each plane began to open, and in which the last one broke.

    Planes without such bonds have −1.
    """
    opening = bonds.opening
    length = np.maximum(opening["row"] + 1, 1)
    broken = opening.of(bonds.spring_broken, bonds.bond_broken)
    began, since = np.full(bonds.rod.count - 1, np.iinfo(np.int64).max), np.full(bonds.rod.count - 1, -1)
    for k in range(length.max(initial=0)):
        across = length > k
        np.minimum.at(began, opening["first"][across] + k, opening["began"][across])
        np.maximum.at(since, opening["first"][across] + k, broken[across])
    whole = bonds.springs & (bonds.spring_broken < 0)
    holding = np.concatenate([whole, [False]]).astype(np.int64)
    for p, row in enumerate(bonds.laid & (bonds.bond_broken < 0), start=1):
        holding += np.convolve(row, np.ones(p, dtype=np.int64))[: len(holding)]
    since[holding[:-1] > 0] = -1
    return np.where(began > opening["began"].max(initial=0), -1, began), since


def crack_strain_rates(bonds: Bonds) -> dict[str, float] | None:
    """Strain rates (1/s), the slowest and the fastest, of bonds that have broken.

    The result is None without a rate-dependent strength.
    """
    broken = bonds.opening.of(bonds.spring_broken, bonds.bond_broken) >= 0
    if not bonds.opening.has_rates or not broken.any():
        return None
    rates = bonds.opening["rate"][broken]
    return {"slowest": float(rates.min()), "fastest": float(rates.max())}


def breaks_at_ends(found: Sequence[Spall], ends: Mapping[str, float]) -> dict[str, Spall]:
    """Breaks that began at an end whose node is held: there the bar has come off its support and did not spall.

    ends : side -> place (m) of those ends.
    """
    return {side: spall for spall in found for side, place in ends.items() if place in spall.start}
