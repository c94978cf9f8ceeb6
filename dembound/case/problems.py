"""Mistakes that show only when tables are looked at together."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from dembound.boundaries import OPPOSITE, BoundaryTable, Free, Periodic
from dembound.boundaries.driven import Driven
from dembound.case.material import Material
from dembound.case.monitor import Monitor
from dembound.case.motion import Motion
from dembound.case.output import Output
from dembound.case.run import Run
from dembound.case.sentences import choices, show
from dembound.packings import PackingTable

DIRECTIONS = {"left": "xy", "right": "xy", "bottom": "yx", "top": "yx"}
"""Side -> the directions along its normal and across it."""


def problems_between(tables: Mapping[str, Any]) -> Iterator[str]:
    """Check the tables of a case against each other.

    `tables` has the fields of `Case` as keys. A table that is invalid on its own is None, and so is an
    invalid entry of `boundary`, `wave` or `monitor`: checks that would need it are left out.
    """
    yield from _unknown_waves(tables["boundary"], tables["wave"])
    yield from _lonely_periodic_sides(tables["boundary"])
    if tables["motion"]:
        yield from _driven_but_held(tables["boundary"], tables["motion"])
        if tables["material"]:
            yield from _nothing_to_match(tables["material"], tables["motion"])
    yield from _repeated_names(tables["monitor"])
    if tables["packing"]:
        yield from _monitors_outside(tables["monitor"], tables["packing"])
    if tables["run"]:
        yield from _steps_too_long(tables["run"], tables["output"])


def _drives(boundaries: Mapping[str, BoundaryTable | None]) -> Iterator[tuple[str, str, str, str]]:
    """All that is driven: side, key, name of the wave and direction, x or y."""
    for side, boundary in boundaries.items():
        if isinstance(boundary, Driven):
            for key, direction in zip(("wave_p", "wave_s"), DIRECTIONS[side], strict=True):
                if (name := getattr(boundary, key)) is not None:
                    yield side, key, name, direction


def _unknown_waves(boundaries: Mapping[str, BoundaryTable | None], waves: Mapping[str, object]) -> Iterator[str]:
    """Sides that name a wave the case does not define."""
    for side, key, name, _ in _drives(boundaries):
        if name not in waves:
            defined = f"defined: {choices(name, waves)}" if waves else "none is defined"
            yield f"boundary.{side}.{key}: {show(name)} is not a wave of this case; {defined}"


def _lonely_periodic_sides(boundaries: Mapping[str, BoundaryTable | None]) -> Iterator[str]:
    """Periodic sides whose opposite is something else."""
    for side, boundary in boundaries.items():
        opposite = boundaries.get(OPPOSITE[side], Free())
        if isinstance(boundary, Periodic) and opposite and not isinstance(opposite, Periodic):
            yield f'boundary.{side}.type: is "periodic", so boundary.{OPPOSITE[side]} must be periodic too'


def _driven_but_held(boundaries: Mapping[str, BoundaryTable | None], motion: Motion) -> Iterator[str]:
    """Sides driven along a direction in which nothing can move."""
    for side, key, _, direction in _drives(boundaries):
        if direction in motion.held:
            yield f"boundary.{side}.{key}: drives {direction}, which motion.held holds for every particle"


def _nothing_to_match(material: Material, motion: Motion) -> Iterator[str]:
    """A wave speed asked of a packing in which no P wave can run."""
    if material.match == "assembly" and {"x", "y"} <= set(motion.held):
        yield 'material.match: is "assembly", but motion.held holds x and y, so the packing has no P-wave speed'


def _repeated_names(monitors: Sequence[Monitor | None]) -> Iterator[str]:
    """Monitors whose histories would overwrite one another."""
    first: dict[str, int] = {}
    for number, monitor in enumerate(monitors, start=1):
        if monitor and first.setdefault(monitor.name, number) != number:
            yield f"monitor[{number}].name: {show(monitor.name)} is taken by monitor[{first[monitor.name]}]"


def _monitors_outside(monitors: Sequence[Monitor | None], packing: PackingTable) -> Iterator[str]:
    """Monitors that lie where no particle can be."""
    for number, monitor in enumerate(monitors, start=1):
        if monitor and not all(0.0 <= x <= size for x, size in zip(monitor.position, packing.size, strict=True)):
            yield (
                f"monitor[{number}, {monitor.name}].position: is {show(monitor.position)}, "
                f"must be in the scene, [0, 0] to {show(packing.size)} (m)"
            )


def _steps_too_long(run: Run, output: Output | None) -> Iterator[str]:
    """Intervals that the run is over before."""
    if run.time_step != "auto" and run.time_step > run.duration:
        yield f"run.time_step: is {run.time_step:g}, must be at most run.duration, {run.duration:g} (s)"
    if output and output.history_interval > run.duration:
        yield (
            f"output.history_interval: is {output.history_interval:g}, "
            f"must be at most run.duration, {run.duration:g} (s)"
        )
