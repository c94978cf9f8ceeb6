"""Sides of a coarser lattice that reflect as much of plane waves along their normal as those of a finer case."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dembound.accuracy.of_disks.matched_sides import Reflected, factor_for, reflected
from dembound.boundaries import Motion, normal_axis
from dembound.boundaries.boundary import Boundary
from dembound.casefile.disks import DiskCase
from dembound.disks.matching import homogenised_beta, supports_of
from dembound.disks.scene import DiskScene, boundary_medium, build
from dembound.errors import CaseError


def equal_sides(case: DiskCase, scene: DiskScene, time_step: float) -> tuple[dict[str, Boundary], float]:
    """Sides of a coarser case that reflect as much, with springs as stiff, as those of the scene of the finer case.

    time_step : s, of the finer case. Returns also the weight of what whole cells add, see `coarser.Coarser`. Raises
    CaseError for springs that are not known.
    """
    own = build(case)
    shares = {side: reflected(scene, side, time_step) for side, table in case.boundary.items() if table.factors}
    halved = {side: found for side, found in shares.items() if case.boundary[side].may_halve}
    weight = _weight_of_mass(halved, build(with_whole_cells(case)), time_step)
    boundary = {side: _equal_springs(table, side, own, scene) for side, table in case.boundary.items()}
    boundary |= {
        side: _equal_dashpots(boundary[side], side, found, weight > 0.0, own) for side, found in shares.items()
    }
    return boundary, weight


def with_whole_cells(case: DiskCase) -> DiskCase:
    """A case with whole cells at its sides."""
    return replace(case, boundary={side: table.with_half_cells(False) for side, table in case.boundary.items()})


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


def _equal_dashpots(
    table: Boundary, side: str, shares: Mapping[Motion, Reflected], mass_apart: bool, own: DiskScene
) -> Boundary:
    """A side with other factors, its disks half cells; mass_apart : whether what is out of phase is found apart."""
    factors = {
        motion: homogenised_beta(own, side, motion)
        * factor_for(share.dashpots if mass_apart and table.may_halve else share.signed)
        for motion, share in shares.items()
    }
    return table.with_factors(factors).with_half_cells(True)


def _equal_springs(table: Boundary, side: str, own: DiskScene, finer: DiskScene) -> Boundary:
    """A side with springs as stiff per length as those of the finer scene, if it has springs.

    Raises CaseError for a type that has some, and does not know which those are.
    """
    if side not in own.edges or not supports_of(own, side).stiffness.any():
        return table
    axis = normal_axis(side)
    here, there = ((each.edges[side], boundary_medium(each.case, each.ground, axis)) for each in (own, finer))
    found = table.equal_springs(here, there)
    if found is None:
        what = f'"{table.type}" has springs, which are not known for disks of another size'
        raise CaseError([f"boundary.{side}.type: {what}; a type with springs needs the method equal_springs()"])
    return found
