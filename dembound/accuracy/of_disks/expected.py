"""Causes of the error that a choice is expected to have, from companions and by formulas."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from dembound.accuracy.cause import CONTINUUM, GRID, SIDES, STEP, Cause
from dembound.accuracy.delays import error_of_delay
from dembound.accuracy.of_disks.causes import causes_by_formula
from dembound.accuracy.of_disks.companions import QUANTITIES, Companions
from dembound.accuracy.of_disks.near import errors_near_loads, wall_error
from dembound.boundaries import normal_axis, plane_of
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene

UNKNOWN = 1.0
"""Error of a continuum whose error is not known: more than any bound."""


def of_ground(companions: Companions, scene: DiskScene, time_step: float) -> tuple[list[Cause], list[Cause]]:
    """Causes that are known without companions: of the disks, and of a continuum and of driven sides.

    Those of disks are dispersion, by disks and steps together, what disks near loads and walls do, and other places of
    monitors.
    """
    case, recorded = scene.case, companions.recorded(scene)
    found = causes_by_formula(case, scene, recorded, time_step)
    if scene.outside is not None and not any(cause.name == CONTINUUM for cause in found):
        jumps = {name: _both(UNKNOWN) for name in recorded}
        found.append(Cause(CONTINUUM, "not known for waves that jump", jumps))
    delays = [cause for cause in found if cause.name in (GRID, STEP)]
    together: dict[str, dict[str, np.ndarray | float]] = {
        name: {
            q: sum((np.asarray(cause.errors[name][q]) for cause in delays), np.zeros_like(own.values[q]))
            for q in QUANTITIES
        }
        for name, own in recorded.items()
    }
    disks = [
        Cause("disks and steps", "by the dispersion of plane waves", together),
        *_walls(case, scene, list(recorded)),
        Cause("near loads", "by its measured size", {n: errors_near_loads(scene, own) for n, own in recorded.items()}),
        *_places(companions, scene),
    ]
    return disks, [cause for cause in found if cause.name not in (GRID, STEP)]


def of_sides(companions: Companions, scene: DiskScene, time_step: float, wider: float) -> Cause:
    """The cause of sides that reflect."""
    return Cause(SIDES, "from companions", companions.of_sides(scene.case, scene, time_step, wider))


def _walls(case: DiskCase, scene: DiskScene, names: list[str]) -> Iterator[Cause]:
    """Walls of holes on a lattice, which are made of disks."""
    if not case.hole or not case.packing.is_lattice:
        return
    size = wall_error(case, scene.ground.brick.mean_diameter)
    yield Cause("walls", "by the disks along the radius of the smallest hole", {name: _both(size) for name in names})


def _both(size: float) -> dict[str, np.ndarray | float]:
    """An error of which only the size is known."""
    return dict.fromkeys(QUANTITIES, size)


def _places(companions: Companions, scene: DiskScene) -> Iterator[Cause]:
    """Monitors, loads and the disks that waves start from are elsewhere than in the given case.

    Of several loads, of whose motion only the sum is known, the one by which the motion differs most counts.
    """
    late = _later(companions.scene, scene)
    each = companions.moved(scene)
    errors: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in companions.recorded(scene).items():
        undone = error_of_delay(own.time, own.values["velocity"], partial(_constant, -late))  # v(t) − v(t − late)
        less = dict(zip(QUANTITIES, undone, strict=True))
        errors[name] = {q: max((moved[name][q] for moved in each), key=np.linalg.norm) - less[q] for q in QUANTITIES}
    yield Cause("places", "by the motion between the disks of companions", errors)


def _constant(delay: float, omega: np.ndarray) -> np.ndarray:
    """One delay (s) for all angular frequencies (k,) rad/s."""
    return np.full_like(omega, delay)


def _later(given: DiskScene, scene: DiskScene) -> float:
    """How much later (s) waves start than in the given scene, at disks that are nearer the plane of a driven side.

    Of several driven sides that with the largest difference counts.
    """
    found = [0.0]
    for side, waves in scene.case.driving.items():
        speeds = [scene.ground.wave_speeds(normal_axis(side))[0 if motion == "p" else 1] for motion in waves]
        found.append((_depth(given, side) - _depth(scene, side)) / min(speeds))
    return max(found, key=abs)


def _depth(scene: DiskScene, side: str) -> float:
    """How far (m) inside a side the disks are at which waves enter, 0 beside a continuum."""
    if scene.case.side(side).is_outside:
        return 0.0
    middle = float(scene.edges[side].positions[:, normal_axis(side)].mean())
    return abs(middle - plane_of(side, scene.case.box))
