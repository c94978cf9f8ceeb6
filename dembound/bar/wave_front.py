"""How far waves in a bar can have come at a time."""

from itertools import product

import numpy as np

from dembound.bar.lattice import lattice_of
from dembound.bar.scene import BarScene
from dembound.motion.paths import Front

SAMPLES = 400
"""Wave numbers at which group speeds are computed, per spacing of the horizon."""


def front_of_bar(scene: BarScene, time_step: float) -> Front:
    """The fastest waves of a bar that is stepped by time_step (s), at any stage of its method.

    With bonds up to m spacings Δx long, phase speeds are c(1 − (kΔx)²((m² + 1)/2 − ν²)/24): a row that disperses alike
    has at most the spacing Δx√((m² + 1)/2).
    """
    ranges = scene.rod.ranges
    speed = max(part.speed for part in ranges)
    for bonds, part in product(scene.case.method.stages(scene.rod), ranges):
        row = lattice_of(bonds, part, time_step)
        groups = row.group_velocity(row.shortest * np.linspace(0.0, 1.0, SAMPLES * row.horizon, endpoint=False))
        speed = max(speed, float(np.nanmax(groups)))
    horizon = scene.case.method.largest_horizon
    return Front(speed, max(part.spacing for part in ranges) * float(np.sqrt(0.5 * (horizon**2 + 1))))
