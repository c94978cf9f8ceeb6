"""Reflection of waves by a side, on the packing of a case, without a run."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from dembound.boundaries import Motion, normal_axis
from dembound.boundaries.description import reflected
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import linear_law
from dembound.disks.matching import factors_in, homogenised_beta
from dembound.disks.reflection.arrivals import Arrival, arrivals_of, wide_frequencies, words_of
from dembound.disks.reflection.bricks import BrickInRow, end_of, end_scene
from dembound.disks.reflection.continuum_end import ContinuumEnd, beside_elements, copies_beside
from dembound.disks.reflection.meter import End, Meter, Reflections
from dembound.disks.reflection.smeared import by_smeared_supports
from dembound.disks.scene import DiskScene, build, ground_of, with_boundaries
from dembound.disks.stability import choose_step
from dembound.disks.surroundings.frequencies import frequencies_of
from dembound.errors import CaseError
from dembound.schemas import with_changes

__all__ = [
    "Arrival",
    "Measured",
    "Reflections",
    "compare_types",
    "layers_beside",
    "measure_side",
    "measured_sides",
    "seconds_of",
]

Report = Callable[[float], None]

ANGLES = (0.0, 10.0, 15.0, 20.0, 30.0, 40.0, 45.0, 50.0, 60.0, 70.0, 75.0, 80.0, 85.0)
"""Angles (degrees) at which reflections are computed by default."""

FREQUENCIES = 12
"""Number of frequencies by default."""

ROUNDING = 1e-9
"""Relative difference of factors β up to which they are the same."""


@dataclass(frozen=True)
class Measured:
    """Reflections of a side of a case.

    side, type : of the side. found : the reflections. matched : reflections with matched factors; None for sides
    without factors, or with matched ones. continuum : reflections, with the number of nodes, if the side and all
    absorbing sides were of type "outside"; None where they cannot be, and beside a narrow periodic body only for the
    angle 0. arrivals : waves that reach the side. gaps : Hz, the lowest frequency at which copies of the brick reflect
    waves of a type themselves, c/2L for bricks of length L along the normal. rock : reflected over incident velocity of
    the rock of a side, along its normal, by kind of wave.
    """

    side: str
    type: str
    found: Reflections
    matched: Reflections | None
    continuum: tuple[int, Reflections] | None
    arrivals: list[Arrival]
    gaps: dict[str, float]
    rock: Mapping[Motion, float] = field(default_factory=dict)


def measured_sides(case: DiskCase) -> list[str]:
    """The sides that represent the medium or rock beyond; raises CaseError if there are none."""
    stands_for = [side for side, table in case.boundary.items() if table.is_artificial or table.is_interface]
    sides = [side for side in stands_for if not _is_below_surface(case, side)]
    if not sides:
        raise CaseError(["boundary: has no side that absorbs; choose another one with --side"])
    return sides


def _is_below_surface(case: DiskCase, side: str) -> bool:
    """Whether a continuum ends above the side at a free surface, which returns everything."""
    return side == "top" and case.side(side).is_outside and "top" in case.packing.gaps(case.box)


PER_FREQUENCY, PER_DISK, PER_ANGLE = 0.08, 1.3e-4, 7e-7
"""CPU seconds for each frequency: of any side, by disk of the brick, and for each angle by the power 3/2 of their
number, as the disks along a side, whose full matrix is solved, are its root. They are within a factor of 1.5 of times
measured with bricks of 432 to 10,795 disks.
"""


def seconds_of(case: DiskCase, parts: int, angles: int, frequencies: int) -> float:
    """CPU seconds, about, in which `measure_side` measures so many sides, or parts of sides beside layers."""
    ground = ground_of(case)
    angles, disks = 1 if {0, 1} & {*ground.held} else angles, len(ground.brick.radii)
    return parts * frequencies * (PER_FREQUENCY + disks * (PER_DISK + PER_ANGLE * angles * disks**0.5))


def measure_side(
    case: DiskCase,
    side: str,
    angles: Sequence[float] = ANGLES,
    frequencies: int | Sequence[float] = FREQUENCIES,
    report: Report | None = None,
    *,
    quick: bool = False,
    layer: str | None = None,
) -> Measured:
    """Measure the reflection of a side of a case.

    angles : degrees from the normal, below 90. frequencies : Hz, or the number of frequencies of the case. report :
    receives every frequency (Hz) before it is computed. quick : by the equivalent continuum instead of disks, without a
    comparison with type "outside", see smeared.py. layer : name of one of `layers_beside`, if there are several.

    Raises CaseError for a law of no linear medium, for a periodic side, for a quick answer about an outside, and for
    invalid angles and frequencies.
    """
    problems = [f"--angle: is {a:g}, must be at least 0 and below 90 (degrees)" for a in angles if not 0.0 <= a < 90.0]
    if not isinstance(frequencies, int):
        problems += [f"--frequency: is {f:g}, must be above 0 (Hz)" for f in frequencies if not 0.0 < f < np.inf]
    if problems:
        raise CaseError(problems)
    linear_law(case.material.law)
    if _is_below_surface(case, side):
        raise CaseError(["--side: is top, beyond which the ground ends at a free surface, which returns everything"])
    given, case = case, _in_layer(case, side, layer)
    whole = build(case)
    ground, table = whole.ground, case.side(side)
    chosen = frequencies_of(case, ground, frequencies) if isinstance(frequencies, int) else np.sort(frequencies)
    arrivals = arrivals_of(given, side, ground)
    if table.is_outside and quick:
        raise CaseError([f"--quick: is not possible for side {side}, of type outside; leave it out"])
    axis, speeds = normal_axis(side), ground.wave_speeds(normal_axis(side))
    gaps = {kind: 0.5 * speed / float(ground.brick.size[axis]) for kind, speed in zip("ps", speeds, strict=True)}
    if table.is_outside:
        (found,) = _of_continuum(whole, side, choose_step(whole)[0], chosen, angles, report)
        return Measured(side, table.type, found, None, None, arrivals, gaps)
    if table.is_periodic:
        raise CaseError([f"--side: is {side}, which is periodic; must be a side at which the body ends"])
    scene = end_scene(case, side)
    own = factors_in(scene, side)
    best = {motion: homogenised_beta(scene, side, motion) for motion in own}  # nan where the motion is held
    known = {motion: beta for motion, beta in own.items() if table.is_interface and np.isfinite(best[motion])}
    rock = {motion: reflected(beta, best[motion]).real for motion, beta in known.items()}
    differs = any(abs(beta - best[motion]) > ROUNDING * best[motion] for motion, beta in own.items())
    unmatched = differs and not table.is_interface
    scenes = [scene, *([_matched(scene, side)] if unmatched else [])]
    if quick:
        found, *others = (by_smeared_supports(each, side, chosen, angles) for each in scenes)
        return Measured(side, table.type, found, others[0] if unmatched else None, None, arrivals, {}, rock)
    step, row = choose_step(whole)[0], BrickInRow(ground, side)
    other = None if table.is_interface else _as_continuum(case, side)
    ends: list[End] = [end_of(each, row) for each in scenes]
    at_once = other is not None and not _is_narrow(other) and beside_elements(ground, side, other.continua[0]) is ground
    if other is not None and at_once:
        ends.append(ContinuumEnd(other.continua[0], row))
    found, *others = Meter(row, step, *ends).measure(chosen, angles, report=report)
    if other is not None and not at_once:
        others += _of_continuum(other, side, step, chosen, angles, report)
    continuum = None if other is None else (other.continua[0].count, others[-1])
    return Measured(side, table.type, found, others[0] if unmatched else None, continuum, arrivals, gaps, rock)


def compare_types(
    case: DiskCase,
    side: str,
    tables: Sequence[Mapping[str, Any]],
    angles: Sequence[float],
    frequencies: Sequence[float] = (),
    report: Report | None = None,
    layer: str | None = None,
) -> tuple[dict[str, Reflections], list[Arrival]]:
    """Reflections of a side with other tables in its place, by table in words, and the arrivals of the case itself.

    angles, frequencies, report, layer : as of `measure_side`; by default frequencies of the whole spectrum. Raises
    CaseError for tables that the side cannot have, and for a law of no linear medium.
    """
    given, case = case, _in_layer(case, side, layer)
    ground, found = ground_of(case), {}
    chosen = np.sort(frequencies) if len(frequencies) else wide_frequencies(case, ground)
    for table in tables:
        changed = with_changes(case, {f"boundary.{side}": dict(table)})
        linear_law(changed.material.law)
        whole = build(changed)
        step = choose_step(whole)[0]
        if changed.side(side).is_outside:
            (one,) = _of_continuum(whole, side, step, chosen, angles, report)
        else:
            (one,) = Meter.of(side, step, end_scene(changed, side)).measure(chosen, angles, report=report)
        found[words_of(table)] = one
    return found, arrivals_of(given, side, ground)


def layers_beside(case: DiskCase, side: str) -> list[str]:
    """Names of the layers along a left or right side, from the surface down; none if there are fewer than two."""
    case = case.beside(side)
    if len(case.layer) < 2 or normal_axis(side) == 1:
        return []
    _, low, _, high = case.packing.box
    return list(case.layer_names[case.layer_at(high) : case.layer_at(low) + 1])


def _in_layer(case: DiskCase, side: str, layer: str | None) -> DiskCase:
    """The case with one layer everywhere, in steps of the case itself: by default the one at the side.

    Raises CaseError unless a side along several layers has the name of one.
    """
    whole, case = case, case.beside("right" if side == "right" else "left")
    if len(whole.layer) < 2:
        return case
    if (names := layers_beside(case, side)) and layer not in names:
        said = f"meets several layers, and reflects by layer; name one of {', '.join(names)}"
        raise CaseError([f"boundary.{side}: {said}"])
    number = case.layer_at(case.box[3 if side == "top" else 1])
    if layer and layer in names:
        number = case.layer_names.index(layer)
    alone = case.uniform_at([case.box[3], *case.layer_planes][number] - case.packing.radius)
    return replace(alone, run=case.run.model_copy(update={"time_step": choose_step(build(whole))[0]}))


def _of_continuum(
    scene: DiskScene,
    side: str,
    time_step: float,
    frequencies: np.ndarray,
    angles: Sequence[float],
    report: Report | None,
) -> list[Reflections]:
    """Reflections by the continuum of a scene; beside a narrow body along the normal only."""
    chosen = [0.0] if _is_narrow(scene) else angles
    return beyond(scene, side, time_step).measure(frequencies, chosen, report=report)


def _is_narrow(scene: DiskScene) -> bool:
    """Whether ties have the mean motion of elements, which passes on waves along the normal only."""
    assert scene.outside is not None
    return any(scene.outside.wall.mean)


def beyond(scene: DiskScene, side: str, time_step: float) -> Meter:
    """A meter of the continuum of a scene beyond a side, at time steps of a run, s."""
    assert scene.outside is not None
    copies = copies_beside(scene.ground, side, scene.outside)
    row = BrickInRow(beside_elements(scene.ground, side, scene.outside), side, copies)
    return Meter(row, time_step, ContinuumEnd(scene.outside, row))


def _matched(scene: DiskScene, side: str) -> DiskScene:
    """The scene with matched factors of the dashpots of a side."""
    table = scene.case.side(side)
    table = table.with_factors(dict.fromkeys(table.factors, "matched"))
    return with_boundaries(scene, replace(scene.case, boundary={**scene.case.boundary, side: table}))


def _as_continuum(case: DiskCase, side: str) -> DiskScene | None:
    """The case with a continuum beyond this and all absorbing sides; None where there can be none."""
    absorbing = {side, *(name for name, table in case.boundary.items() if table.is_artificial)}
    changes = {f"boundary.{name}": {"type": "outside"} for name in absorbing}
    try:
        return build(with_changes(case, changes))
    except CaseError:
        return None
