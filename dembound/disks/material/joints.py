"""Masses and springs beside a joint of two layers that move its effective heights to it, see layered.py."""

from dataclasses import replace

import numpy as np

from dembound.disks.material.packed_material import PackedMaterial
from dembound.laws import Moduli

SLIGHT = 1e-3
"""Relative change of springs by which the derivatives of the moduli are computed."""


def compliances(material: PackedMaterial) -> tuple[float, float]:
    """Gradients ∂u_x/∂y and ∂u_y/∂y under unit traction along x and along y on horizontal planes, 1/Pa."""
    free = [component for component in (0, 1) if component not in material.held]
    numbers = [(2, 1)[component] for component in free]  # see homogenise.GRADIENTS
    inverse = np.linalg.inv(material.tensor[np.ix_(numbers, numbers)])
    found = [float(inverse[free.index(c), free.index(c)]) if c in free else np.nan for c in (0, 1)]
    return found[0], found[1]


def corrected(
    moved: np.ndarray, below: PackedMaterial, above: PackedMaterial, reach: float, number: int
) -> PackedMaterial:
    """The material below (number 0) or above (1) a joint, within reach (m) of it, that moves the joint.

    moved : (3,) m, by which it moves down the heights where mass and stiffness for P and S waves change. The mass that
    lacks is spread over both zones, and so is the compliance, of normal springs by that of P waves and of shear springs
    by that of S waves.
    """
    own = (below, above)[number]
    mass = -moved[0] * (below.density - above.density)
    density = own.density * (1.0 + mass / (reach * (below.density + above.density)))
    p, s = (
        -np.log1p(-way * (one - other) / (reach * (one + other)))
        for way, one, other in zip(moved[1:], *(compliances(each)[::-1] for each in (below, above)), strict=True)
    )
    normal, shear = _factors(own, np.array([p, s]))
    return replace(own, density=density, moduli=_scaled(own.moduli, normal, shear))


def _scaled(moduli: Moduli, normal: float, shear: float) -> Moduli:
    """Moduli with all normal and bending springs, and all shear springs, multiplied by factors."""
    ratio = normal / shear
    stiff = replace(moduli, emod=moduli.emod * normal, pb_emod=moduli.pb_emod * normal)
    return replace(stiff, kratio=moduli.kratio * ratio, pb_kratio=moduli.pb_kratio * ratio)


def _factors(material: PackedMaterial, targets: np.ndarray) -> tuple[float, float]:
    """Factors of normal and shear springs that change the logarithms of the moduli of P and S waves by targets (2,)."""
    if not targets.any():
        return 1.0, 1.0
    moving = [1 - component for component in (1, 0) if component not in material.held]  # P along y, S along x
    changed = [_scaled(material.moduli, *each) for each in ((1.0 + SLIGHT, 1.0), (1.0, 1.0 + SLIGHT))]
    trials = [material, *(replace(material, moduli=moduli) for moduli in changed)]
    own, *others = (-np.log(compliances(each)[::-1]) for each in trials)
    slopes = np.column_stack([each - own for each in others]) / np.log1p(SLIGHT)
    normal, shear = np.exp(np.linalg.lstsq(slopes[moving], targets[moving], rcond=1e-6)[0])
    return float(normal), float(shear)
