"""Checks between tables, used for cases of disks and of bars."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from dembound.boundaries import Boundary, driven_components
from dembound.casefile.messages import choices, show
from dembound.casefile.output import Output
from dembound.casefile.run import Run

MOST_MONITORS = 1000
"""Largest number of monitors: their records are checked for damage within seconds, see `results.structure`."""


def unknown_waves(named: Iterable[tuple[str, str]], waves: Mapping[str, object]) -> Iterator[str]:
    """Keys that name a wave the case does not define; named : key -> name of the wave."""
    for place, name in named:
        if name not in waves:
            defined = f"defined: {choices(name, waves)}" if waves else "none is defined"
            yield f"{place}: {show(name)} is not a wave of this case; {defined}"


def driving_waves(sides: Mapping[str, Boundary | None]) -> Iterator[tuple[str, str]]:
    """Keys of sides that name a wave -> its name."""
    for side, table in sides.items():
        for motion, name in table.waves.items() if table else ():
            yield f"boundary.{side}.wave_{motion}", name


def repeated_names(key: str, tables: Sequence[Any]) -> Iterator[str]:
    """Holes, loads or monitors whose results would overwrite one another."""
    first: dict[str, int] = {}
    for number, table in enumerate(tables, start=1):
        if table and first.setdefault(table.name, number) != number:
            yield f"{key}[{number}].name: {show(table.name)} is taken by {key}[{first[table.name]}]"


def too_many(monitors: Sequence[Any]) -> Iterator[str]:
    """Too many monitors."""
    if len(monitors) > MOST_MONITORS:
        yield f"monitor: there are {len(monitors):,}, must be {MOST_MONITORS:,} or less; snapshots have all places"


def never_past_peak(run: Run, sides: Mapping[str, Boundary | None]) -> Iterator[str]:
    """A run that ends after the peak of the forces on driven sides, without such a side, or shorter than the fall."""
    if run.until == "peak" and None not in sides.values() and not any(True for _ in driven_components(sides)):
        yield 'run.until: is "peak", but no side prescribes the motion of a wave; give one type = "velocity"'
    if run.peak_for is not None and run.peak_for > run.duration:
        yield f"run.peak_for: is {run.peak_for:g}, must be at most run.duration, {run.duration:g} (s)"


def never_silent(run: Run, monitors: Sequence[Any]) -> Iterator[str]:
    """A run that ends with its monitors at rest, but has no monitors or is shorter than the time at rest."""
    if run.until == "silent" and not monitors:
        yield f'run.until: is "{run.until}", but the case has no monitor; give a [[monitor]]'
    if run.silent_for is not None and run.silent_for > run.duration:
        yield f"run.silent_for: is {run.silent_for:g}, must be at most run.duration, {run.duration:g} (s)"


def never_estimated(output: Output, monitors: Sequence[Any]) -> Iterator[str]:
    """A request for errors at monitors in a case without monitors."""
    if output.estimate and not monitors:
        yield "output.estimate: is true, but the case has no monitor whose error could be estimated; give a [[monitor]]"


def steps_too_long(run: Run, output: Output | None) -> Iterator[str]:
    """Time step and intervals that are longer than the run."""
    if run.time_step != "auto" and run.time_step > run.duration:
        yield f"run.time_step: is {run.time_step:g}, must be at most run.duration, {run.duration:g} (s)"
    for key in ("history_interval", "side_interval", "energy_interval"):
        if output and (interval := getattr(output, key)) > run.duration:
            yield f"output.{key}: is {interval:g}, must be at most run.duration, {run.duration:g} (s)"
