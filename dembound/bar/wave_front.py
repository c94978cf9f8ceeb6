"""How far waves in a bar can have come at a time, and where its motion starts."""

import numpy as np

from dembound.bar.lattice import lattice_of
from dembound.bar.scene import BarScene
from dembound.casefile.bar import BarCase
from dembound.motion.paths import Front, Source

SAMPLES = 400
"""Wave numbers at which group speeds are computed, per spacing of the horizon."""


def front_of_bar(scene: BarScene, time_step: float) -> Front:
    """The fastest waves of a bar that is stepped by time_step (s), at any stage of its method.

    With bonds up to m spacings Δx long, phase speeds are c(1 − (kΔx)²((m² + 1)/2 − ν²)/24): a row that disperses alike
    has at most the spacing Δx√((m² + 1)/2).
    """
    case, speed = scene.case, scene.case.bar.speed
    for bonds in case.method.stages(scene.rod):
        row = lattice_of(bonds, time_step, speed)
        groups = row.group_velocity(row.shortest * np.linspace(0.0, 1.0, SAMPLES * row.horizon, endpoint=False))
        speed = max(speed, float(np.nanmax(groups)))
    horizon = case.method.largest_horizon
    return Front(speed, scene.rod.spacing * float(np.sqrt(0.5 * (horizon**2 + 1))))


def sources_of_bar(case: BarCase) -> list[Source]:
    """Driven and loaded ends; a load spread over several nodes starts at the innermost one."""
    bar, speed = case.bar, case.bar.speed
    places = {"left": 0.0, "right": bar.length}
    sources = [
        Source((places[side], 0.0, places[side], 0.0), case.wave[name].start, case.wave[name].duration(), speed)
        for side, waves in case.driving.items()
        for name in waves.values()
    ]
    for load in case.load:
        wave, wide = case.wave[load.wave], (load.nodes - 1) * bar.length / bar.cells
        low, high = (0.0, wide) if load.side == "left" else (bar.length - wide, bar.length)
        sources.append(Source((low, 0.0, high, 0.0), wave.start, wave.duration(), speed))
    return sources
