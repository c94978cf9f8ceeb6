"""The choices that a case of disks leaves open, each with the time that it is predicted to take."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from dembound.accuracy.choice import Choice
from dembound.accuracy.differences import keeps
from dembound.accuracy.of_disks.arrangements import arrangements, may_widen
from dembound.accuracy.of_disks.companions import Companions, needed_by
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks import step_cost
from dembound.disks.loads import forces_of
from dembound.disks.scene import DiskScene
from dembound.errors import DemboundError
from dembound.kinds import checked, with_changes
from dembound.motion.kind import Plan
from dembound.running import plan

FACTORS = (5.0, 4.0, 3.0, 2.5, 2.0, 5 / 3, 1.5, 4 / 3, 1.25, 1.0, 0.8, 2 / 3, 0.5, 0.4, 1 / 3, 0.25)
"""Diameters of a lattice over the given one that are tried, if the scene is made of whole cells of this size."""

WIDER = (0.25, 0.5, 1.0, 2.0)
"""How much farther away sides with dashpots may be, over the length of the scene across them."""

NARROW = 10.0
"""Fewest larger disks across a body between free edges."""

ROTATION = 2
"""Number of the rotation among the motions that are held."""

EQUAL = 1e-6
"""Relative difference of forces, and of stiffnesses, that count as equal."""


@dataclass(frozen=True)
class DiskOption:
    """A choice.

    case : of the choice. planned : with its sides where they are in `arrangement`, if they are `wider`, too. factor :
    its diameter over that given. cost : predicted CPU time of the steps, s.
    """

    case: DiskCase
    planned: Plan[DiskScene]
    arrangement: Choice[DiskCase]
    factor: float
    wider: float
    cost: float

    @property
    def scene(self) -> DiskScene:
        """The scene that is planned."""
        return self.planned.scene

    @cached_property
    def words(self) -> str:
        """The choice in words."""
        diameter = f"disks of {self.scene.ground.brick.mean_diameter:.4g} m"
        wider = f", {self.wider:g} times the scene farther away" if self.wider else ""
        return f"{self.arrangement.name}{wider}, {diameter}"


def cost_of(planned: Plan[DiskScene]) -> float:
    """CPU time of the steps, s."""
    return 1e-9 * planned.steps * sum(step_cost.of_scene(planned.stepped).values())


def with_diameter(companions: Companions, factor: float) -> Plan[DiskScene] | None:
    """The given case with larger or smaller disks, planned; None if it cannot run or its loads have other forces."""
    given = companions.case
    try:
        case = given if factor == 1.0 else with_changes(given, {"packing": _larger(given, factor)})
        planned: Plan[DiskScene] = plan(case)
    except DemboundError:
        return None
    if factor > 1.0 and _is_narrow(planned.scene):
        return None
    same = _same_ground(companions.scene, planned.scene) and _same_forces(companions.scene, planned.scene)
    return planned if same else None


def disk_options(
    companions: Companions, plain: Plan[DiskScene], factor: float, bound: float, kept: Sequence[str]
) -> Iterator[DiskOption]:
    """All choices with disks of one diameter that keep the values of some keys; those that cannot run are left out.

    plain : the plan with the given sides and these disks.
    """
    scene = plain.scene
    for arrangement in arrangements(scene.case, scene, bound):
        planned = _planned(scene.case, arrangement.changes)
        if planned is None:
            continue
        found = DiskOption(planned.scene.case, planned, arrangement, factor, 0.0, cost_of(planned))
        each = [found, *(_wider(found, companions) if may_widen(arrangement) else [])]
        yield from (choice for choice in each if keeps(companions.case, choice.case, kept))


def may_change_diameter(case: DiskCase, kept: Sequence[str]) -> bool:
    """Whether disks only stand for the ground, on a lattice under a linear law, and their radius is not kept."""
    sizes = {"packing", *(f"packing.{key}" for key in case.packing.scaled(1.0))}
    return case.packing.is_lattice and LAWS[case.material.law].is_linear and sizes.isdisjoint(kept)


def _larger(case: DiskCase, factor: float) -> dict[str, Any]:
    """The table of a packing of larger disks in the same place."""
    packing: dict[str, Any] = {key: value for key, value in case.packing.given().items() if key != "bricks"}
    size = [round(length, 10) for length in case.packing.extent]
    sizes = {key: float(f"{length:.12g}") for key, length in case.packing.scaled(factor).items()}
    return packing | {"size": size, **sizes}


def _is_narrow(scene: DiskScene) -> bool:
    """Whether a body is so narrow that its stiffness depends on its disks: those of free edges turn more easily."""
    if ROTATION in scene.ground.held:
        return False
    across = [length for axis, length in enumerate(scene.case.size) if not scene.case.periodic[axis]]
    return min(across, default=np.inf) < NARROW * scene.ground.brick.mean_diameter


def _same_ground(given: DiskScene, scene: DiskScene) -> bool:
    """Whether disks of another size make a ground of the same stiffness, as they need not under any law."""
    own, other = (each.ground.material_tensor for each in (given, scene))
    return np.allclose(own, other, rtol=0.0, atol=EQUAL * float(np.abs(own).max()))


def _same_forces(given: DiskScene, scene: DiskScene) -> bool:
    """Whether loads have the same forces in all, as accelerations of disks do not on any lattice."""
    for load in given.case.load:
        own, other = (forces_of(load, each)[1][:, :2].sum(axis=0) for each in (given, scene))
        is_by_mass = load.acceleration is not None and not load.is_everywhere
        if is_by_mass and not np.allclose(own, other, rtol=EQUAL, atol=0.0):
            return False
    return True


def _planned(case: DiskCase, changes: Any) -> Plan[DiskScene] | None:
    """The changed case, planned; None if it cannot run."""
    try:
        return plan(with_changes(case, changes) if changes else case)
    except DemboundError:
        return None


def _wider(plain: DiskOption, companions: Companions) -> Iterator[DiskOption]:
    """Variants of a choice with its sides farther away, up to where nothing returns from them."""
    own, needed = plain.case, needed_by(plain.scene)
    last = own.packing.extent
    area = last[0] * last[1]
    for wider in WIDER:
        try:
            case = companions.wider(plain.scene, needed, wider)
            extent = tuple(round(length, 10) for length in case.packing.extent)
            packing = case.packing.model_copy(update={"size": extent, "bricks": None})
            case = checked(replace(case, packing=packing, run=own.run, name=own.name))
        except DemboundError:
            return
        if case.packing.extent == last:
            return
        last = case.packing.extent
        yield replace(plain, case=case, wider=wider, cost=plain.cost * last[0] * last[1] / area)
