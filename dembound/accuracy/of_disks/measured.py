"""Errors from companions and further runs: by misplaced disks, where contacts slide, and between random packings.

Disks are at other places than asked for at monitors, under loads, and held by sides. To the first order their errors
are the change of motion by one more row of larger disks at sides that stay. Where contacts open or slide, errors are
those of the time step, and of the rest from which a run begins. Each seed of a random packing is another sample of the
rock.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from dembound.accuracy.judge import no_seed
from dembound.accuracy.of_disks.companions import QUANTITIES, Companions
from dembound.accuracy.runner import Run, Runner, Shown, at_step, unseen
from dembound.boundaries import SIDES, is_far, normal_axis
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.contacts.pairs import BREAK_TIME
from dembound.disks.scene import DiskScene
from dembound.errors import CaseError
from dembound.formulas.cause import Cause, Causes
from dembound.formulas.disks.entry import depths_held
from dembound.formulas.disks.places import places_of_loads
from dembound.formulas.disks.waves import is_square_lattice
from dembound.formulas.history import Motions
from dembound.results.histories import Quantity

LEAST_SHIFT = 1e-6
"""Shift of a load, over the diameter of companions, from which on its way to surfaces counts."""


def errors_of_places(companions: Companions, scene: DiskScene) -> dict[str, dict[str, np.ndarray | float]]:
    """Error (k, 2) by monitors and loads that are not at the requested places, by monitor and quantity.

    Monitors and loads act at the nearest disks. Of several loads, of whose motion only the sum is known, the one
    with the largest error counts. A load at another place also has other distances from surfaces, from which its
    waves return earlier or later.
    """
    there, asked, loads = companions.places_of(scene), _asked(companions.case, scene), _shifts_of_loads(scene)
    own = companions.motion_at(companions.far, there)
    each = [_unmoved(companions, {name: there[name] + asked[name] + load for name in there}, load) for load in loads]
    return {
        name: {q: max((own[name][q] - other[name][q] for other in each), key=np.linalg.norm) for q in QUANTITIES}
        for name in own
    }


def _unmoved(
    companions: Companions, places: Mapping[str, np.ndarray], shift: np.ndarray
) -> dict[str, dict[str, np.ndarray]]:
    """Motion (k, 2) at places (2,) m, by monitor, before they and the loads were shifted relative to fixed sides.

    shift : (2,) m. To the first order, from the change by one more row of disks at these sides.
    """
    far, cell = companions.motion_at(companions.far, places), companions.lattice.ground.brick.mean_diameter
    found = {name: dict(own) for name, own in far.items()}
    for side in filter(partial(_stays, companions.case), SIDES):
        towards = float(shift[normal_axis(side)]) * (1.0 if is_far(side) else -1.0) / cell
        if abs(towards) < LEAST_SHIFT:
            continue
        away = companions.motion_at(companions.with_row_at(side), places)
        for name, own in far.items():
            for q, values in own.items():
                found[name][q] = found[name][q] + towards * (away[name][q] - values)
    return found


def errors_of_held_side(
    companions: Companions, scene: DiskScene, side: str
) -> dict[str, dict[str, np.ndarray | float]]:
    """Error (k, 2) of a side that holds disks at a depth s inside of its plane, by monitor and quantity.

    Companions are lattices, which hold disks of the diameter D' at D'/2. One more row of them puts these as far
    outside of the plane, so that the difference v(D'/2) - v(-D'/2) is the change over D' about the plane. Where
    motion along the side is free, mass begins at the plane and must stay there: a mirror plane holds the same
    components at the plane, and the difference is the change over D'/2. To the first order the error is s over that
    distance times the difference, with the mean s of P and S waves, of which motion is the sum: on a lattice D/2
    and 0.77 D at a fixed side.
    """
    places, table = companions.places_of(scene), companions.case.side(side)
    far, cell = companions.motion_at(companions.far, places), companions.lattice.ground.brick.mean_diameter
    depths = depths_held(scene, side).values()
    if {0, 1} & {*table.prescribed(normal_axis(side))} == {normal_axis(side)}:
        other, way = companions.with_mirror_at(side), 0.5 * cell
    else:
        other, way = companions.with_row_at(side), cell
    there = companions.motion_at(other, places)
    share = sum(depths) / (len(depths) * way)
    return {name: {q: share * (own[q] - there[name][q]) for q in QUANTITIES} for name, own in far.items()}


def is_moved(scene: DiskScene) -> bool:
    """Whether a monitor or a load that starts waves is at another place than the requested one, but for rounding."""
    shifts = [*_asked(scene.case, scene).values(), *_shifts_of_loads(scene)]
    return bool(np.abs(shifts).max() > LEAST_SHIFT * scene.ground.brick.mean_diameter)


def _asked(case: DiskCase, scene: DiskScene) -> dict[str, np.ndarray]:
    """By monitor, the way (2,) m from its disk in a scene to its place in the case that the scene stands for."""
    return {each.name: np.subtract(each.position, scene.monitored[each.name]) for each in case.monitor}


def _shifts_of_loads(scene: DiskScene) -> list[np.ndarray]:
    """The ways (2,) m from requested to real places of the loads that start waves; one of 0 without such loads."""
    return [each.middle - each.asked for each in places_of_loads(scene)] or [np.zeros(2)]


def sides_with_rows(companions: Companions, scene: DiskScene) -> list[str]:
    """The sides at which errors of places need a companion with one more row: loads are shifted along their normals."""
    least = LEAST_SHIFT * companions.lattice.ground.brick.mean_diameter
    shifts = np.abs(_shifts_of_loads(scene)).max(axis=0)
    return [side for side in SIDES if _stays(companions.case, side) and shifts[normal_axis(side)] >= least]


def _stays(case: DiskCase, side: str) -> bool:
    """Whether a side reflects and cannot move: a surface or the end of a block."""
    table = case.side(side)
    return not (table.is_artificial or table.is_periodic or table.waves)


OFTEN = 3.0
"""Work of a run and of one with half its step, over the work of the run."""

OF_LARGER = 2.2
"""Errors of the time step where contacts open or slide, over those of disks 1.6 times as large: 0.3 to 4.6 times (30
velocities)."""


def errors_of_steps(
    companions: Companions, scene: DiskScene, time_step: float
) -> dict[str, dict[str, np.ndarray | float]]:
    """Error (k, 2) of the time step (s) where contacts open or slide, by monitor and quantity: a random sample.

    A contact opens, slides or closes up to a step late, and others follow, so errors are random and grow with the
    first power of the step: the difference to a run with half the step has √(1 + 1/4) times their RMS. The given
    case is run with both steps if that is affordable, else its companion, whose error scales with the step over its
    limit, which is proportional to the diameter. Empty where the law remains elastic.
    """
    is_own, (case, step), run = runs_own(companions), _with_contacts(companions), _sliding(companions)
    if not any(LAWS[name].has_history for name in run.laws):
        return {}
    shorter = companions.runner.run(at_step(case, 0.5 * step), companions.named("with half the step"))
    end, time = min(run.finding(BREAK_TIME), shorter.finding(BREAK_TIME)), next(iter(companions.far.values())).time
    own, half = ({name: each.at(time) for name, each in one.motions.items()} for one in (run, shorter))
    if is_own:
        found = {name: {q: (own[name].values[q] - half[name].values[q])[:, :2] for q in QUANTITIES} for name in own}
    else:
        with_step, with_half = (companions.motion_at(motions, companions.places_of(scene)) for motions in (own, half))
        found = {name: {q: with_step[name][q] - with_half[name][q] for q in QUANTITIES} for name in with_step}
    diameter = companions.scene.ground.brick.mean_diameter if is_own else companions.diameter
    times = time_step / step * diameter / scene.ground.brick.mean_diameter / math.sqrt(1.25)
    known = times * (1.0 if is_own else OF_LARGER) * (time < end)[:, None]
    return {name: {q: known * each for q, each in by_quantity.items()} for name, by_quantity in found.items()}


def settled_of(companions: Companions) -> Mapping[str, Any] | None:
    """Numbers of the static stage, see `describe_static`; None without one, and under laws without history.

    Forces of a companion are in proportion to its diameter. Its lattice may come to rest elastically where contacts
    of a random packing slide, which therefore count as sliding.

    Raises the errors of running the case or its companion.
    """
    if companions.case.static is None or not companions.scene.has_history:
        return None
    found = _sliding(companions).settled
    if runs_own(companions) or found is None:
        return found
    force = found["mean_residual"] * companions.scene.ground.brick.mean_diameter / companions.diameter
    rests_elastically = found["elastic"] and is_square_lattice(companions.scene.ground)
    return {**found, "mean_residual": force, "elastic": rests_elastically}


def runs_own(companions: Companions) -> bool:
    """Whether the given case itself is run where contacts may open or slide, as that is affordable."""
    return OFTEN * companions.scene.count * companions.case.run.duration / companions.time_step <= companions.most


def _with_contacts(companions: Companions) -> tuple[DiskCase, float]:
    """The case or companion that is run where contacts may open or slide, and its step, s."""
    return (companions.case, companions.time_step) if runs_own(companions) else (companions.own, companions.step)


def _sliding(companions: Companions) -> Run:
    """The run where contacts may open or slide."""
    return companions.runner.run(at_step(*_with_contacts(companions)), companions.named("where contacts open or slide"))


PACKING = "packing"

MOTIONS: tuple[Quantity, ...] = ("velocity", "displacement")


def cause_of_packing(case: DiskCase, motions: Motions, seeds: int, shown: Shown = unseen) -> Causes:
    """The scatter of the monitors' motion between random packings, from runs with several seeds.

    The difference of one motion from the mean of n, times √(n/(n − 1)), has the size of the error of a packing.

    motions : by monitor, at the times at which it is found. shown : see `Runner`. Raises CaseError for a packing
    without a seed, and the errors of runs.
    """
    runner = Runner(shown=shown)
    runs = [runner.run(each, f"random packing {k + 1} of {seeds}") for k, each in enumerate(_reseeded(case, seeds))]
    parts: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in motions.items():
        there = [run.motions[name].at(own.time) for run in runs]
        parts[name] = {
            quantity: math.sqrt(seeds / (seeds - 1)) * (each[0] - np.mean(each, axis=0))
            for quantity in MOTIONS
            for each in [[motion.values[quantity][:, :2] for motion in there]]
        }
    words = f"from runs with {seeds} seeds: how each differs from their mean"
    return Causes([Cause(PACKING, words, parts, "measured", of_disks=True, is_sample=True)])


def _reseeded(case: DiskCase, seeds: int) -> Iterator[DiskCase]:
    """The case with several seeds, its own first, run to its end."""
    ended = {"until": type(case.run).model_fields["until"].default, "checkpoint": 0.0}
    for k in range(seeds):
        packing = case.packing.reseeded(k)
        if packing is None and not case.packing.is_lattice:
            raise CaseError([f'--seeds: packing.pattern = "{case.packing.pattern}" has no other seed'], case.name)
        if packing is None:
            raise no_seed(case)
        yield replace(case, packing=packing, run=case.run.model_copy(update=ended))
