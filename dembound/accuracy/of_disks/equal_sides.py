"""Sides of a coarser lattice that reflect as much of plane waves as those of the given one; other packages' sides."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from dembound.boundaries.boundary import Boundary
from dembound.boundaries.edge import BoundaryMedium, Edge, Motion, normal_axis
from dembound.boundaries.platen import Keeping
from dembound.boundaries.support import Supports
from dembound.boundaries.viscoelastic import Viscoelastic
from dembound.boundaries.viscous import Viscous
from dembound.casefile.disks.model import DiskCase
from dembound.disks.matching import Held, homogenised_beta, per_metre, supports_of
from dembound.disks.scene import DiskScene, build, with_boundaries
from dembound.disks.sides import media_of, medium_of_side
from dembound.errors import CaseError
from dembound.formulas.disks.reflections import Reflected, Reflections, factor_for

EVEN = 1e-6
"""Largest relative difference between numbers that count as equal: rounding."""


def with_plain_sides(scene: DiskScene) -> DiskScene:
    """The scene with artificial sides of unknown types replaced by equivalent "viscous" or "viscoelastic" ones.

    Other sides do not change: types whose methods give their dashpots and springs, sides that let waves in or
    follow a column, that meet several layers, or whose dampers or springs vary along the side.
    """
    plain = {side: _plain(table, side, scene) for side, table in scene.case.boundary.items()}
    if plain == scene.case.boundary:
        return scene
    return with_boundaries(scene, replace(scene.case, boundary=plain))


def _plain(table: Boundary, side: str, scene: DiskScene) -> Boundary:
    """The equivalent table of one side."""
    if side not in scene.edges or not table.may_move or table.needs_column or len(media_of(scene, side)) > 1:
        return table
    edge, supports = scene.edges[side], supports_of(scene, side)
    medium = medium_of_side(scene, side)
    if _is_known(table, supports, (edge, medium), scene) or not _is_even(supports, edge):
        return table
    held = Held.of(scene, side)
    one = medium.impedances(1.0, 1.0, edge.axis)
    if (held.damping[one == 0.0] > 0.0).any():  # in a medium without such waves no factor is so large
        return table
    ratio, order = edge.diameter_sum_ratio, [edge.axis, 1 - edge.axis]  # along the normal and across it
    beta_p, beta_s = (np.divide(held.damping, one, out=np.zeros(2), where=one > 0.0) / ratio)[order].tolist()
    dashpots = {"beta_p": beta_p, "beta_s": beta_s, "half_mass": table.half_cells}
    if not held.stiffness.any():
        return Viscous.model_validate({"type": "viscous"} | dashpots)
    alpha_n, alpha_s = (held.stiffness / ratio)[order].tolist()
    springs = {"alpha_n": alpha_n, "alpha_s": alpha_s, "young_modulus": 2.0, "distance": 1.0}  # G/L = 1 Pa/m
    return Viscoelastic.model_validate({"type": "viscoelastic"} | dashpots | springs)


def _is_known(table: Boundary, supports: Supports, place: tuple[Edge, BoundaryMedium], scene: DiskScene) -> bool:
    """Whether the methods of a type give its dashpots and springs on disks of any size, or it has none."""
    edge, medium = place
    if supports.stiffness.any() and table.equal_supports(place, place) is None:
        return False
    if not table.factors:
        return not supports.damping.any()
    factors = table.factors_at(edge, medium)
    found = np.zeros((2, scene.count))
    rows = supports.component < 2
    found[supports.component[rows], supports.node[rows]] = supports.damping[rows]
    of_factors = np.outer(medium.impedances(factors.get("p", 0.0), factors.get("s", 0.0), edge.axis), edge.widths)
    free = [axis for axis in (0, 1) if axis not in scene.ground.held]
    return np.allclose(found[free][:, edge.nodes], of_factors[free], rtol=EVEN, atol=0.0)


def _is_even(supports: Supports, edge: Edge) -> bool:
    """Whether a side has only dampers and springs, equal for all its disks or in proportion to their widths."""
    alone = supports.component < 2
    if not alone.all() or supports.prescribed.any() or supports.follow.any() or len(supports.drive):
        return False
    widths: np.ndarray = np.broadcast_to(edge.widths, len(edge.nodes))
    for component in (0, 1):
        rows = supports.component == component
        if not rows.any():
            continue
        if not np.array_equal(np.sort(edge.nodes), supports.node[rows]):
            return False
        per = widths[np.argsort(edge.nodes)]
        for values in (supports.damping[rows], supports.stiffness[rows]):
            if not any(np.ptp(each) <= EVEN * np.abs(each).max() for each in (values, values / per)):
                return False
    return True


EQUAL = 1e-3
"""Largest relative difference between dampers, springs and forces per metre that count as equally strong; dashpots that
differ by so much reflect half as much more or less."""


def equal_sides(
    case: DiskCase, scene: DiskScene, time_step: float, reflections: Reflections
) -> tuple[dict[str, Boundary], float]:
    """Sides of a coarser case that reflect as much, with springs as stiff, as those of the scene of the finer case.

    time_step : s, of the finer case. Also returns `Coarser.weight`. Raises CaseError for dampers, springs or forces of
    waves that are not known on disks of another size.
    """
    scene = with_plain_sides(scene)
    plain = scene.case.boundary
    case = replace(case, boundary={side: _as_deep(plain[side], table) for side, table in case.boundary.items()})
    own = build(case)
    shares = {side: reflections.of(scene, side, time_step) for side, table in case.boundary.items() if table.factors}
    halved = {side: found for side, found in shares.items() if _may_be_whole(case.boundary[side])}
    weight = _weight_of_mass(halved, build(with_whole_cells(case)), time_step, reflections)
    boundary = {side: _equal_supports(table, side, own, scene) for side, table in case.boundary.items()}
    boundary |= {
        side: _equal_dashpots(boundary[side], side, found, weight > 0.0, own) for side, found in shares.items()
    }
    return boundary, weight


def _as_deep(table: Boundary, given: Boundary) -> Boundary:
    """A side with as many disks whose bonds do not break as another one is given."""
    if isinstance(table, Keeping) and isinstance(given, Keeping):
        return table.model_copy(update={"intact": given.intact})
    return table


def with_whole_cells(case: DiskCase) -> DiskCase:
    """A case with whole cells at its sides, except where waves enter, whose reflection is known by formula."""
    whole = {side: table.with_half_cells(False) for side, table in case.boundary.items() if _may_be_whole(table)}
    return replace(case, boundary={**case.boundary, **whole})


def _may_be_whole(table: Boundary) -> bool:
    """Whether a side may have half cells or whole ones, lets no waves in, and is to return none."""
    return table.may_halve and not table.waves and not table.is_interface


def _weight_of_mass(
    shares: Mapping[str, Mapping[Motion, Reflected]], whole: DiskScene, time_step: float, reflections: Reflections
) -> float:
    """Out-of-phase reflection of a finer scene's sides over that of whole cells of the lattice, see `coarser.Coarser`.

    time_step : s, stable with larger disks too. Mean over sides and motions; 0 where the dashpots reflect more in
    phase.
    """
    finer = [share for both in shares.values() for share in both.values()]
    if sum(share.out_of_phase**2 for share in finer) <= sum(share.dashpots**2 for share in finer):
        return 0.0
    coarse = {side: reflections.of(whole, side, time_step) for side in shares}
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
    """A side of half cells with factors for equal reflection; rock remains.

    mass_apart : whether the out-of-phase part is found separately.
    """
    if table.is_interface:
        return table.with_half_cells(True)
    factors = {
        motion: homogenised_beta(own, side, motion)
        * factor_for(share.dashpots if mass_apart and table.may_halve else share.signed)
        for motion, share in shares.items()
    }
    return table.with_factors(factors).with_half_cells(True)


def _equal_supports(table: Boundary, side: str, own: DiskScene, finer: DiskScene) -> Boundary:
    """A side whose springs, and forces of waves, are as strong per length as those of the finer scene.

    Raises CaseError where the type gives no equally strong side, or its dampers differ.
    """
    if side not in own.edges:
        return table
    here, there = ((each.edges[side], medium_of_side(each, side)) for each in (own, finer))
    answered = table.equal_supports(here, there)
    found = table if answered is None else answered
    ratios = np.array([_impedances(own, side), _impedances(finer, side)])
    given, required = per_metre(own, side, found), per_metre(finer, side, table)
    for kind, component, number in sorted({*given, *required}):
        if kind != "dampers" and answered is not None:
            continue  # the type knows, such as those of mirror images, which are stiffer per length
        larger, smaller = (each.get((kind, component, number), 0.0) for each in (given, required))
        allowed = [smaller]
        if kind != "springs" and component < 2:
            allowed.append(smaller * ratios[0, component] / ratios[1, component])
        if not any(math.isnan(each) or math.isclose(larger, each, rel_tol=EQUAL) for each in allowed):
            what = f'"{table.type}" has {kind}, which are not known for disks of another size'
            why = f"a type with {kind} other than in proportion to edge.widths needs the method equal_supports()"
            raise CaseError([f"boundary.{side}.type: {what}; {why}"])
    return found


def _impedances(scene: DiskScene, side: str) -> np.ndarray:
    """ρc (2,) Pa·s/m of waves along the normal of a side that move disks along x and y; nan where none run.

    The mean over the layers that it meets: a coarser body may end at another height, and has other shares of them.
    """
    parts = media_of(scene, side)
    order = [0, 1] if normal_axis(side) == 0 else [1, 0]  # of P and S waves
    found = [medium.density * np.array(medium.running_speeds)[order] for _, medium in parts]
    return np.asarray(np.average(found, axis=0, weights=[part.length for part, _ in parts]))
