"""Choices for a case of disks: for advice in the order of their cost, and for its chart where none are given.

Each choice for advice is built once, as long as the time lasts.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import count
from typing import Any

from dembound.accuracy.choice import COARSER, OWN, Named, is_valid, label, valid
from dembound.accuracy.of_disks.arrangements import changes_to_box, cheapest_box, continuum_beyond, may_be_boxed
from dembound.accuracy.of_disks.law import ElasticTwin
from dembound.accuracy.of_disks.options import Built, DiskOption, Options
from dembound.accuracy.runner import Runner
from dembound.boundaries import Motion
from dembound.casefile.disks import DiskCase
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.scene import DiskScene, build
from dembound.motion.kind import Plan
from dembound.words import percent

LONGEST, PART = 12.0, 0.2
"""CPU seconds after which a search for all bounds ends, or this part of the given run if that is more, as counted: not
measured, so that it finds the same on every machine. Each bound may take what those before have left of its part."""

PER_FACTOR, PER_CHOICE, PER_DISK, PER_STEP = 0.2, 0.1, 8e-6, 5e-8
"""CPU seconds of counting the costs of all choices with disks of one diameter, of building a choice, also one that
cannot run, of building it by disk, and of its companions by particle-step."""

PER_ERROR, PER_SAMPLE = 0.12, 8e-7
"""CPU seconds of finding the error of a choice, and by step of its motion and monitor."""

CUT = f"; the search ended early: it may take {LONGEST:g} s, or {percent(PART)} of the run or of --longest"
"""Note on a choice that does not keep a bound, where the search ended for lack of time."""

HELD = 30_000
"""Most disks of a choice that is kept for other bounds."""

COSTLIEST, AFFORDABLE = 64.0, 60.0
"""Cost up to which choices are tried: so many times that of the given case, as disks of a quarter of the diameter have,
or so many CPU seconds if that is more."""


@dataclass
class Candidates:
    """The choices of a search.

    planned : the case; own_cost : CPU time (s) of its steps. kept : keys that do not change. runner : of companions.
    twin : the case under the elastic law, if that replaces its own. longest : CPU time (s) of steps that a choice may
    have; None: by `COSTLIEST` and `AFFORDABLE`. bounds : their number; begun : of those begun. spent : CPU time, as
    counted, s. was_cut : whether diameters were left out for lack of it.
    waiting : queue by cost: diameters, their choices, and built choices that cost more than others may. made : built
    choices, and None for those that cannot run, by the text of their case and how much farther away their sides are.
    of_given_disks : the error
    of the given disks.
    """

    planned: Plan[DiskScene]
    kept: Sequence[str]
    own_cost: float
    runner: Runner
    twin: ElasticTwin | None = None
    longest: float | None = None
    bounds: int = 1
    bound: float = 0.0
    begun: int = 0
    spent: float = 0.0
    was_cut: bool = False
    waiting: list[tuple[float, int, DiskOption | Built | float]] = field(default_factory=list)
    made: dict[tuple[str, float], Built | None] = field(default_factory=dict)
    of_given_disks: float = 0.0
    _options: dict[float, list[DiskOption]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.options = Options(self.planned, self.bound, self.kept)

    def begin(self, bound: float) -> None:
        """Begin with another error bound."""
        self.options.bound = self.bound = bound
        self.begun, self.was_cut, self._options = self.begun + 1, False, {}

    @cached_property
    def per_error(self) -> float:
        """CPU seconds of finding the error of a choice: the longer the motion at the monitors, the more."""
        return PER_ERROR + PER_SAMPLE * self.planned.steps * len(self.planned.scene.monitors)

    @property
    def most(self) -> float:
        """CPU seconds that the search may have taken after the present bound."""
        return max(LONGEST, PART * max(self.own_cost, self.longest or 0.0)) * max(1, self.begun) / self.bounds

    def affords(self, item: DiskOption | Built) -> bool:
        """Whether the search has time left for a choice."""
        option = option_of(item)
        packing = option.case.packing
        spent = self.spent + self.per_error + PER_STEP * self.runner.work
        if not isinstance(item, Built):
            spent += PER_CHOICE + PER_DISK * packing.about(packing.extent)
        return spent <= self.most

    def by_cost(self) -> Iterator[DiskOption | Built]:
        """Choices by cost; choices with the next smaller disks are only counted when their cost has been reached."""
        factors, least = self.options.factors, 0.0
        most = max(COSTLIEST * self.own_cost, AFFORDABLE) if self.longest is None else self.longest
        self.wait(least, factors.pop(0))
        while self.waiting:
            cost, _, item = heapq.heappop(self.waiting)
            if cost > most:
                return
            if not isinstance(item, float):
                yield item
                continue
            if item == 1.0 or self.spent + PER_FACTOR <= self.most:
                made = self.of(item)
                for each in made:
                    self.wait(each.cost, each)
                least = min((each.cost for each in made), default=least)
            else:
                self.was_cut = True
            if factors:
                self.wait(least, factors.pop(0))

    def wait(self, cost: float, item: DiskOption | Built | float) -> None:
        """Put a choice, or a diameter whose choices are not counted yet, into the queue at its cost."""
        heapq.heappush(self.waiting, (cost, next(self._numbers), item))

    @cached_property
    def _numbers(self) -> Iterator[int]:
        """Numbers by which choices of one cost keep their order."""
        return count()

    def built(self, option: DiskOption | Built) -> Built | None:
        """A choice, built; None if it cannot run."""
        if isinstance(option, Built):
            return option
        key = option.case.text, option.wider
        if key not in self.made:
            built = self.options.build(option)
            packing = option.case.packing
            disks = packing.about(packing.extent) if built is None else built.planned.scene.disk_count
            self.spent += PER_CHOICE + PER_DISK * disks
            if disks > HELD:
                return built
            self.made[key] = built
        return self.made[key]

    def of(self, factor: float) -> list[DiskOption]:
        """Choices with disks of one diameter."""
        own = self.planned.scene.ground.brick.mean_diameter
        if self.twin is not None and not self.twin.holds(factor * own):
            return []
        if factor > 1.0 and self.of_given_disks * factor > self.bound:
            return []
        if factor not in self._options:
            self.spent += PER_FACTOR
            self._options[factor] = self.options.of(factor)
        return self._options[factor]


def option_of(item: DiskOption | Built) -> DiskOption:
    """A choice before it was built."""
    return item.option if isinstance(item, Built) else item


FRACTION = 0.5
"""Factor of the second step fraction."""

EXTENT = ("packing.size", "packing.bricks")
"""Keys of the extent of a scene, which choices keep."""

UNMATCHED = 0.01
"""Relative difference of β from the matched one from which on that is another choice: it reflects half of it."""


def disk_choices(case: DiskCase) -> Named:
    """The case itself, and single changes of it.

    Coarser radii; half the step; matched factors β; each other type for its absorbing sides; the smallest box of disks
    in the ground.
    """
    yield OWN, {}
    for changes in valid(case, (_coarser(case, factor) for factor in COARSER)):
        yield label(case, {key: size for key, size in changes.items() if key not in EXTENT}), changes
    step = "run.safety" if case.run.time_step == "auto" else "run.time_step"
    changes = {step: FRACTION * (case.run.safety if case.run.time_step == "auto" else case.run.time_step)}
    yield label(case, changes), changes
    yield from _matched_factors(case)
    yield from _other_sides(case)


def _coarser(case: DiskCase, factor: float) -> dict[str, Any]:
    """Changes to disks larger by a factor, in the same extent."""
    sizes: dict[str, Any] = {f"packing.{key}": size for key, size in case.packing.scaled(factor).items()}
    if case.packing.bricks is None:
        return sizes
    return sizes | {"packing.size": case.packing.larger(factor)["size"], "packing.bricks": None}


def _matched_factors(case: DiskCase) -> Named:
    """Matched factors β for all sides with other factors, but not for sides where a wave enters, which would change."""
    absorbing = {side: table for side, table in case.boundary.items() if table.factors and table.may_move}
    if not absorbing:
        return
    scene = build(case)
    found = [(side, motion) for side in absorbing for motion in _unmatched(scene, side)]
    sides = " and ".join(dict.fromkeys(side for side, _ in found))
    if found:
        yield f"{sides}, matched β", {f"boundary.{side}.beta_{motion}": "matched" for side, motion in found}


def _unmatched(scene: DiskScene, side: str) -> Iterator[Motion]:
    """Kinds of waves (P, S) for which a side's factor differs from the matched one, nan where the motion is held."""
    for motion, beta in factors_in(scene, side).items():
        matched = homogenised_beta(scene, side, motion)
        if abs(matched - beta) > UNMATCHED * matched:
            yield motion


