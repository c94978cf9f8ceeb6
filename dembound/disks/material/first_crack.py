"""The stress at which the first bond of an endless packing breaks, from static solves of one brick."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.casefile.types import LAWS
from dembound.disks.material.constants import strength_of
from dembound.disks.material.homogenise import Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.laws import Springs
from dembound.laws.law import touching

ROUNDS = 60
"""Most solves with contacts that open or slip; 10 to 20 are usual."""

SETTLED = 1e-3
"""Relative change of the stress between two solves that counts as none."""

SLIGHT = 1e-9
"""Stress of a bond under unit mean stress that counts as none: rounding leaves some 1e-13."""


class FirstCrack(NamedTuple):
    """The first bond to break.

    Attributes
    ----------
    stress : Pa, tension positive. limit : whether it breaks in "tension" or "shear".
    young, poisson : Young's modulus (Pa) and Poisson's ratio of the two-dimensional sample up to there, with contacts
    that open and slip.
    """

    stress: float
    limit: str
    young: float
    poisson: float


def first_crack(ground: PackedMaterial, material: Material, sign: float, axis: int = 1) -> FirstCrack | None:
    """The first crack under stress along an axis, with free sides; None if bonds do not break.

    sign : +1 tension, -1 compression. Under a history-dependent law contacts open in tension and slip at their
    friction, as if the load grew in one step from an unstressed packing.

    Raises CaseError if bonds alone do not hold the packing.
    """
    brick, moduli = ground.brick, ground.moduli
    if moduli.pb_emod == 0.0 or (material.pb_ten is None and material.pb_coh is None):
        return None
    first, second = brick.radii[brick.pairs].T
    springs = ground.law.springs(moduli, first, second)
    closed = touching(first, second, np.hypot(*brick.vectors.T))
    has_history = LAWS[material.law].has_history
    normal, shear = closed * 1.0, closed * 1.0  # parts of the contacts' springs that act
    load = sign * np.eye(3)[axis]
    found = None
    for _ in range(ROUNDS):
        (stretch, slip, turn), mean = _strained(ground, springs, (normal, shear), load)
        before, found = found, _first(material, springs, stretch, slip, turn)
        if found is not None:
            found = found._replace(young=sign / mean[axis], poisson=-mean[1 - axis] / mean[axis])
        if not has_history or found is None or (before and abs(found.stress / before.stress - 1.0) < SETTLED):
            break
        normal = closed * (stretch < 0.0)
        pressed = moduli.fric * springs.contact_normal * np.maximum(-stretch, 0.0)
        needed = np.abs(springs.contact_shear * slip)
        shear = normal * np.divide(pressed, needed, out=np.ones_like(needed), where=needed > pressed)
    return None if found is None else found._replace(stress=sign * found.stress)


def _strained(
    ground: PackedMaterial, springs: Springs, parts: tuple[np.ndarray, np.ndarray], load: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Stretch, shear and turn (3, b) of contacts, and mean strains xx, yy, 2xy, under a mean stress xx, yy, xy (3,) Pa.

    parts : of the normal and shear springs of contacts that act, (b,) each.
    """
    normal = parts[0] * springs.contact_normal + springs.bond_normal
    shear = parts[1] * springs.contact_shear + springs.bond_shear
    stiffness = replace(ground.stiffness, normal=normal, shear=shear, bending=springs.bending)
    network = Network.of_brick(ground.brick, stiffness)
    gradients = network.gradient_matrix()[:, :3]
    elongations = gradients + network.motion_matrix() @ network.relaxed(gradients)
    tensor = gradients.T @ (network.springs[:, None] * elongations) / float(np.prod(ground.brick.size))
    mean = np.linalg.solve(tensor, load)
    return (elongations @ mean).reshape(3, -1), mean


def _first(
    material: Material, springs: Springs, stretch: np.ndarray, slip: np.ndarray, turn: np.ndarray
) -> FirstCrack | None:
    """The multiple of a load, with these elongations (b,), at which the first bond breaks; None if none does."""
    limits = strength_of(material)
    pulled = springs.bond_normal * stretch / springs.area
    bent = material.pb_mcf * np.abs(springs.bending * turn) * 1.5 / springs.bond_radius**2
    sheared = np.abs(springs.bond_shear * slip) / springs.area + limits.tan_fa * pulled
    largest = {"tension": (pulled + bent).max(), "shear": sheared.max()}
    strength = {"tension": limits.tension, "shear": limits.cohesion}
    each = {name: strength[name] / most if most > SLIGHT else np.inf for name, most in largest.items()}
    limit = min(each, key=lambda name: each[name])
    return FirstCrack(float(each[limit]), limit, np.nan, np.nan) if np.isfinite(each[limit]) else None
