"""How much the motion depends on the seed of a random packing: a second run, with another one.

Two packings of the same recipe are two samples of the same rock. If the motion of each differs from the mean of all by
errors of the same size, independent of each other, their difference is √2 times as large as either.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from dembound.accuracy.cause import Cause, Causes
from dembound.accuracy.history import Motions
from dembound.accuracy.judge import no_seed
from dembound.accuracy.runner import Runner
from dembound.casefile.disks import DiskCase
from dembound.errors import CaseError
from dembound.results.histories import Quantity

PACKING = "packing"

MOTIONS: tuple[Quantity, ...] = ("velocity", "displacement")


def cause_of_packing(case: DiskCase, recorded: Motions, work: float) -> Causes:
    """What the seed of a random packing adds to the motion of its monitors, from one more run as long as the case's.

    case : to the end of the run. work (particle-steps) : of the run. Raises CaseError for a packing without a seed, and
    the errors of runs.
    """
    packing = case.packing.reseeded(1)
    if packing is None and not case.packing.is_lattice:
        raise CaseError([f'--second-seed: packing.pattern = "{case.packing.pattern}" has no other seed'], case.name)
    if packing is None:
        raise no_seed(case)
    ended = {"until": type(case.run).model_fields["until"].default, "checkpoint": 0.0}
    other = replace(case, packing=packing, run=case.run.model_copy(update=ended))
    run = Runner().run(other)
    errors: dict[str, dict[str, np.ndarray | float]] = {}
    for name, own in recorded.items():
        other_motion = run.motions[name].at(own.time)
        errors[name] = {
            quantity: (own.values[quantity] - other_motion.values[quantity][:, :2]) / math.sqrt(2.0)
            for quantity in MOTIONS
        }
    given = case.packing.given()
    seed = ", ".join(f"{key} {value}" for key, value in packing.given().items() if given.get(key) != value)
    words = f"from a run with the {seed}: the difference over √2"
    return Causes([Cause(PACKING, words, errors, is_sample=True)], cost=run.work / work)
