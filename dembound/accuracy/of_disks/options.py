"""The choices that a case of disks leaves open, each with its cost, which is counted without building it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from dembound.accuracy.choice import keeps
from dembound.accuracy.of_disks.arrangements import arrangements, may_widen
from dembound.accuracy.of_disks.companions import farther, needed_by
from dembound.accuracy.of_disks.cost import Counted, planned_cost
from dembound.accuracy.of_disks.enlarged import enlarged
from dembound.boundaries import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.material.layered import materials_in
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.scene import DiskScene, ground_of
from dembound.disks.supports import forces_of
from dembound.errors import CaseError, DemboundError
from dembound.kinds import checked, with_changes
from dembound.motion.kind import Plan
from dembound.running import plan

FACTORS = (
    *(5.0, 4.0, 3.0, 2.5, 2.0, 5 / 3, 1.5, 4 / 3, 1.25, 1.0),
    *(0.8, 2 / 3, 0.5, 0.4, 1 / 3, 0.25, 0.2, 1 / 6, 0.125, 0.1, 1 / 12, 1 / 15, 0.05, 1 / 30, 0.025),
)
"""Diameters of a lattice over the given one that are tried, if the scene is made of whole cells of this size."""

SHORTER = (1.0, 0.5, 0.25)
"""Time steps over the longest one that are tried where disks remain, whose step would be shorter were they smaller."""

WIDER = (0.25, 0.5, 1.0, 2.0, 3.0, 4.0)
"""How much farther away sides with dashpots may be, over the length of the scene across them."""

NARROW = 10.0
"""Fewest larger disks across a body between free edges."""

ROTATION = 2
"""Number of the rotation among the motions that are held."""

SIZES = frozenset(("packing", "packing.size", "packing.origin", "packing.bricks"))
"""Keys that sides farther away change."""

ROUNDING = 1e-9
"""Part of a brick by which a length may differ from whole ones."""

EQUAL = 1e-6
"""Relative difference of forces, and of stiffnesses, that count as equal."""


@dataclass(frozen=True)
class DiskOption:
    """A choice before it is built.

    case : with sides in place, in the `arrangement` of this name; `wider` : whether they are to be moved outwards.
    factor, shorter : its diameter and its time step over those given. cost : counted CPU seconds of the steps.
    """

    case: DiskCase
    arrangement: str
    factor: float
    wider: float
    cost: float
    shorter: float = 1.0

    @property
    def words(self) -> str:
        """The choice in words."""
        wider = f", {self.wider:g} times the scene farther away" if self.wider else ""
        shorter = f", steps {self.shorter:g} times as long" if self.shorter != 1.0 else ""
        return f"{self.arrangement}{wider}, disks of {2.0 * self.case.packing.radius:.4g} m{shorter}"


@dataclass(frozen=True)
class Built:
    """A choice that can run.

    case : with its sides moved outwards if wider. planned : with sides in place. cost : CPU time of the steps by this
    plan, s.
    """

    option: DiskOption
    case: DiskCase
    planned: Plan[DiskScene]
    cost: float


@dataclass
class Options:
    """The choices of a case.

    given : the case, planned. bound : error bound. kept : keys that do not change.
    """

    given: Plan[DiskScene]
    bound: float
    kept: Sequence[str]

    @property
    def factors(self) -> list[float]:
        """Diameters over the given one that are tried, the largest first."""
        return list(FACTORS) if self._may_change_diameter else [1.0]

    @cached_property
    def own(self) -> DiskOption:
        """The given case."""
        return DiskOption(self._case, "sides as given", 1.0, 0.0, planned_cost(self.given).seconds)

    def of(self, factor: float) -> list[DiskOption]:
        """The choices with disks of one diameter; none if the case does not allow it, or its tables have mistakes."""
        if (found := self._with_diameter(factor)) is None:
            return []
        case, ground = found
        return [
            replace(each, shorter=shorter)
            for shorter in self._shorter
            for arrangement in arrangements(_with_step(case, shorter), ground, self.bound)
            for each in self._each(arrangement.case, arrangement.name, factor, may_widen(arrangement))
        ]

    def build(self, option: DiskOption) -> Built | None:
        """A choice, built and planned; None if it cannot run, or changes a kept key or the total forces of loads."""
        try:
            planned: Plan[DiskScene] = plan(option.case)
            case = planned.scene.case
            if option.wider:
                case = self._wider(planned.scene, option.wider)
        except DemboundError:
            return None
        if not _same_forces(self.given.scene, planned.scene) or not keeps(self._case, case, self.kept):
            return None
        return Built(option, case, planned, planned_cost(planned).seconds * _area(case) / _area(planned.scene.case))

    @property
    def _case(self) -> DiskCase:
        return self.given.scene.case

    @cached_property
    def _may_change_diameter(self) -> bool:
        """Whether disks only discretise the ground, on a lattice under a linear law, and their radius is not kept."""
        case = self._case
        sizes = {"packing", *(f"packing.{key}" for key in case.packing.scaled(1.0))}
        return case.packing.is_lattice and LAWS[case.material.law].is_linear and sizes.isdisjoint(self.kept)

    @cached_property
    def _shorter(self) -> Sequence[float]:
        """Time steps over that of the case's tables that are tried."""
        kept = {"run", "run.safety", "run.time_step"}
        return (1.0,) if self._may_change_diameter or not kept.isdisjoint(self.kept) else SHORTER

    def _with_diameter(self, factor: float) -> tuple[DiskCase, PackedMaterial] | None:
        """The given case with another diameter, and its ground; None if its scene cannot be made of such disks."""
        if factor == 1.0:
            return self._case, self.given.scene.ground
        try:
            case = with_changes(self._case, {"packing": self._case.packing.larger(factor)})
            ground = ground_of(case)
        except DemboundError:
            return None
        if (factor > 1.0 and _is_narrow(case, ground)) or not _same_ground(self.given.scene.ground, ground):
            return None
        return case, ground

    def _each(self, case: DiskCase, arrangement: str, factor: float, wider: bool) -> Iterator[DiskOption]:
        """Options of a case with its sides in place, and, if allowed, farther away, up to where nothing returns."""
        try:
            cost = self._counted.of(case).seconds
        except CaseError:  # no mesh
            return
        if keeps(self._case, case, self.kept):
            yield DiskOption(case, arrangement, factor, 0.0, cost)
        last = case.packing.copies
        for more in WIDER if wider and SIZES.isdisjoint(self.kept) else ():
            copies = self._copies(case, more)
            if copies == last:
                return
            last, (across, up) = copies, case.packing.copies
            yield DiskOption(case, arrangement, factor, more, cost * copies[0] * copies[1] / (across * up))

    def _copies(self, case: DiskCase, wider: float) -> tuple[int, int]:
        """Numbers of bricks along x and y with sides moved outwards by `wider` of the length."""
        copies, brick = list(case.packing.copies), case.packing.brick_size
        moving = [side for side in self._needed if side in case.boundary and case.boundary[side].may_move]
        most = {side: math.ceil(self._needed[side] / brick[normal_axis(side)] - ROUNDING) for side in moving}
        for side, count in farther(case.packing, most, wider).items():
            copies[normal_axis(side)] += count
        return copies[0], copies[1]

    @cached_property
    def _needed(self) -> Mapping[str, float]:
        """By side that may move, distance (m) by which it must move so that nothing returns, for disks of all sizes."""
        brick = self._case.packing.brick_size
        return {side: count * brick[normal_axis(side)] for side, count in needed_by(self.given.scene).items()}

    @cached_property
    def _counted(self) -> Counted:
        return Counted(self.given)

    def _wider(self, scene: DiskScene, wider: float) -> DiskCase:
        """The case of a scene with sides farther away, up to where nothing returns; CaseError if that is invalid."""
        own = scene.case
        case = enlarged(scene, farther(own.packing, needed_by(scene), wider))
        places = {"size": case.packing.extent, "origin": case.packing.origin}
        rounded = {key: tuple(round(length, 10) for length in lengths) for key, lengths in places.items()}
        packing = case.packing.model_copy(update={**rounded, "bricks": None})
        return checked(replace(case, packing=packing, run=own.run, name=own.name))


