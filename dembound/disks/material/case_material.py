"""The material of a case on a brick: moduli as given, scaled to a wave speed, or found for targets of the body."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from dembound.casefile.disks.material import Material
from dembound.casefile.types import LAWS
from dembound.damping import Attenuation
from dembound.disks.material.packed_material import PackedMaterial
from dembound.disks.material.targets import with_target
from dembound.errors import CaseError
from dembound.laws import Moduli, lattice_moduli
from dembound.packings.brick import Brick
from dembound.words import with_unit

LARGEST_OVERLAP = 0.1
"""Largest locked-in pressure over the contact modulus: the largest pressure at which bricks are packed."""


AXES = {"x": 0, "y": 1, "rotation": 2}


def make_packed_material(
    brick: Brick,
    material: Material,
    held: Iterable[str],
    along: int = 0,
    mechanisms: Attenuation | None = None,
    place: str = "material",
) -> PackedMaterial:
    """Combine a brick with its material; if match is "assembly", the moduli are scaled to the given wave speed.

    An S-wave speed alone always scales them; targets of the body are met, see targets.py. along : axis of the waves
    with a single given speed, 0 (x) or 1 (y). mechanisms : of its damping. place : of its table, for messages.

    Raises CaseError for a locked-in stress that the packing's contacts cannot carry, and for targets out of reach.
    """
    ground = _scaled(brick, material, held, along)
    if material.target is not None:
        ground = with_target(ground, material.target, place)
    if mechanisms is not None:
        ground = replace(ground, mechanisms=mechanisms)
    if material.locked_in is not None:
        most = LARGEST_OVERLAP * ground.moduli.emod
        if ground.packed_pressure <= 0.0:
            raise CaseError(["material.locked_in: needs disks that were packed under stress; use static.stress"])
        if material.locked_in > most:
            allowed = f"at most {with_unit(most, 'Pa')}, {LARGEST_OVERLAP:g} of the contact modulus"
            raise CaseError([f"material.locked_in: is {with_unit(material.locked_in, 'Pa')}, must be {allowed}"])
    return ground


def _scaled(brick: Brick, material: Material, held: Iterable[str], along: int) -> PackedMaterial:
    """A brick with its material, its moduli scaled to the case's wave speed where they are, see above."""
    ground = PackedMaterial(
        brick=brick,
        density=material.density,
        moduli=nominal_moduli(material),
        law=LAWS[material.law],
        held=tuple(AXES[name] for name in held),
        given_speeds=(None, None) if material.target else (material.p_wave_speed, material.s_wave_speed),
    )
    if material.target is not None:
        return ground
    kind, given = (1, material.s_wave_speed) if material.by_s_waves else (0, material.p_wave_speed)
    if given is None or (kind == 0 and material.match == "lattice"):
        return ground
    moves = along if kind == 0 else 1 - along
    axis = 1 - along if moves in ground.held else along
    factor = (given / ground.wave_speeds(axis)[kind]) ** 2
    moduli = replace(ground.moduli, emod=ground.moduli.emod * factor, pb_emod=ground.moduli.pb_emod * factor)
    return replace(ground, moduli=moduli)


def nominal_moduli(material: Material) -> Moduli:
    """Micro-parameters as the case gives them, or by Z eq. 11 from its wave speed, or from that of its targets."""
    speed = material.p_wave_speed or (material.s_wave_speed if material.by_s_waves else None)
    if material.target is not None:
        speed = float(np.sqrt(material.target.moduli.uniaxial / material.density))
    if speed is not None:
        emod, pb_emod = lattice_moduli(material.density, speed, material.contact_share, material.pb_rmul)
    else:
        return LAWS[material.law].moduli(material)
    ratios = material.kratio, material.pb_kratio, material.pb_rmul, material.fric, material.pb_mcf
    return Moduli(emod, pb_emod, *ratios)