def _other_sides(case: DiskCase) -> Named:
    """Other types for all absorbing sides without waves, where allowed; types with factors β keep them."""
    absorbing = {side: table for side, table in case.boundary.items() if table.absorbs}
    silent = {side: table for side, table in absorbing.items() if not table.waves}
    springs = {"distance": 0.5 * max(case.packing.extent)}
    tables: dict[str, dict[str, Any]] = {"viscous": {}, "viscoelastic": springs, "free": {}}
    for name, extra in tables.items() if silent else ():
        changes: dict[str, Any] = {}
        for side, table in silent.items():
            factors = {key: value for key, value in table.given().items() if key.startswith("beta_")}
            changes[f"boundary.{side}"] = {"type": name, **extra} | ({} if name == "free" else factors)
        if {table.type for table in silent.values()} != {name} and is_valid(case, changes):
            yield f"{_listed(silent)} {name}", changes
    for sides in (silent, absorbing):  # a continuum beyond the first that allows one; waves enter as in the case
        changes = {f"boundary.{side}": continuum_beyond(table) for side, table in sides.items()}
        if not all(table.is_outside for table in sides.values()) and is_valid(case, changes):
            yield f"{_listed(sides)} outside", changes
            break
    yield from _box(case)


def _box(case: DiskCase) -> Named:
    """The smallest box of disks round holes and loads, if it saves much and all monitors may lie around it."""
    if not may_be_boxed(case) or (best := cheapest_box(build(case))) is None:
        return
    changes = changes_to_box(case, best.box)
    if is_valid(case, changes, build):
        yield "box of {:g} m × {:g} m, outside".format(*changes["packing"]["size"]), changes


def _listed(names: Iterable[str]) -> str:
    """Names as in "left, right and bottom"."""
    *others, last = names
    return f"{', '.join(others)} and {last}" if others else last
