"""Facts and warnings about a case, computed without running it."""

import time
from pathlib import Path

import numpy as np

from dembound.casefile import Case
from dembound.casefile.messages import counted
from dembound.errors import CaseError, RunError
from dembound.machine import memory_here
from dembound.motion.endings import peak_rule, rest_rule, silent_rule
from dembound.motion.kind import Beginning, Plan, echoes
from dembound.motion.memory import has_in_words, in_words
from dembound.motion.trackers import Clock
from dembound.results.histories import split_in_words
from dembound.running import plan, require_ready, simulation_of, space_in_words, space_warnings, warnings_before
from dembound.running.planning import steps_between_entries
from dembound.words import Entries, percent, with_unit

FEW, LONG, TRIALS = 20, 0.05, 3
"""Least steps of a trial; seconds of one that has more, as what surrounds blocks of steps counts less then; trials."""


def check(case: Case, results: Path = Path("results")) -> tuple[dict[str, str], list[str]]:
    """Facts about the run of a case, ready to print, and warnings. Runs a few steps to estimate the time.

    results : folder in which the run would write its own; the free space of its disk is checked.
    """
    planned = plan(case)
    require_ready(planned)
    facts = [
        *_run_facts(planned, results),
        *planned.kind.facts(planned.scene, planned.time_step),
        *_errors(planned),
        *echoes(planned),
    ]
    return dict(facts), [*warnings_before(planned), *space_warnings(planned, results)]


def _run_facts(planned: Plan, results: Path) -> Entries:
    """Steps, RAM, space on the disk and time, and the reductions of the scene."""
    scene = planned.stepped
    step, limit = planned.time_step, planned.step_limit
    yield "time step", f"{with_unit(step, 's')}, {step / limit:.3g} of the limit {with_unit(limit, 's')}"
    yield "steps", f"{planned.steps:,} for {scene.case.run.duration:g} s{_until(planned)}"
    yield "memory", f"about {in_words(scene.largest_memory)} at its peak{_here()}"
    yield "disk", space_in_words(planned, results)
    try:
        seconds, most, words = _estimate(planned)
    except RunError as error:
        yield "estimated time", f"unknown, as in the first steps {error}"
    else:
        static = ""
        if planned.kind.settles(scene.case):  # 3,300 to 14,300 steps in shipped cases, 0.1 to 40 crossings of S waves
            many = with_unit(1000.0 * seconds / planned.steps, "s", 2)
            static = f"; the static stage comes on top: usually thousands of steps, about {many} for 1,000 of them"
        with_threads = f" with {counted(scene.threads, 'thread')}, without building, pictures{static}"
        yield "estimated time", f"{_range_in_words(seconds, most, words)}{with_threads}"
    for name, reductions in (("reduced", scene.reduced), ("not reduced", planned.refused)):
        if reductions:
            yield name, "; ".join(reductions)


def _errors(planned: Plan) -> Entries:
    """Errors of a run that formulas give without its motion, and the command that estimates other errors."""
    from dembound.accuracy.judge import judge_of

    case = planned.scene.case
    if not case.monitor:
        return
    try:
        found = judge_of(case).quick(planned.scene).found
    except CaseError as error:
        yield "errors", f"not predicted: {error}"
        return
    sizes = {cause.name: cause.largest for cause in found if cause.how != "unknown"}
    known = f"{split_in_words(sizes)} by formula; " if sizes else ""
    yield "errors", f"{known}dembound advise predicts {'the others' if known else 'them'} and finds cheaper cases"


def _here() -> str:
    """The RAM of this machine as text, where it is known."""
    here = memory_here()
    return "" if here is None else f"; {has_in_words(here)}"


def _until(planned: Plan) -> str:
    """When a run may end before its duration."""
    until = planned.scene.case.run.until
    if until == "duration":
        return ""
    sources = planned.kind.sources(planned.scene)
    if until == "peak":
        past = peak_rule(planned.scene, sources)
        return (
            f", or until the forces on all driven sides are below {percent(past.share, 3)} of their peaks for "
            f"{with_unit(past.hold, 's')}"
        )
    if until == "rest":
        rest = rest_rule(planned.scene, sources)
        hold, earliest = with_unit(rest.hold, "s"), with_unit(rest.earliest, "s")
        return f", or until what fell has been at rest for {hold}, after {earliest}"
    rule = silent_rule(planned.scene, sources)
    return (
        f", or until all monitors are below {percent(rule.level, 3)} of their peaks for {with_unit(rule.hold, 's')}, "
        f"after {with_unit(rule.earliest, 's')}"
    )


def duration_in_words(seconds: float) -> str:
    """A time in s as an estimate in words: "about 40 s", "about 15 min", "about 2.5 h"."""
    if seconds < 1.0:
        return "less than 1 s"
    for unit, length, least in (("d", 86400.0, 48.0 * 3600.0), ("h", 3600.0, 5400.0), ("min", 60.0, 90.0)):
        if seconds >= least:
            count = seconds / length
            return f"about {count:.0f} {unit}" if count >= 9.5 else f"about {count:.2g} {unit}"
    return f"about {round(seconds, -1 if seconds >= 19.5 else 0):.0f} s"


def _range_in_words(least: float, most: float, words: str) -> str:
    """Seconds of a run at the pace of its first steps and at its slowest, in words; one number if they are alike."""
    low, high = duration_in_words(least), duration_in_words(most)
    return low if low == high else f"{low} at the pace of the first steps, {high} {words}"


def _estimate(planned: Plan) -> tuple[float, float, str]:
    """Seconds the run will take at the pace of its first steps and at its slowest, and when it is slowest.

    The first is that of the quickest of a few short trials, of the clock: with one thread that of the CPU, which other
    programs do not change. The slowest pace is known from constants, times the machine's speed as the trials show it.
    """
    scene, clock = planned.stepped, time.process_time if planned.stepped.threads == 1 else time.perf_counter
    simulation, ledger = simulation_of(planned, Beginning(scene.system(planned.time_step)), Clock())
    ledger.watches = not planned.kind.settles(scene.case)  # before it settles a body is out of balance with its sides

    def trial(steps: int) -> float:
        began = clock()
        simulation.advance(steps)
        return clock() - began

    simulation.track(ledger)
    simulation.advance(FEW)  # compiles the kernels and starts the threads
    enough = min(max(FEW, int(FEW * LONG / max(trial(FEW), 1e-6))), max(FEW, planned.steps))
    each = min(trial(enough) for _ in range(TRIALS)) / enough
    ledger.due = simulation.state.step  # from one step to the next
    entries = (trial(2) - 2.0 * each) * planned.steps / steps_between_entries(planned)
    slower, least = planned.kind.slower(scene), each * planned.steps + max(0.0, entries)
    if slower is None:
        return least, least, ""
    speed = float(np.clip(1e9 * each * scene.threads / slower.first, 0.5, 2.0))
    more = 1e-9 * (slower.then - slower.first) * speed / scene.threads
    return least, least + more * planned.steps, slower.words
