"""Ground whose contacts have a stiffness only under pressure: their overlaps under the stress at rest."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from dembound.disks.material.at_rest import pair_forces
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.sliding import within_friction
from dembound.errors import CaseError

if TYPE_CHECKING:
    from dembound.casefile.disks import DiskCase

SETTLED = 1e-12
"""Change of overlaps over the largest one at which they are found."""

BORNE = 1e-6
"""Part of a stress that may be missing in the mean of the forces: more is rounding of no balance."""

_FOUND: dict[bytes, np.ndarray] = {}
"""Overlaps by the content of all that they depend on."""

ROUNDS = 100
"""Rounds after which none are found. The springs follow forces to the power 1/3, so that each leaves a third at most of
what was missing; 30 are enough."""


def confined(ground: PackedMaterial, case: DiskCase) -> PackedMaterial:
    """The ground of a case with the overlaps that its contacts have under the stress at rest.

    The ground itself under a law that starts elastic; without a stress at rest contacts have no stiffness. Raises
    CaseError for a stress that contacts with friction alone cannot bear.
    """
    if ground.law.starts_elastic:
        return ground
    stress = np.zeros(3) if case.static is None else np.array(case.static.stress or (0.0, 0.0, 0.0))
    if not stress.any():
        nothing = np.zeros(len(ground.brick.pairs))
        return replace(ground, moduli=replace(ground.moduli, emod=0.0), overlaps=nothing)
    content = ground.content(stress.tolist())
    if content not in _FOUND:
        _FOUND[content] = _overlaps(ground, stress)
    return _with(ground, _FOUND[content])


def require_stiffness(ground: PackedMaterial) -> None:
    """Raise CaseError for contacts that have no stiffness, as nothing presses them."""
    if not ground.has_stiffness:
        said = f'is missing; contacts of material.law = "{ground.law.name}" have no stiffness without pressure'
        raise CaseError([f"static.stress: {said}"])


def _with(ground: PackedMaterial, overlaps: np.ndarray) -> PackedMaterial:
    """The ground with contacts of these overlaps (b,) m."""
    first, second = ground.brick.radii[ground.brick.pairs].T
    springs = ground.law.springs_at(ground.moduli, first, second, overlaps)
    stiff = replace(ground.moduli, emod=float(springs.contact_normal.mean()))
    return replace(ground, moduli=stiff, overlaps=overlaps)


def _overlaps(ground: PackedMaterial, stress: np.ndarray) -> np.ndarray:
    """Overlaps (b,) m under a stress (3,) Pa: in turn the forces of springs, and the springs of forces."""
    brick, law, moduli = ground.brick, ground.law, ground.moduli
    first, second = brick.radii[brick.pairs].T
    push = np.full(len(first), float(np.abs(stress).max()) * brick.mean_diameter)
    overlaps = law.overlap_of(moduli, first, second, push)
    for _ in range(ROUNDS):
        ground = _with(ground, overlaps)
        forces = pair_forces(ground) @ stress
        if not within_friction(*ground.stiffnesses(ground.contact_constants), moduli.fric, forces):
            sliding = ground.sliding_forces(stress)  # none in the first rounds, far from balance
            forces = forces if sliding is None else sliding
        before, overlaps = overlaps, law.overlap_of(moduli, first, second, -forces[0])
        if np.abs(overlaps - before).max() <= SETTLED * overlaps.max():
            if np.abs(_stress(ground, forces) - stress).max() <= BORNE * np.abs(stress).max():
                return overlaps
            break
    sxx, syy, sxy = stress.tolist()
    said = f'is [{sxx:g}, {syy:g}, {sxy:g}] Pa, which contacts of law = "{law.name}" without bonds do not bear'
    raise CaseError([f"static.stress: {said}; press from all sides, or give more material.fric"])


def _stress(ground: PackedMaterial, forces: np.ndarray) -> np.ndarray:
    """Mean stress (3,) xx, yy, xy in Pa of normal and shear forces (2 or more, b) of the brick's contacts."""
    (x, y), (normal, shear) = ground.brick.vectors.T, forces[:2]
    length = np.hypot(x, y)
    pull_x, pull_y = (normal * x - shear * y) / length, (normal * y + shear * x) / length
    sums = [np.sum(pull_x * x), np.sum(pull_y * y), 0.5 * np.sum(pull_x * y + pull_y * x)]
    return np.array(sums) / float(np.prod(ground.brick.size))
