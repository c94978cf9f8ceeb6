"""Scatter of the motion between random packings: each seed is another sample of the rock."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from dembound.accuracy.judge import no_seed
from dembound.accuracy.runner import Runner, Shown, unseen
from dembound.casefile.disks import DiskCase
from dembound.errors import CaseError
from dembound.formulas.cause import Cause, Causes
from dembound.formulas.history import Motions
from dembound.results.histories import Quantity

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
