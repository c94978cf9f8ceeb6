"""Artificial sides of other packages' types, replaced by sides of this package with equal dampers and springs.

A type of another package may have coefficients per disk, and may not know half cells. On larger disks it would hold
less per metre, and its cells would reflect more. So there it gets dampers and springs as strong per metre as in its
support table on the given disks.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dembound.boundaries import Viscoelastic, Viscous
from dembound.boundaries.boundary import Boundary
from dembound.boundaries.support import BoundaryMedium, Edge, Supports
from dembound.disks.matching import Held, supports_of
from dembound.disks.scene import DiskScene, with_boundaries
from dembound.disks.side_media import media_of, medium_of_side

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
