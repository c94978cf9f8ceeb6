"""The choices that a case of a bar leaves open: nodes, steps and ends that absorb, each with its cost."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, get_args

from dembound.accuracy.choice import COARSER, OWN, Named, changed, keeps, label, valid
from dembound.bar import stability
from dembound.bar.body import ROUNDING
from dembound.bar.scene import BarScene, build_bar
from dembound.bar.stability import is_bounded_at_limit, own_step, unit_step
from dembound.casefile.bar.model import BarCase
from dembound.errors import DemboundError
from dembound.methods.finite_difference import FiniteDifference
from dembound.methods.method import Method
from dembound.methods.patch import Patch
from dembound.methods.peridynamics import Peridynamics
from dembound.methods.switch import Switch
from dembound.words import with_unit

COARSER_NODES = (32.0, 24.0, 16.0, 12.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.5, 2.0, 5 / 3, 1.5, 4 / 3, 1.25)
FACTORS = (1.0, *COARSER_NODES, 0.8, 2 / 3, 0.5, 0.4, 1 / 3, 0.25, 0.2, 1 / 6, 0.125, 0.1)
"""Spacings over the given ones that are tried: the nearest that divide their ranges, and that have nodes at monitors.
"""

MOST_PARTS = 200
"""Largest number of equal parts of a range that is looked for, so that all its monitors are between two of them."""

AT_NODE = 1e-6
"""Distance of a monitor from a node that is none, over the spacing."""

SHARES = (0.9, 0.99)
"""Shares of the stability limit that are tried as steps."""

LAYERS = (20, 40, 80)
"""Numbers of nodes in matched layers that are tried."""

GIVEN_ENDS = "ends as given"
"""Words of ends that do not change."""

STEP_KEYS = ("time_step", "safety", "courant")
"""Keys of ``[run]`` that determine the step."""

Changes = dict[str, Any]


@dataclass(frozen=True)
class BarOption:
    """A choice of nodes, time step, ends and method of a bar.

    scene : of the case. step : s, steps : of the run. ends, method : in words. cost : predicted CPU time of the steps,
    s.
    """

    scene: BarScene
    step: float
    changes: Changes
    ends: str
    method: str

    @property
    def words(self) -> str:
        """The choice in words."""
        ranges = self.scene.rod.ranges
        spacings = " and ".join(dict.fromkeys(with_unit(part.spacing, "m") for part in ranges))
        return f"{self.ends}{self.method}, nodes every {spacings}, steps of {with_unit(self.step, 's')}"

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
        return 1e-9 * self.steps * stability.time_per_step(self.scene)

    def case(self, given: BarCase) -> BarCase:
        """The case of the choice."""
        return changed(given, self.changes)


def bar_options(case: BarCase, kept: Sequence[str]) -> Iterator[BarOption]:
    """All runnable choices that keep the values of the keys `kept`, those with fewer changes first."""
    if may_break(case):
        yield from _options(case, kept, [("", {})], [{}])
        return
    methods, spacings = list(_methods(case)), _spacings(case)
    if _moves_alike(case, kept):  # other nodes with finite differences only
        yield from _options(case, kept, methods[:1], [{}])
        methods = methods[-1:]
    yield from _options(case, kept, methods, spacings)


def other_options(case: BarCase, kept: Sequence[str]) -> Iterator[BarOption]:
    """Finite-difference choices for a bar that may break, which would break differently; otherwise as `bar_options`."""
    return _options(case, kept, [_differences(case)], _spacings(case))


def _options(
    case: BarCase, kept: Sequence[str], methods: Sequence[tuple[str, Changes]], spacings: Sequence[Changes]
) -> Iterator[BarOption]:
    """Choices with all ends and steps for some methods (words and changes) and some spacings."""
    for ends, of_ends in _ends(case, kept):
        for method, of_method in methods:
            for spacing in spacings:
                yield from _stepped(case, of_ends | of_method | spacing, (ends, method), kept)


def may_break(case: BarCase) -> bool:
    """Whether bonds may change; then nodes and method affect how the bar breaks."""
    return math.isfinite(case.bar.least_strength)


def _moves_alike(case: BarCase, kept: Sequence[str]) -> bool:
    """Whether finite differences are allowed and move the bar as its method does, as it cannot break."""
    if isinstance(case.method, FiniteDifference) or any(f"{key}.".startswith("method.") for key in kept):
        return False
    return not case.method.begin(build_bar(case).rod).bond.any()


def _ends(case: BarCase, kept: Sequence[str]) -> Iterator[tuple[str, Changes]]:
    """Types of absorbing ends, in words and as changes; all ends that are not kept get the same type."""
    yield GIVEN_ENDS, {}
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
    """The method as given, with corrected ends, and finite differences with loads on the last node."""
    yield "", {}
    if case.method.soft_ends and "corrected_ends" in type(case.method).model_fields:
        yield ", corrected ends", {"method.corrected_ends": True}
    if (differences := _differences(case))[1]:
        yield differences


def _differences(case: BarCase) -> tuple[str, Changes]:
    """Finite differences with loads on the last node, as on a bar without nodes; no changes if so given."""
    changes: Changes = {f"load.{load.name}.nodes": 1 for load in case.load if load.nodes > 1}
    words = ", loads on the last node" if changes else ""
    if isinstance(case.method, FiniteDifference):
        return words, changes
    return f", finite differences{words}", changes | {"method": {"type": "finite_difference"}}


def _spacings(case: BarCase) -> list[Changes]:
    """Spacings near `FACTORS` times the given ones, which come first; for several ranges also equal travel times."""
    parts = case.bar.parts
    unit = min(part.length / part.cells / part.speed for part in parts)
    given = [part.length / part.cells for part in parts]
    requested = [[factor * spacing for spacing in given] for factor in FACTORS]
    if len(parts) > 1:
        requested += [[factor * unit * part.speed for part in parts] for factor in FACTORS]
    found = [_near(case, each, at_monitors) for each in requested for at_monitors in (True, False)]
    return [each for number, each in enumerate(found) if each not in found[:number]]


def _near(case: BarCase, requested: Sequence[float], at_monitors: bool) -> Changes:
    """The spacings nearest to the requested ones (m, by range) that divide their ranges.

    at_monitors : with a node at every monitor.
    """
    bar = case.bar
    keys = [f"bar.range.{each.name}.spacing" for each in bar.range] or ["bar.spacing"]
    changes: Changes = {}
    for key, part, start, spacing in zip(keys, bar.parts, bar.starts, requested, strict=True):
        given = part.length / part.cells
        if math.isclose(spacing, given, rel_tol=AT_NODE):
            continue
        places = [each.position - start for each in case.monitor if start <= each.position <= start + part.length]
        least = _equal_parts(part.length, places) if at_monitors else 1
        changes[key] = float(f"{part.length / (least * max(1, round(part.length / spacing / least))):.15g}")
    return changes


def _equal_parts(length: float, places: Sequence[float]) -> int:
    """The smallest number of equal parts of a length (m) with borders at all places (m); 1 if it is too large."""
    for count in range(1, MOST_PARTS + 1):
        steps = [place / length * count for place in places]
        if all(abs(step - round(step)) <= AT_NODE for step in steps):
            return count
    return 1


def _stepped(case: BarCase, changes: Changes, words: tuple[str, str], kept: Sequence[str]) -> Iterator[BarOption]:
    """Choices with several time steps for given changes; words : of the ends and of the method."""
    try:
        other = changed(case, changes)
        scene = build_bar(other)
    except DemboundError:
        return
    limit = scene.step_limit()
    steps: dict[float, Changes] = {own_step(scene, limit): {}}
    others = {key: value for key, value in case.run.given().items() if key not in STEP_KEYS}
    at_one = [(unit_step(scene), "courant", 1.0)] * is_bounded_at_limit(scene)
    for step, key, value in [*at_one, *((share * limit, "safety", share) for share in SHARES)]:
        steps.setdefault(step, {"run": others | {key: value}})
    for step, of_step in steps.items():
        choice = changes | of_step
        is_valid = step <= min(limit * (1.0 + ROUNDING), other.run.duration)
        if is_valid and (not kept or keeps(case, changed(case, choice), kept)):
            yield BarOption(scene, step, choice, *words)


HORIZON = 3
"""Horizon of bars' methods where the case has none."""


