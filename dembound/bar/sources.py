"""Where the motion of a bar starts: driven and loaded ends."""

from dembound.casefile.bar import BarCase
from dembound.motion.paths import Source


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
