"""Contacts and bonds with which a brick has the elastic constants asked for.

Both moduli multiply the homogenised tensor C, so only kratio = pb_kratio has to be searched, by Newton's method on its
logarithm. The derivative is exact: motions that relax a brick make its energy least, so that only the springs change,
dC/d ln κ = −eᵀk_s e/A, where e are the shear elongations of the contacts per unit strain.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dembound.casefile.disks.targets import PlaneModuli, Target
from dembound.disks.material.homogenise import HomogenisedMaterial, Network
from dembound.disks.material.packed_material import PackedMaterial
from dembound.errors import CaseError

LEAST, MOST = 0.1, 1000.0
"""Least and largest kratio searched."""

EXACT = 1e-11
"""Largest difference of ln(K/G) that counts as none."""

USUAL = ((0.3, 2.5), (0.42, 2.3), (0.56, 1.4), (0.71, 0.7), (0.92, 0.0), (1.3, -1.4))
"""G/K, and ln κ, of random packings, where the search begins."""

LONGEST = 2.0
"""Longest step of ln κ."""

SOLVES = 30
"""Most solves: 4 or 5 are usual, at most 20 bisections if the curve is not smooth."""

IMAGINARY = 1e-30
"""Imaginary part by which derivatives are computed: they have no error beside rounding."""

_FOUND: dict[bytes, tuple[float, float]] = {}
"""kratio and the factor of the moduli by the content of all that they depend on."""


def with_target(ground: PackedMaterial, target: Target, place: str) -> PackedMaterial:
    """The material of a brick whose moduli and kratio = pb_kratio are such that the body has a target.

    place : of the table with its keys, for messages. Raises CaseError for targets out of the brick's reach, or of a
    body whose motions along x or y are held.
    """
    if held := [name for name, axis in (("x", 0), ("y", 1)) if axis in ground.held]:
        said = f"{place}.{target.keys[1]}: with {target.keys[0]} is asked of a body that moves freely"
        holds = f"motion.held holds {' and '.join(held)}; leave that out, or give p_wave_speed alone"
        raise CaseError([f"{said}, but {holds}"])
    content = ground.content(target)
    if content in _FOUND:
        kratio, factor = _FOUND[content]
        return _with(ground, kratio, factor)
    kratio, found = _search(ground, target, place)
    factor = target.moduli.shear / moduli_of(found.tensor, target.along, by_waves=target.by_waves).shear
    _FOUND[content] = kratio, factor
    scaled = _with(ground, kratio, factor)
    scaled.remember(HomogenisedMaterial(factor * found.tensor, found.corrector))
    return scaled


def moduli_of(tensor: np.ndarray, along: str, *, by_waves: bool) -> PlaneModuli:
    """Plane moduli (Pa) of a homogenised tensor (4, 4).

    along : "isotropic", those of the isotropic tensor nearest to it; "x" or "y", those of the isotropic body with the
    same waves along this axis, or with the same strains of a sample that is pulled along it with free sides.
    """
    c11, c22, c12, c66 = tensor[0, 0], tensor[1, 1], tensor[0, 1], tensor[3, 3]
    if along == "isotropic":
        return PlaneModuli((c11 + c22 + 2.0 * c12) / 4.0, (c11 + c22 - 2.0 * c12 + 4.0 * c66) / 8.0)
    axis = "xy".index(along)
    if by_waves:
        p, s = ((0, 3), (1, 2))[axis]
        mean, half = 0.5 * (tensor[p, p] + tensor[s, s]), 0.5 * (tensor[p, p] - tensor[s, s])
        apart = np.sqrt(half**2 + tensor[p, s] ** 2)
        return PlaneModuli(2.0 * apart, mean - apart)
    compliance = np.linalg.inv(tensor[:3, :3])
    own, across = compliance[axis, axis], compliance[1 - axis, axis]
    return PlaneModuli(0.5 / (own + across), 0.5 / (own - across))


def _search(ground: PackedMaterial, target: Target, place: str) -> tuple[float, HomogenisedMaterial]:
    """The kratio with which a brick has the ratio of a target's moduli, and its continuum."""
    asked = float(np.log(target.moduli.bulk / target.moduli.shear))
    low, high = np.log(LEAST), np.log(MOST)
    ratios, logarithms = zip(*USUAL, strict=True)
    at = float(np.interp(np.exp(-asked), ratios, logarithms)) + _borne_by_bonds(ground)
    at = min(max(at, low), high)
    tried = set[float]()
    for _ in range(SOLVES):
        trial = _with(ground, float(np.exp(at)))
        error, slope = _error(trial, target, asked)
        if abs(error) <= EXACT:
            return trial.moduli.kratio, trial.continuum
        tried.add(at)
        low, high = (at, high) if error < 0.0 else (low, at)
        if low == high or high - low < EXACT:
            break
        ahead = at + min(max(-error / slope if slope > 0.0 else np.inf, -LONGEST), LONGEST)
        at = min(max(ahead, low), high)
        if at in tried:  # where it came from: halve what is left
            at = 0.5 * (low + high)
    raise CaseError([_out_of_reach(ground, target, place)])