def bar_choices(case: BarCase) -> Named:
    """The case itself, every method with every spacing at its automatic step, and finite differences at ν = 1.

    A given step is dropped, as it would suit one method and spacing only.
    """
    yield OWN, {}
    spacing, run = case.bar.spacing, case.run.given()
    coarser = [change["bar.spacing"] for change in valid(case, ({"bar.spacing": k * spacing} for k in COARSER))]
    automatic = {key: value for key, value in run.items() if key not in ("time_step", "courant") or value == "auto"}
    exact = {key: value for key, value in run.items() if key not in STEP_KEYS} | {"courant": 1.0}
    differences = _method(case, FiniteDifference)
    for size in (spacing, *coarser):
        name = label(case, {"bar.spacing": size, "method": differences, "run.courant": 1.0})
        yield name, {"bar.spacing": size, "method": differences, "run": exact}
        for method in _chart_methods(case):
            changes = {"bar.spacing": size, "method": method}
            yield label(case, changes), changes | ({} if automatic == run else {"run": automatic})


def _chart_methods(case: BarCase) -> Iterator[dict[str, Any]]:
    """The methods to chart; a method of another package that the case uses comes first.

    Methods that wait for a break are included only if the bar can break.
    """
    kinds: list[type[Method]] = [FiniteDifference, Peridynamics]
    if case.bar.least_strength < math.inf:
        kinds += [Switch, Patch]
    if type(case.method) not in kinds:
        yield case.method.given()
    yield from (_method(case, kind) for kind in kinds)


def _method(case: BarCase, kind: type[Method]) -> dict[str, Any]:
    """The table of a method, with the case's values of all keys that both methods have."""
    (name,) = get_args(kind.model_fields["type"].annotation)
    horizon = {"horizon": max(case.method.largest_horizon, HORIZON)} if "horizon" in kind.model_fields else {}
    own = {key: value for key, value in case.method.given().items() if key in kind.model_fields and key != "type"}
    return {"type": name} | horizon | own
