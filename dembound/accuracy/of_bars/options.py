"""The choices that a case of a bar leaves open: nodes, steps and ends that absorb, each with its predicted time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from dembound.accuracy.choice import changed
from dembound.accuracy.differences import keeps
from dembound.bar import step_cost
from dembound.bar.banded import ROUNDING
from dembound.bar.scene import BarScene, build_bar
from dembound.bar.stability import own_step, unit_step
from dembound.casefile.bar import BarCase
from dembound.errors import DemboundError

FACTORS = (4.0, 3.0, 2.5, 2.0, 5 / 3, 1.5, 4 / 3, 1.25, 1.0, 0.8, 2 / 3, 0.5, 0.4, 1 / 3, 0.25, 0.2, 1 / 6, 0.125)
"""Spacings over the given ones that are tried, if all ranges are a whole number of them long."""

SHARES = (0.9, 0.99)
"""Shares of the stability limit that are tried as steps."""

LAYERS = (20, 40, 80)
"""Numbers of nodes in matched layers that are tried."""

STEP_KEYS = ("time_step", "safety", "courant")
"""Keys of ``[run]`` that determine the step."""

Changes = dict[str, Any]


@dataclass(frozen=True)
class BarOption:
    """A choice.

    scene : of the case. step : s, steps : of the run. ends, method : these in words. cost : predicted CPU time of the
    steps, s.
    """

    scene: BarScene
    step: float
    changes: Changes
    ends: str
    method: str

    @property
    def words(self) -> str:
        """The choice in words."""
        return f"{self.ends}{self.method}, nodes every {self.spacing:.4g} m, steps of {self.step:.4g} s"

    @property
    def spacing(self) -> float:
        """Distance of the nodes, m."""
        return self.scene.case.bar.spacing

    @property
    def courant(self) -> float:
        """The Courant number, in the range where it is largest."""
        return self.step / unit_step(self.scene)

    @property
    def steps(self) -> int:
        """Number of steps of the run."""
        return max(1, math.ceil(self.scene.case.run.duration / self.step - 1e-9))

    @cached_property
    def cost(self) -> float:
        """Predicted CPU time of the steps, s."""
        return 1e-9 * self.steps * step_cost.of_bar(self.scene)

    def case(self, given: BarCase) -> BarCase:
        """The case of the choice."""
        return changed(given, self.changes)


def bar_options(case: BarCase, kept: Sequence[str]) -> Iterator[BarOption]:
    """All choices that keep the values of some keys, those with fewer changes first; none that cannot run."""
    breaks = may_break(case)
    for ends, of_ends in _ends(case, kept):
        for method, of_method in _methods(case) if not breaks else [("", Changes())]:
            for factor in sorted(FACTORS, key=lambda each: each != 1.0) if not breaks else [1.0]:
                changes = of_ends | of_method | _spacings(case, factor)
                yield from _stepped(case, changes, (ends, method), kept)


def may_break(case: BarCase) -> bool:
    """Whether bonds may change, after which nodes and method are part of what happens."""
    return math.isfinite(case.bar.least_strength)


def _ends(case: BarCase, kept: Sequence[str]) -> Iterator[tuple[str, Changes]]:
    """What may stand in for more of the bar, in words and as changes; all ends alike that are not kept."""
    yield "ends as given", {}
    free = [side for side, table in case.boundary.items() if table.is_artificial and not _is_kept(side, kept)]
    if not free:
        return
    where = " and ".join(free)
    waves = {side: {f"wave_{motion}": name for motion, name in case.side(side).waves.items()} for side in free}
    kinds = {side: "viscous_input" if waves[side] else "viscous" for side in free}
    dashpots = {side: {"type": kinds[side], **waves[side]} for side in free}
    if any(case.side(side).given() != table for side, table in dashpots.items()):
        yield f"dashpots at {where}", {f"boundary.{side}": table for side, table in dashpots.items()}
    for nodes in LAYERS:
        layers = {f"boundary.{side}": {"type": "matched_layer", "nodes": nodes, **waves[side]} for side in free}
        yield f"matched layers of {nodes} nodes at {where}", layers


def _is_kept(side: str, kept: Sequence[str]) -> bool:
    """Whether the table of an end, or a key of it, is kept."""
    return any(key == "boundary" or f"{key}.".startswith(f"boundary.{side}.") for key in kept)


def _methods(case: BarCase) -> Iterator[tuple[str, Changes]]:
    """The method as given, and with corrected ends."""
    yield "", {}
    if case.method.soft_ends and "corrected_ends" in type(case.method).model_fields:
        yield ", corrected ends", {"method.corrected_ends": True}


def _spacings(case: BarCase, factor: float) -> Changes:
    """Spacings of the bar and of its ranges, larger by a factor."""
    if factor == 1.0:
        return {}
    own = {"bar.spacing": case.bar.spacing}
    own |= {f"bar.range.{each.name}.spacing": each.spacing for each in case.bar.range if each.spacing is not None}
    return {key: float(f"{factor * spacing:.12g}") for key, spacing in own.items()}


def _stepped(case: BarCase, changes: Changes, words: tuple[str, str], kept: Sequence[str]) -> Iterator[BarOption]:
    """Choices with several time steps for the nodes that changes give; words : of the ends and of the method."""
    try:
        other = changed(case, changes)
        scene = build_bar(other)
    except DemboundError:
        return
    limit = scene.step_limit()
    steps: dict[float, Changes] = {own_step(scene, limit): {}}
    others = {key: value for key, value in case.run.given().items() if key not in STEP_KEYS}
    unit = unit_step(scene)
    for step, key, value in [(unit, "courant", 1.0), *((share * limit, "safety", share) for share in SHARES)]:
        steps.setdefault(step, {"run": others | {key: value}})
    for step, of_step in steps.items():
        choice = changes | of_step
        is_valid = step <= min(limit * (1.0 + ROUNDING), other.run.duration)
        if is_valid and (not kept or keeps(case, changed(case, choice), kept)):
            yield BarOption(scene, step, choice, *words)
