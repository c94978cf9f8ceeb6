"""Warnings about waves that are used for two quantities, and about histories that are probably wrong."""

from collections.abc import Iterator
from typing import Any

from dembound.casefile.model import Case
from dembound.waves.sampling import CUT
from dembound.words import percent


def wave_use_warnings(case: Case) -> Iterator[str]:
    """Warnings about the use of waves, one line each."""
    yield from _two_quantities(case)
    yield from _jumps(case)
    yield from _doubts(case)


def users_of(case: Case, name: str) -> tuple[list[str], list[str]]:
    """The keys that take a wave as a velocity, and those that take it as the factor of a load."""
    velocities = [
        f"boundary.{side}.wave_{motion}"
        for side, waves in case.driving.items()
        for motion, each in waves.items()
        if each == name
    ]
    incident = getattr(case, "incident", None)
    velocities += ["incident.wave"] if incident is not None and incident.wave == name else []
    return velocities, [f"load.{load.name}" for load in case.load if load.wave == name]


def _two_quantities(case: Case) -> Iterator[str]:
    """Waves that are the velocity of a side and the factor of a load."""
    for name, wave in case.wave.items():
        velocities, factors = users_of(case, name)
        if velocities and factors:
            both = f"the velocity at {' and '.join(velocities)} and the factor of {' and '.join(factors)}"
            peak = f"{wave.peak():.4g}"
            yield f"wave.{name}: is {both}: its peak is {peak} m/s at the one and {peak} without unit at the other"


def _doubts(case: Case) -> Iterator[str]:
    """Warnings about measured histories whose units or samples are probably wrong, by use."""
    for name, wave in case.wave.items():
        velocities, _ = users_of(case, name)
        uses = [("m/s", 1.0)] if velocities else [_read_as(load) for load in case.load if load.wave == name]
        for doubt in wave.doubts(*uses[0]) if uses else ():
            yield f"wave.{name}: {doubt}"


def _read_as(load: Any) -> tuple[str, float]:
    """The unit in which a load takes its wave's values, and the factor by which it multiplies them."""
    if (pressure := getattr(load, "pressure", None)) is not None:
        return "Pa", pressure
    return ("N" if load.force is not None else "m/s²"), max(map(abs, load.vector))


def _jumps(case: Case) -> Iterator[str]:
    """Warnings about histories with a nonzero first or last value, at which they jump within the run."""
    for name, wave in case.wave.items():
        velocities, factors = users_of(case, name)
        if not velocities and not factors:
            continue
        unit = " m/s" if velocities else ""
        ends = [
            (end, time, value)
            for end, time, value in wave.ends()
            if 0.0 <= time < case.run.duration and abs(value) > CUT * wave.peak()
        ]
        if ends:
            listed = " and ".join(
                f"{end} at {value:.4g}{unit}, {percent(abs(value) / wave.peak())} of its peak, at {time:.4g} s"
                for end, time, value in ends
            )
            yield f"wave.{name}: {listed}, a jump from or to 0 beyond it; lead its file to 0 there, or shift its values"
