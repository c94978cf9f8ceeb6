"""Errors where contacts open or slide, from companions: of the time step, and of the rest from which a run begins."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from dembound.accuracy.of_disks.companions import QUANTITIES, Companions
from dembound.accuracy.runner import Run, at_step
from dembound.casefile.disks import DiskCase
from dembound.casefile.types import LAWS
from dembound.disks.contacts.pairs import BREAK_TIME
from dembound.disks.scene import DiskScene
from dembound.formulas.disks.waves import is_square_lattice

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
    is_own, (case, step), run = _runs_own(companions), _with_contacts(companions), _sliding(companions)
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
    if _runs_own(companions) or found is None:
        return found
    force = found["mean_residual"] * companions.scene.ground.brick.mean_diameter / companions.diameter
    rests_elastically = found["elastic"] and is_square_lattice(companions.scene.ground)
    return {**found, "mean_residual": force, "elastic": rests_elastically}


def _runs_own(companions: Companions) -> bool:
    """Whether the given case itself is run where contacts may open or slide, as that is affordable."""
    return OFTEN * companions.scene.count * companions.case.run.duration / companions.time_step <= companions.most


def _with_contacts(companions: Companions) -> tuple[DiskCase, float]:
    """The case or companion that is run where contacts may open or slide, and its step, s."""
    return (companions.case, companions.time_step) if _runs_own(companions) else (companions.own, companions.step)


def _sliding(companions: Companions) -> Run:
    """The run where contacts may open or slide."""
    return companions.runner.run(at_step(*_with_contacts(companions)), companions.named("where contacts open or slide"))
