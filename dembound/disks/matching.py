"""How well a side's dashpots match the packing, from its homogenised stiffness alone; no wave is run."""

import math

from dembound.boundaries import Motion
from dembound.disks.scene import DiskScene, boundary_medium


def homogenised_beta(scene: DiskScene, side: str, motion: Motion) -> float:
    """β0 = (c_eff/c)·H/ΣD: homogenised over nominal wave speed, times the side's length over the sum of diameters.

    nan where waves of this motion do not run: it is held, or nothing resists it.
    """
    edge = scene.edges[side]
    index = 0 if motion == "p" else 1
    own = scene.ground.wave_speeds(edge.axis)[index]
    if math.isnan(own):
        return own
    medium = boundary_medium(scene.case, scene.ground, edge.axis)
    nominal = (medium.p_wave_speed, medium.s_wave_speed)[index]
    return own / nominal / edge.diameter_sum_ratio


def reflected(beta: float, matched: float) -> float:
    """Reflected over incident peak of a plane wave, (1 − β/β0)/(1 + β/β0), at dashpots of factor β; matched is β0."""
    return (matched - beta) / (matched + beta)