def _borne_by_bonds(ground: PackedMaterial) -> float:
    """The logarithm of the share of the bonds in the stiffness if they alone carry shear, without friction; else 0."""
    moduli = ground.moduli
    bonds = moduli.pb_rmul * moduli.pb_emod
    return float(np.log(bonds / (moduli.emod + bonds))) if moduli.fric == 0.0 else 0.0


def _error(trial: PackedMaterial, target: Target, asked: float) -> tuple[float, float]:
    """ln(K/G) of a material less that asked for, and its derivative by ln κ."""
    network = Network.of_brick(trial.brick, trial.stiffness)
    found, contacts = trial.continuum, len(trial.brick.pairs)
    elongations = network.gradient_matrix() + network.motion_matrix() @ found.corrector.reshape(-1, 4)
    shear = elongations[contacts : 2 * contacts]
    change = -(shear.T @ (trial.stiffness.shear[:, None] * shear)) / float(np.prod(trial.brick.size))
    moved = moduli_of(found.tensor + 1j * IMAGINARY * change, target.along, by_waves=target.by_waves)
    logarithm = np.log(moved.bulk) - np.log(moved.shear)
    return float(logarithm.real) - asked, float(logarithm.imag) / IMAGINARY


def _with(ground: PackedMaterial, kratio: float, factor: float = 1.0) -> PackedMaterial:
    """The material with another kratio = pb_kratio and with both moduli times a factor."""
    emod, pb_emod = factor * ground.moduli.emod, factor * ground.moduli.pb_emod
    return replace(ground, moduli=replace(ground.moduli, emod=emod, pb_emod=pb_emod, kratio=kratio, pb_kratio=kratio))


def _out_of_reach(ground: PackedMaterial, target: Target, place: str) -> str:
    """Message about a target that no kratio reaches, with the brick's range."""
    tensors = [_with(ground, kratio).material_tensor for kratio in (LEAST, MOST)]
    ends = [moduli_of(tensor, target.along, by_waves=target.by_waves) for tensor in tensors]
    if target.by_waves:
        low, asked, high = (np.sqrt(each.uniaxial / each.shear) for each in (ends[0], target.moduli, ends[1]))
        what, key = "c_p/c_s", "s_wave_speed"
        others = ', or pattern "A", which has any along its rows (along = "x" or "y")'
    else:
        low, asked, high = (each.poisson(target.plane) for each in (ends[0], target.moduli, ends[1]))
        what, key = f'Poisson\'s ratio (plane = "{target.plane}")', target.keys[1]
        others = ', or p_wave_speed and s_wave_speed, of which pattern "A" has any along its rows (along = "x" or "y")'
    if asked > high and len(ground.brick.radii) > 1:
        others = f", a looser packing (packing.confining_stress){others}"
    has = f"this brick has {low:.3g} to {high:.3g} (kratio {LEAST:g} to {MOST:g}); give one within it{others}"
    return f"{place}.{key}: asks for {what} = {asked:.3g}, but {has}"
