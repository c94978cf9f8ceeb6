"""Warnings about the ranges of a bar, known before the run: their sections, and how they meet."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator

import numpy as np

from dembound.bar.body import ROUNDING
from dembound.bar.scene import BarScene
from dembound.bar.stability import BELOW
from dembound.casefile.bar import BarCase

ALIKE = 1e-3
"""Relative difference up to which values of Δx/c count as equal."""

UNLIKE_SECTIONS = 100.0
"""Ratio of the sections of neighbours above which a warning is given: at 100 hardly 4 % of a force passes."""


def range_warnings(case: BarCase, time_step: float) -> Iterator[str]:
    """Warnings about ranges of a bar, one line each; time_step in s."""
    yield from _sections(case)
    yield from _bonded_impacts(case)
    yield from never_closing(case).values()
    yield from _impacts(case, time_step)


def _sections(case: BarCase) -> Iterator[str]:
    """Warnings about sections left to the default while others are given, and very different neighbouring sections."""
    parts, names = case.bar.parts, [each.name for each in case.bar.range]
    given = [part.section is not None or part.diameter is not None for part in parts]
    reported = set()
    for left, right in itertools.pairwise(range(len(parts))):
        areas = parts[left].area, parts[right].area
        if given[left] != given[right] and areas[0] != areas[1]:
            bare, other = (left, right) if given[right] else (right, left)
            if bare not in reported:
                reported.add(bare)
                yield (
                    f"bar.range[{bare + 1}, {names[bare]}]: has neither section nor diameter, so 1 m², beside "
                    f"{parts[other].area:.4g} m² of {names[other]}; give it one, or give [bar] that of all ranges"
                )
        elif max(areas) > UNLIKE_SECTIONS * min(areas):
            yield (
                f"bar.range[{right + 1}, {names[right]}]: its section, {areas[1]:.4g} m², is {areas[1] / areas[0]:.3g} "
                f"times that of {names[left]}, {areas[0]:.4g} m²; is one of them, or a diameter, in another unit?"
            )


def _bonded_impacts(case: BarCase) -> Iterator[str]:
    """Neighbours of different velocities that are bonded, so that they cannot part after their impact."""
    for number, (left, right) in enumerate(itertools.pairwise(case.bar.range), start=2):
        if right.interface == "bonded" and left.velocity != right.velocity:
            yield (
                f'bar.range[{number}, {right.name}].interface: is "bonded", while {left.name} has '
                f"{left.velocity:g} m/s at the start and {right.name} {right.velocity:g} m/s: they pull each other as "
                'hard as they push; give interface = "contact"'
            )


def never_closing(case: BarCase) -> dict[str, str]:
    """Contacts that never close within the run, by the name of the range on their right, each with a warning.

    Ranges fly at constant velocity until something sends waves; if waves are sent within the run, none is predicted.
    """
    pairs, duration = list(itertools.pairwise(case.bar.range)), case.run.duration
    if case.load or case.driving or not pairs or _held_in_flight(case):
        return {}
    if any(right.interface == "bonded" and left.velocity != right.velocity for left, right in pairs):
        return {}
    found = {}
    for number, (left, right) in enumerate(pairs, start=2):
        if right.interface == "bonded":
            continue
        approach, place = left.velocity - right.velocity, f"bar.range[{number}, {right.name}]"
        closes = right.gap / approach if approach > 0.0 else math.inf
        if closes < duration:
            return {}
        if approach > 0.0:
            found[right.name] = (
                f"{place}.gap: is {right.gap:g} m, which {approach:g} m/s close at {closes:.4g} s, not within "
                f"run.duration, {duration:g} s"
            )
        elif approach < 0.0:
            found[right.name] = (
                f"{place}: it and {left.name} part at {-approach:g} m/s and never meet; velocities are positive to the "
                "right"
            )
        elif right.gap > 0.0:
            found[right.name] = f"{place}.gap: is {right.gap:g} m, and never closes, as {left.name} is no faster"
    return found


def _held_in_flight(case: BarCase) -> bool:
    """Whether a range that moves at the start is at an end of the bar that is not free."""
    ends = {"left": case.bar.range[0], "right": case.bar.range[-1]}
    return any(each.velocity != 0.0 and not case.side(side).is_free for side, each in ends.items())


def _impacts(case: BarCase, time_step: float) -> Iterator[str]:
    """Impacts: velocities behind their fronts oscillate, least at a time step just below the Δx/c of all ranges."""
    if not any(each.velocity for each in case.bar.range):
        return
    steps = np.array([part.length / part.cells / part.speed for part in case.bar.parts])
    if np.ptp(steps) < ALIKE * steps.max():
        if time_step < (BELOW - ALIKE) * steps.max():
            yield (
                f"run.courant: is {time_step / steps.max():.3g}, so fronts of impacts overshoot by some 20 % of the "
                f"stress and ring; as Δx/c is alike in all ranges, courant = {BELOW:g} makes it shortest"
            )
        if np.isfinite(case.bar.least_strength) and all(part.fracture_energy is None for part in case.bar.parts):
            yield (
                "bar.range: fronts of impacts overshoot for some steps, and where several meet the tension can be "
                "twice that of waves, so that springs can break too early; give bar.fracture_energy, with which they "
                "open slowly"
            )
        return
    listed = ", ".join(f"{1e6 * step:.3g}" for step in steps)
    yield (
        f"bar.range: Δx/c differs, {listed} µs, so fronts of impacts oscillate from step to step, by some 20 % of the "
        "stress, which can break bonds though the stress at nodes does not show it; choose spacings with one Δx/c, and "
        f"run.courant = {BELOW:g}"
    )


def monitors_in_gaps(scene: BarScene) -> Iterator[str]:
    """Monitors in the gap between two ranges that do not touch yet."""
    for monitor in scene.case.monitor:
        for left, right in scene.rod.touching:
            margin = ROUNDING * right.end
            if left.end + margin < monitor.position < right.start - margin:
                place = scene.positions[scene.monitors[monitor.name], 0]
                yield (
                    f"monitor.{monitor.name}: is at {monitor.position:g} m, in the gap from {left.end:g} to "
                    f"{right.start:g} m between two ranges; it records the node at {place:g} m"
                )


def monitors_between_sections(scene: BarScene) -> Iterator[str]:
    """Warnings about monitors at a bonded interface of different sections; their stress is force over mean section."""
    names, ranges = [each.name for each in scene.case.bar.range], scene.rod.ranges
    for monitor, node in scene.monitors.items():
        for number, (left, right) in enumerate(itertools.pairwise(ranges[: len(names)])):
            if left.last == node == right.first and abs(left.section - right.section) > ALIKE * max(
                left.section, right.section
            ):
                mean = 0.5 * (left.section + right.section)
                before, behind = left.end - left.spacing, left.end + right.spacing
                yield (
                    f"monitor.{monitor}: is at the bonded interface of {names[number]}, {left.section:.4g} m², and "
                    f"{names[number + 1]}, {right.section:.4g} m²: its stress is the force over their mean, {mean:.4g} "
                    f"m², so that of neither; place it at {before:.6g} or {behind:.6g} m"
                )
