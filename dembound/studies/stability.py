"""The largest stable time step of a scene with its dampers, springs and columns, measured.

The limit from the largest eigenvalue (disks/stability.py, bar/stability.py) assumes that centred dampers, held
components and one-sided seams do not lower it. Here noise is stepped (noise.py) in the scene without loads and waves
(`Kind.trials`): short runs around the limit, and a long one at the case's own step.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from dembound.casefile import Case
from dembound.errors import CaseError
from dembound.kinds import kind_of
from dembound.motion.stability import Trial
from dembound.studies.noise import COARSE, RESOLUTION, SAMPLES, Course, LongRun, long_run, short_run

FACTORS = 1.0 + 0.5 * RESOLUTION, 1.0 + COARSE, 2.0
"""Ratios of trial steps to the computed limit, or of the limit to trial steps, to bracket the largest stable one."""

LONG = 0.8
"""Computed seconds of one core for the steps of all long runs, so that all machines do equally many."""

LEAST, MOST = 5_000, 100_000
"""Least and largest number of steps of a long run by default."""

Report = Callable[[str], None]
"""Called with a line about each run that is done."""


@dataclass
class Stability:
    """The measured stability of one trial.

    Attributes
    ----------
    trial : the scene and its computed limit.
    below, above : steps (s) between which the largest stable one lies; above is infinite if noise grew at none.
    calm, growing : the short runs at these steps.
    long_runs : at the case's own step, one for each part.
    """

    trial: Trial
    below: float = 0.0
    above: float = np.inf
    calm: Course = field(default_factory=Course)
    growing: Course = field(default_factory=Course)
    long_runs: list[LongRun] = field(default_factory=list)

    @property
    def measured(self) -> float:
        """The largest stable step (s): the middle of its bracket, infinite if noise grew at no step."""
        return 0.5 * (self.below + self.above)

    @property
    def width(self) -> float:
        """Width of the bracket over the computed limit."""
        return (self.above - self.below) / self.trial.limit

    @property
    def is_stable(self) -> bool:
        """Whether the case's own step is stable: below the steps at which noise grew, with stable long runs."""
        return self.trial.step < self.above and all(run.is_stable for run in self.long_runs)


def measure(
    case: Case, *, steps: int | None = None, full: bool = False, report: Report | None = None
) -> tuple[list[Stability], list[str]]:
    """Largest stable steps of a case under all its laws or stages, and long runs of noise at its own step.

    steps : of a long run, None: as many as `LONG` allows; full : the whole scene instead of fewer copies of its brick.
    Returns the measurements, and how the scenes differ from that of the case, one sentence each.

    Raises the errors of building a scene, and CaseError if nothing in it can vibrate.
    """
    if steps is not None and steps < 1:
        raise CaseError([f"--steps: is {steps}, must be at least 1"])
    chosen, words = kind_of(case).trials(case, full=full)
    say = report or (lambda line: None)
    runs = [trial for trial in chosen for _ in trial.parts]
    steps = steps or _affordable(runs)
    return [_measured(trial, steps, _samples(len(runs)), say) for trial in chosen], words


def _affordable(runs: Sequence[Trial]) -> int:
    """Steps of each long run, in thousands, that `LONG` allows; runs : the trial of each."""
    each = 1e-9 * sum(trial.step_cost for trial in runs)
    return int(np.clip(LONG / each // 1000 * 1000, LEAST, MOST))


def _samples(runs: int) -> int:
    """Samples of each of some long runs, about `SAMPLES` in all, at which thousands of steps end."""
    return next((each for each in (500, 250, 125, 100) if each * runs <= SAMPLES), 50)


def _measured(trial: Trial, steps: int, samples: int, say: Report) -> Stability:
    """The measurements of one trial; steps, samples : numbers for each long run."""
    if not np.isfinite(trial.limit):
        raise CaseError(["run.time_step: any step is stable, as nothing in the scene can vibrate"])
    found = _bracketed(trial, say)
    for part in trial.parts:
        run = long_run(trial, part, steps, samples)
        found.long_runs.append(run)
        seen = "does not grow" if run.is_stable else "grows"
        done = f"{run.course.steps[-1]:,} steps of {trial.step:.4g} s"
        say(f"{trial.name}: energy of noise in the {part} {seen} in {done}")
    return found


def _bracketed(trial: Trial, say: Report) -> Stability:
    """The largest stable step: a bracket around the computed limit, then bisection."""
    found = Stability(trial)

    def resolution(step: float) -> float:
        return RESOLUTION if abs(step / trial.limit - 1.0) < COARSE - 1e-9 else COARSE

    def grows_at(step: float) -> bool:
        course = short_run(trial, step, resolution(step))
        if course.is_growing:
            found.above, found.growing = step, course
        else:
            found.below, found.calm = step, course
        seen = "grows" if course.is_growing else "does not grow"
        say(f"{trial.name}: noise {seen} at {step / trial.limit:.5f} of the computed limit")
        return course.is_growing

    for factor in FACTORS:
        if grows_at(trial.limit * factor):
            break
    if found.below == 0.0:
        for factor in FACTORS:
            if not grows_at(trial.limit / factor):
                break
    most = trial.limit * (1.0 + 1e-9)
    while np.isfinite(found.above) and found.above - found.below > resolution(found.measured) * most:
        grows_at(found.measured)
    return found
