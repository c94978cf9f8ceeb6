"""Where the motion of a bar starts: driven and loaded ends, and ranges that move at the start."""

from dembound.casefile.bar import BarCase
from dembound.motion.paths import Source


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
