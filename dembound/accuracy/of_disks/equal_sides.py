"""Sides of a coarser lattice that reflect as much of plane waves along their normal as those of a finer case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from dembound.accuracy.of_disks.matched_sides import Reflected, factor_for, reflected
from dembound.boundaries import Motion, normal_axis
from dembound.boundaries.boundary import Boundary
from dembound.boundaries.viscoelastic import Springs
from dembound.casefile.disks import DiskCase
from dembound.disks.matching import homogenised_beta
from dembound.disks.scene import DiskScene, boundary_medium, build


def equal_sides(case: DiskCase, scene: DiskScene, time_step: float) -> tuple[dict[str, Boundary], float]:
    """Sides of a coarser case that reflect as much, with springs as stiff, as those of the scene of the finer case.

    time_step : s, of the finer case. Returns also the weight of what whole cells add, see `coarser.Coarser`.
    """
    own = build(case)
    shares = {side: reflected(scene, side, time_step) for side, table in case.boundary.items() if table.factors}
    halved = {side: found for side, found in shares.items() if _can_halve(case.boundary[side])}
    weight = _weight_of_mass(halved, build(with_whole_cells(case)), time_step)
    boundary = {
        side: _equal_side(table, side, shares[side], weight > 0.0, own, scene) if side in shares else table
        for side, table in case.boundary.items()
    }
    return boundary, weight


def with_whole_cells(case: DiskCase) -> DiskCase:
    """A case with whole cells at its sides."""
    sides = case.boundary.items()
    whole = {side: table.model_copy(update={"half_mass": False}) for side, table in sides if _can_halve(table)}
    return replace(case, boundary={**case.boundary, **whole})


def _weight_of_mass(shares: Mapping[str, Mapping[Motion, Reflected]], whole: DiskScene, time_step: float) -> float:
    """What sides of a finer scene reflect out of phase, over what whole cells of the lattice do, see `coarser.Coarser`.

    time_step : s, with which lattices are stable that have larger disks. The mean over sides and motions; 0 where the
    dashpots reflect more in phase.
    """
    finer = [share for both in shares.values() for share in both.values()]
    if sum(share.out_of_phase**2 for share in finer) <= sum(share.dashpots**2 for share in finer):
        return 0.0
    coarse = {side: reflected(whole, side, time_step) for side in shares}
    ratios = [
        share.out_of_phase / coarse[side][motion].out_of_phase
        for side, both in shares.items()
        for motion, share in both.items()
        if motion in coarse[side] and coarse[side][motion].out_of_phase > 0.0
    ]
    return float(np.mean(ratios)) if ratios else 0.0


def _can_halve(table: Boundary) -> bool:
    """Whether a side may have half cells."""
    return "half_mass" in type(table).model_fields and not table.needs_column


def _equal_side(
    table: Boundary,
    side: str,
    shares: Mapping[Motion, Reflected],
    mass_apart: bool,
    own: DiskScene,
    finer: DiskScene,
) -> Boundary:
    """A side with other factors, its disks half cells; mass_apart : whether what is out of phase is found apart."""
    update: dict[str, Any] = {
        f"beta_{motion}": homogenised_beta(own, side, motion)
        * factor_for(share.dashpots if mass_apart and _can_halve(table) else share.signed)
        for motion, share in shares.items()
    }
    if _can_halve(table):
        update["half_mass"] = True
    if isinstance(table, Springs):
        update |= _equal_springs(table, side, own, finer)
    return table.model_copy(update=update)


def _equal_springs(table: Springs, side: str, own: DiskScene, finer: DiskScene) -> Mapping[str, float]:
    """Factors α of springs that are as stiff per length of the side."""
    axis = normal_axis(side)
    per_length = [
        table.shear_modulus(boundary_medium(scene.case, scene.ground, axis)) * scene.edges[side].diameter_sum_ratio
        for scene in (own, finer)
    ]
    ratio = per_length[1] / per_length[0]
    return {"alpha_n": table.alpha_n * ratio, "alpha_s": table.alpha_s * ratio}
