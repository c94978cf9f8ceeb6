"""Cases under the linear law that their contacts obey in small motion about rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dembound.casefile.disks import DiskCase
from dembound.casefile.disks.material import Material
from dembound.casefile.types import LAWS, linear_law
from dembound.disks.material.confined import require_stiffness
from dembound.disks.scene import ground_of


def small_motion(case: DiskCase) -> DiskCase:
    """The case itself under a law that starts elastic; else without static stage, with springs for small motion.

    All contacts then have one stiffness: their mean about the stress at rest, times the factor by which the packing has
    its speed of P waves along x, or of S waves where these are held.

    Raises CaseError for a law that is not linear and names no linear law, and for contacts without pressure.
    """
    linear_law(case.material.law)
    law = LAWS[case.material.law]
    if law.starts_elastic:
        return case
    ground = ground_of(case)
    require_stiffness(ground)
    moduli = ground.moduli
    given = {"density": ground.density, "law": linear_law(law.name), "fric": moduli.fric, "damp": case.material.damp}
    twin = Material.model_validate(given | {"emod": moduli.emod, "pb_emod": 0.0, "kratio": moduli.kratio})
    linear = replace(case, material=twin, static=None)
    speeds = np.array([each.wave_speeds(0) for each in (ground, ground_of(linear))])
    ratio = float((speeds[0] / speeds[1])[~np.isnan(speeds[0])][0])
    return replace(linear, material=twin.model_copy(update={"emod": ratio**2 * moduli.emod}))