def _with_step(case: DiskCase, shorter: float) -> DiskCase:
    """A case with its automatic or given time step times `shorter`."""
    key = "safety" if case.run.time_step == "auto" else "time_step"
    return case if shorter == 1.0 else with_changes(case, {f"run.{key}": shorter * getattr(case.run, key)})


def _area(case: DiskCase) -> float:
    """Area (m²) of the disks' box."""
    return case.packing.extent[0] * case.packing.extent[1]


def _is_narrow(case: DiskCase, ground: PackedMaterial) -> bool:
    """Whether a body is so narrow that its stiffness depends on its disks, as those of free edges turn more easily."""
    if ROTATION in ground.held:
        return False
    across = [length for axis, length in enumerate(case.size) if not case.periodic[axis]]
    return min(across, default=np.inf) < NARROW * ground.brick.mean_diameter


def _same_ground(given: PackedMaterial, ground: PackedMaterial) -> bool:
    """Whether disks of another size make a ground of the same stiffness, which not every law ensures."""
    own, other = (np.array([each.material_tensor for each in materials_in(one)]) for one in (given, ground))
    return np.allclose(own, other, rtol=0.0, atol=EQUAL * np.abs(own).max(axis=(1, 2), keepdims=True))


def _same_forces(given: DiskScene, scene: DiskScene) -> bool:
    """Whether loads have the same total forces, which prescribed accelerations of disks ensure on no lattice."""
    for load in given.case.load:
        if load.acceleration is None or load.is_everywhere:
            continue
        own, other = (forces_of(load, each)[1][:, :2].sum(axis=0) for each in (given, scene))
        if not np.allclose(own, other, rtol=EQUAL, atol=0.0):
            return False
    return True
