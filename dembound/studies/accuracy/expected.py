"""The error that a choice is expected to have, from companions and by formulas."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from dembound.boundaries import normal_axis
from dembound.casefile.disks import DiskCase
from dembound.disks.loads import forces_of
from dembound.disks.scene import DiskScene
from dembound.disks.wave_front import slowest_speed
from dembound.packings.square import Square
from dembound.studies.accuracy.companions import QUANTITIES, Companions, quiet
from dembound.studies.chart.errors import QUIET
from dembound.studies.estimate.causes import CONTINUUM, GRID, SIDES, STEP, Cause, Causes, Recorded
from dembound.studies.estimate.delays import error_of_delay
from dembound.studies.estimate.disks import causes_by_formula
from dembound.studies.estimate.estimate import Estimate
from dembound.studies.estimate.walls import wall_error

UNKNOWN = 1.0
"""Error of a continuum whose error is not known: more than any bound."""


@dataclass(frozen=True)
class Expected:
    """An expected error. worst : of all monitors that move, RMS over RMS; by : its causes at the worst monitor."""

    worst: float
    by: dict[str, float]


def expected(causes: list[Cause], recorded: Mapping[str, Recorded]) -> Expected:
    """The largest error of all recorded quantities at monitors that are not quiet, and its causes that are not zero."""
    estimate = Estimate(recorded, Causes(causes))
    found = [
        (total, estimate.shares(name, quantity))
        for name in recorded
        for quantity in estimate.quantities(name)
        if name not in quiet(recorded, quantity, QUIET) and np.isfinite(total := estimate.total(name, quantity))
    ]
    worst, by = max(found, key=lambda each: each[0], default=(0.0, {}))
    return Expected(worst, {name: share for name, share in by.items() if share > 0.0})


def of_ground(companions: Companions, scene: DiskScene, time_step: float) -> tuple[list[Cause], list[Cause]]:
    """Causes that are known without companions: of the disks, and of a continuum and of driven sides.

    Those of disks are dispersion, by disks and steps together, steps of walls, and other places of monitors.
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
        *_places(companions, scene),
    ]
    return disks, [cause for cause in found if cause.name not in (GRID, STEP)]


def of_sides(companions: Companions, scene: DiskScene, time_step: float, wider: float) -> Cause:
    """The cause of sides that reflect."""
    return Cause(SIDES, "from companions", companions.of_sides(scene.case, scene, time_step, wider))


def _walls(case: DiskCase, scene: DiskScene, names: list[str]) -> Iterator[Cause]:
    """Walls of holes on a lattice, which are made of disks."""
    if not case.hole or not isinstance(case.packing, Square):
        return
    size = wall_error(case, scene.ground.brick.mean_diameter)
    yield Cause("walls", "by the disks along the radius of the smallest hole", {name: _both(size) for name in names})


def _both(size: float) -> dict[str, np.ndarray | float]:
    """An error of which only the size is known."""
    return dict.fromkeys(QUANTITIES, size)


def _places(companions: Companions, scene: DiskScene) -> Iterator[Cause]:
    """Monitors and loads at other places than in the given case, as their nearest disks are others."""
    speed = slowest_speed(scene.ground)
    errors: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in companions.recorded(scene).items():
        delay = _moved(companions.scene, scene, name) / speed
        velocity, displacement = error_of_delay(own.time, own.values["velocity"], partial(_constant, delay))
        errors[name] = {"velocity": velocity, "displacement": displacement}
    yield Cause("places", "by the way that waves take between the disks of monitors and loads", errors)


def _constant(delay: float, omega: np.ndarray) -> np.ndarray:
    """The same delay (s) at all angular frequencies."""
    return np.full_like(omega, delay)


def _moved(given: DiskScene, scene: DiskScene, name: str) -> float:
    """How far (m) the particle of a monitor is elsewhere than in the given scene, seen from where waves start."""
    if given.case.driving and not any(load.wave for load in given.case.load):
        return max(abs(_beyond(scene, side, name) - _beyond(given, side, name)) for side in given.case.driving)
    moved = _seen_from_loads(scene, name) - _seen_from_loads(given, name)
    return float(np.hypot(*moved.T).max())


def _beyond(scene: DiskScene, side: str, name: str) -> float:
    """Distance (m) of the particle of a monitor from those of a driven side, or from its plane beside a continuum."""
    axis, place = normal_axis(side), scene.monitored[name]
    plane = scene.case.size[axis] if side in ("right", "top") else 0.0
    if not scene.case.side(side).is_outside:
        plane = float(scene.edges[side].positions[:, axis].mean())
    return abs(float(place[axis]) - plane)


def _seen_from_loads(scene: DiskScene, name: str) -> np.ndarray:
    """Where (k, 2) m the particle of a monitor is, seen from the middle of each load, else from the origin."""
    place = scene.monitored[name]
    local = [load for load in scene.case.load if load.pressure is None and not load.is_everywhere]
    return np.array([place - _middle(scene, *forces_of(load, scene)) for load in local] or [place])


def _middle(scene: DiskScene, nodes: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """The middle (2,) m of forces (k, 3) on nodes."""
    return np.average(scene.positions[nodes], axis=0, weights=np.hypot(*forces[:, :2].T))
