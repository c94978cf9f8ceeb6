"""Sources of motion of a bar, and the front of its waves."""

import numpy as np

from dembound.bar.lattice import even_lattices
from dembound.bar.scene import BarScene
from dembound.casefile.bar import BarCase
from dembound.motion.paths import Front, Source


def sources_of_bar(case: BarCase) -> list[Source]:
    """Driven and loaded ends and moving ranges; a load spread over several nodes starts at the innermost one.

    A range that moves at the start sends waves from when it meets the next one until its own wave has returned once.
    """
    bar = case.bar
    speed = min(part.speed for part in bar.parts)
    places = {"left": 0.0, "right": bar.length}
    sources = [
        Source((places[side], 0.0, places[side], 0.0), case.wave[name].start, case.wave[name].duration(), speed)
        for side, waves in case.driving.items()
        for name in waves.values()
    ]
    for load in case.load:
        wave, end = case.wave[load.wave], bar.end(load.side)
        wide = (load.nodes - 1) * end.length / end.cells
        low, high = (0.0, wide) if load.side == "left" else (bar.length - wide, bar.length)
        sources.append(Source((low, 0.0, high, 0.0), wave.start, wave.duration(), speed))
    gaps = sum(given.gap for given in bar.range)
    for given, part, start in zip(bar.range, bar.parts, bar.starts, strict=False):
        if given.velocity != 0.0:
            over = gaps / abs(given.velocity) + 2.0 * part.length / part.speed
            sources.append(Source((start, 0.0, start + part.length, 0.0), 0.0, over, speed))
    return sources


SAMPLES = 400
"""Wave numbers at which group speeds are computed, per spacing of the horizon."""


def front_of_bar(scene: BarScene, time_step: float) -> Front:
    """The fastest waves of a bar that is stepped by time_step (s), at any stage of its method.

    With bonds up to m spacings Δx long, phase speeds are c(1 − (kΔx)²((m² + 1)/2 − ν²)/24): a row of nodes bonded to
    neighbours only that has the same dispersion has at most the spacing Δx√((m² + 1)/2).
    """
    ranges = scene.rod.ranges
    speed = max(part.speed for part in ranges)
    for row in even_lattices(scene.case.method.stages(scene.rod), ranges, time_step):
        groups = row.group_velocity(row.shortest * np.linspace(0.0, 1.0, SAMPLES * row.horizon, endpoint=False))
        speed = max(speed, float(np.nanmax(groups)))
    horizon = scene.case.method.largest_horizon
    return Front(speed, max(part.spacing for part in ranges) * float(np.sqrt(0.5 * (horizon**2 + 1))))
