"""Exact motion at the monitors of cases, one kind of problem per file.

It is written as a record with the layout of a run, so that it is plotted and compared like one. A new
problem is one file with a `Problem`, and its name in `PROBLEMS`.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from dembound.accuracy.of_disks.exact.lamb import LambProblem
from dembound.accuracy.of_disks.exact.pressure import CavityProblem, GarvinProblem
from dembound.accuracy.of_disks.exact.problem import Problem
from dembound.accuracy.of_disks.exact.scattering import ScatteringProblem
from dembound.casefile.disks import DiskCase
from dembound.disks.scene import DiskScene, build
from dembound.errors import CaseError
from dembound.files import make_folder
from dembound.formulas.history import History
from dembound.results.committed import new_file
from dembound.results.datasets import describe, write
from dembound.results.new_record import DISPLACEMENT_UNIT, VELOCITY_UNIT, header_of_monitor
from dembound.version import __version__

PROBLEMS: tuple[type[Problem], ...] = (LambProblem, CavityProblem, GarvinProblem, ScatteringProblem)
"""All kinds of problems; of those with the loads of a case, the first that holds for the longest time is taken."""

SAMPLES = 2000
"""Number of times at which the exact motion is written."""

__all__ = ["PROBLEMS", "Problem", "exact_motions", "problem_of", "write_exact"]


def problem_of(scene: DiskScene, name: str | None = None) -> Problem:
    """The problem that a scene matches: with this name, or by default the one that is valid longest.

    Raises CaseError, with the reasons, if none matches; the reasons are those of the first problem with its loads.
    """
    if name is not None:
        kinds: Sequence[type[Problem]] = [kind for kind in PROBLEMS if kind.name == name]
        if not kinds:
            raise CaseError([f"--problem: {name} is none of {', '.join(kind.name for kind in PROBLEMS)}"])
        if not kinds[0].concerns(scene.case):
            raise CaseError([f"--problem: the case has no load of {name}"])
    else:
        kinds = [kind for kind in PROBLEMS if kind.concerns(scene.case)]
    found, reasons = [], []
    for kind in kinds:
        try:
            found.append(kind.of(scene))
        except CaseError as error:
            reasons.append(error)
    if not found:
        raise reasons[0]
    duration = scene.case.run.duration
    return max(found, key=lambda problem: min([*problem.until.values(), duration]))


def exact_motions(scene: DiskScene, name: str | None = None) -> tuple[Problem, dict[str, History]]:
    """The problem that a scene matches, and the monitors' motion while it is valid; errors as of `problem_of`."""
    problem = problem_of(scene, name)
    times = np.linspace(0.0, scene.case.run.duration, SAMPLES)
    needed = times <= max(problem.until.values(), default=0.0)
    motions = problem.motions(times[needed])
    return problem, {monitor: motions[monitor].until(end) for monitor, end in problem.until.items()}


def write_exact(case: DiskCase, path: Path, name: str | None = None) -> Problem:
    """Write the exact histories of a case as a record, as long as they are valid; returns the matching problem.

    name : of the problem; None: the one that is valid longest. The folder of `path` is created if it does not
    exist. Raises CaseError, with the reasons, if the case matches no problem.
    """
    scene = build(case)
    problem, motions = exact_motions(scene, name)
    make_folder(path.parent)
    with new_file(path) as file:
        facts = {"name": case.name, "case": case.text, "version": __version__, "size": scene.size, "complete": True}
        facts |= {"late": 0.0}
        describe(file, facts)
        histories = file.create_group("histories", track_order=True)
        for monitor in case.monitor:
            group = histories.create_group(monitor.name)
            describe(group, header_of_monitor(scene, monitor.name))
            motion = motions[monitor.name]
            write(group, "time", motion.time, "s")
            write(group, "displacement", motion.displacement, DISPLACEMENT_UNIT)
            write(group, "velocity", motion.velocity, VELOCITY_UNIT)
    return problem
