"""The elastic law in place of a history-dependent one, on lattices where no contact opens, slides or breaks.

Whether none does is found with a companion of larger disks under the elastic law, whose load factor is the multiple of
these waves up to which it holds. In two dimensions the stress under a point force falls as 1/r, and that at a sharp
corner more slowly, so that the largest stress between disks grows at most as 1/D: with disks smaller by a factor
contacts and bonds are nearer to their limits by at most that factor. At rest this does not hold beside a hole, where
stress at rest is higher the smaller the disks are; nor on random packings, whose contacts are all loaded differently.

A law whose contacts follow the motion differs from the elastic one all the same, if a body has come to rest under a
stress: see `causes_of_turning`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from dembound.accuracy.choice import keeps
from dembound.accuracy.of_disks.coarser import coarser
from dembound.accuracy.of_disks.enlarged import ratios
from dembound.accuracy.runner import Runner, at_step
from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import BOND_KEYS, HISTORY_KEYS, ROLLING_KEY, STRENGTH_KEYS
from dembound.casefile.types import LAWS
from dembound.disks.material.constants import bond_factors
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.disks.stepping.load_factor import LOAD_FACTOR
from dembound.errors import CaseError, DemboundError
from dembound.formulas.cause import Cause
from dembound.formulas.disks.reflections import Reflections
from dembound.formulas.disks.rest import causes_of_turning
from dembound.formulas.disks.waves import is_square_lattice
from dembound.formulas.history import Motions
from dembound.kinds import with_changes
from dembound.motion.kind import Plan
from dembound.running import plan

RESERVE = 2.0
"""By how much the elastic law must hold with disks of another size: a region of a load as wide as a disk contains one
row of them, or two."""

EQUAL = 1e-9
"""Relative difference of diameters that count as equal."""


@dataclass(frozen=True)
class ElasticTwin:
    """A case under the elastic law.

    planned : its plan. factor : multiple of its waves up to which the law holds with disks of `diameter` (m); infinite
    if under any. stress : at rest, Pa, that rotates with the disks.
    """

    case: DiskCase
    planned: Plan[DiskScene]
    factor: float
    diameter: float
    stress: float

    def holds(self, diameter: float) -> bool:
        """Whether the law holds with disks of a diameter (m), with a reserve if none of that size have been run."""
        if math.isclose(diameter, self.diameter, rel_tol=EQUAL):
            return self.factor > 1.0
        return self.factor * min(1.0, diameter / self.diameter) > RESERVE

    def causes(self, scene: DiskScene, recorded: Motions) -> list[Cause]:
        """The error by the elastic law under a stress at rest. scene : of a choice; recorded : its motion."""
        return causes_of_turning(scene, recorded, self.stress)

    @property
    def words(self) -> str:
        """The law in words."""
        if math.isinf(self.factor):
            return "the elastic law, which always holds"
        size = f"with disks of {self.diameter:.4g} m"
        return f"the elastic law, which holds up to {self.factor:.3g} times these waves {size}"


def elastic_twin(
    case: DiskCase,
    planned: Plan[DiskScene],
    most: float,
    kept: Sequence[str],
    runner: Runner,
    reflections: Reflections | None = None,
) -> ElasticTwin | None:
    """The case under the elastic law if that holds with the case's disks; None if not, or if it is not known.

    planned : of the case. most : particle-steps that the companion should take. kept : keys that do not change.
    reflections : of sides, measured before.
    """
    if not _may_be_elastic(case, planned.scene):
        return None
    kept_out = (*HISTORY_KEYS, ROLLING_KEY)
    given = {key: value for key, value in case.material.given().items() if key not in kept_out}
    law = {"law": LAWS[case.material.law].linear}
    rolling = {
        f"layer.{number}.{ROLLING_KEY}": None
        for number, each in enumerate(case.layer, start=1)
        if ROLLING_KEY in each.own
    }
    strong = {"material": given | law, "output.load_factor": True} | rolling
    weak: dict[str, Any] = {"material": {key: value for key, value in given.items() if key not in BOND_KEYS} | law}
    weak |= rolling
    for number, layer in enumerate(case.layer, start=1):
        weak |= {f"layer.{number}.{key}": None for key in BOND_KEYS if key in layer.given()}
    try:
        watched = with_changes(case, strong | _as_the_weakest(case, planned.scene))
        twins = [with_changes(case, weak | change) for change in _without_stage(case)]
    except CaseError:  # a load that never ends, without a body at rest under it; local damping
        return None
    twin = next((each for each in twins if keeps(case, each, kept)), None)
    if twin is None:
        return None
    for side, bearing in case.bearing.items():  # a default of the case's law and static stage
        twin = with_changes(twin, {f"boundary.{side}.bearing": bearing.model_dump()})
    try:
        factor, diameter = _factor(watched, planned, most, runner, reflections)
    except DemboundError:  # no companion can run
        return None
    found = ElasticTwin(twin, plan(twin), factor, diameter, _turning_stress(case))
    return found if found.holds(_diameter(planned)) else None


def _may_be_elastic(case: DiskCase, scene: DiskScene) -> bool:
    """Whether the law is history-dependent, with limits that are known for disks of other sizes."""
    if not LAWS[case.material.law].has_history or not case.begins_elastic:
        return False
    pushed = any(load.wave is None and not load.is_everywhere for load in case.load)
    return is_square_lattice(scene.ground) and not (case.static is not None and (case.holes or pushed))


def _as_the_weakest(case: DiskCase, scene: DiskScene) -> dict[str, Any]:
    """Changes by which all bonds are as strong as the weakest one; none without scatter of strengths."""
    bonds = bond_factors(case, scene.ground, scene.assembly)
    if bonds is None:
        return {}
    least = float(bonds.at(scene.assembly.pairs[:, 0], scene.assembly.contact_type).min())
    tables = [("material", case.material), *((f"layer.{number}", layer) for number, layer in enumerate(case.layer, 1))]
    strengths = {f"{place}.{key}": getattr(table, key) for place, table in tables for key in STRENGTH_KEYS}
    weakest = {place: least * strength for place, strength in strengths.items() if strength is not None}
    return {"material.pb_scatter": None} | weakest


def _without_stage(case: DiskCase) -> list[dict[str, None]]:
    """Changes to try: first without the static stage, if possible, then none.

    A given stress does not affect the motion of an elastic body about its rest; steady loads have to be balanced.
    """
    is_steady = any(load.wave is None for load in case.load)
    return [{}] if case.static is None or is_steady else [{"static": None}, {}]


def _turning_stress(case: DiskCase) -> float:
    """The largest stress (Pa) at rest, by loads on the edges and weight, that rotates with the contacts."""
    if case.static is None or case.material.geometry == "reference":
        return 0.0
    weight = np.zeros(2)
    for load in case.load:
        if load.wave is None and load.acceleration is not None:
            weight += np.abs(load.acceleration)
    given = max(map(abs, case.static.stress or (0.0,)))
    return float(given + case.material.density * (weight @ case.size))


def _diameter(planned: Plan[DiskScene]) -> float:
    """Diameter (m) of the disks of a plan."""
    return planned.scene.ground.brick.mean_diameter


def _factor(
    case: DiskCase, planned: Plan[DiskScene], most: float, runner: Runner, reflections: Reflections | None
) -> tuple[float, float]:
    """The load factor, and the diameter (m) of the disks with which it was found: the smallest affordable."""
    own, scene = _diameter(planned), planned.scene
    quiet = replace(case, output=case.output.model_copy(update={"snapshots": 0}))
    for ratio in (1.0, *ratios(case, scene)):
        if ratio > 1.0:
            larger = coarser(case, scene, planned.time_step, ratio * own, reflections).case
            quiet = replace(larger, output=larger.output.model_copy(update={"load_factor": True}))
        built = build(quiet)
        step = choose_step(built)[0]
        if built.disk_count * case.run.duration / step <= most:
            break
    found = runner.run(at_step(quiet, step), "load factor of the elastic law").finding(LOAD_FACTOR)
    return found, built.ground.brick.mean_diameter
