"""Mistakes in how the stiffness of a [material] is given: by targets of the body, by a wave speed, or by moduli."""

from typing import Any

from dembound.casefile.disks.targets import PAIRS

WAVE_SPEED_KEYS = ("match", "contact_share")
MODULI_KEYS = ("emod", "pb_emod")
RATIO_KEYS = ("kratio", "pb_kratio")
STIFFNESS_KEYS = (*(key for pair in PAIRS for key in pair), *MODULI_KEYS)
"""Keys from which the moduli follow."""


def problems_with_target(material: Any) -> list[str]:
    """Mistakes of a material given by elastic constants of the body."""
    pair = material.pair
    together = " and ".join(pair)
    problems = [f"{key}: is missing; {together} go together" for key in pair if getattr(material, key) is None]
    problems += [
        f"{key}: is not allowed together with {together}, which give the stiffness"
        for key in material.valued(STIFFNESS_KEYS)
        if key not in pair
    ]
    problems += [
        f"{key}: is not allowed together with {together}, from which it is found"
        for key in RATIO_KEYS
        if key in material.model_fields_set
    ]
    if "match" in material.model_fields_set:
        problems.append(f"match: is only allowed together with p_wave_speed alone; {together} are those of the packing")
    if pair == PAIRS[2]:
        if "plane" in material.model_fields_set:
            problems.append("plane: is only allowed together with young and poisson, or bulk and shear")
        p_speed, s_speed = material.p_wave_speed, material.s_wave_speed
        if s_speed is not None and p_speed is not None and s_speed >= p_speed:
            problems.append(f"s_wave_speed: is {s_speed:g}, must be less than p_wave_speed")
    if pair == PAIRS[1] and material.along != "isotropic":
        problems.append('along: is of waves or of a test; with bulk and shear it must be "isotropic"')
    if material.poisson is not None and material.plane == "strain" and material.poisson >= 0.5:
        problems.append(
            f'poisson: is {material.poisson:g}, must be less than 0.5; a 2D sample (plane = "stress") may have it'
        )
    if material.fric == 0.0 and material.contact_share == 1.0:
        problems.append("contact_share: is 1, so without friction nothing carries shear; give less, or fric > 0")
    return problems


def problems_with_speed(material: Any) -> list[str]:
    """Mistakes of a material given by its P-wave speed."""
    why = "is not allowed together with p_wave_speed, which gives the moduli"
    return [f"{key}: {why}" for key in material.valued(MODULI_KEYS)]


def problems_with_moduli(material: Any) -> list[str]:
    """Mistakes of a material without a P-wave speed."""
    missing = [key for key in MODULI_KEYS if getattr(material, key) is None]
    by_speed = len(missing) == 2
    if by_speed and material.s_wave_speed is None:
        return [
            "p_wave_speed: is missing; give either p_wave_speed, s_wave_speed, young and poisson, bulk and shear, "
            "or emod and pb_emod"
        ]
    problems = [] if by_speed else [f"{key}: is missing; emod and pb_emod go together" for key in missing]
    for key in ("match",) if by_speed else WAVE_SPEED_KEYS:
        if key in material.model_fields_set:
            problems.append(f"{key}: is only allowed together with p_wave_speed")
    return problems
