"""Errors of a case of any kind: of a run from its folder of results, and the cheapest choices with smaller errors."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from dembound.accuracy.budget import Budget
from dembound.accuracy.choice import value_at
from dembound.accuracy.judge import judge_of
from dembound.accuracy.proposal import Advice, Request, Watch
from dembound.accuracy.repeat import Cracked, repeated
from dembound.casefile import Case
from dembound.errors import CaseError, DemboundError, RecordError
from dembound.files import require_writable
from dembound.formulas.cause import Causes, Truth
from dembound.formulas.history import History, Motions
from dembound.motion.trackers import Clock
from dembound.results.committed import new_file
from dembound.results.datasets import describe, write
from dembound.results.histories import FILE, FREE_FIELD, KEY, Named
from dembound.results.reader import history_of, open_record, require_run
from dembound.results.summary import FILE as SUMMARY
from dembound.results.summary import read_summary
from dembound.results.text_files import write_json
from dembound.running.recorded import recorded_case

UNITS = {"velocity": "m/s", "displacement": "m", "stress": "Pa"}
"""Units of the histories."""

LEAST_SAMPLES = 8
"""Fewest samples of a history whose error is estimated."""


def estimate_results(
    folder: Path, repeat: bool = False, watch: Watch | None = None, longest: float | None = None
) -> Budget:
    """Estimate the error of a complete run; writes ``estimate.h5`` and the entry ``error_estimate`` of its summary.

    Parameters
    ----------
    folder : of the results. repeat : whether a run with cracks is repeated with a smaller time step, to find how much
    of them is one draw of many. watch : told of what is done. longest : CPU seconds that companions may take; by
    default 20, or as long as the run.

    Raises CaseError for a run that is not complete, that has neither monitors nor many cracks, or a repetition without
    cracks, and RecordError for a record that cannot be read, or a link in place of a file to write.
    """
    require_writable(folder / FILE, folder / SUMMARY)
    clock = Clock(time.process_time)
    with clock.with_compiling(), clock.of("estimate"):
        found, recorded, summary = _estimated(folder, repeat, watch, longest)
    found = replace(found, cpu_seconds=clock.seconds["estimate"])
    _write(found, recorded, folder / FILE)
    write_json(folder / SUMMARY, summary | {KEY: found.summary()})
    return found


def _estimated(
    folder: Path, repeat: bool, watch: Watch | None, longest: float | None
) -> tuple[Budget, Motions, dict[str, Any]]:
    """The errors, the records of the monitors, and the summary of the run."""
    record = folder / "run.h5"
    with open_record(record) as file:
        require_run(file)
    summary = _summary(folder)
    case, cracked = recorded_case(record), Cracked.of(record)
    case = replace(case, run=case.run.lasting(summary["duration"]))
    recorded, lack = _recorded(record, cracked.first)
    one_draw = list(cracked.one_draw())
    if lack and not (repeat or one_draw):
        raise CaseError([f"{record}: {lack}"])
    again = repeated(case, record, cracked) if repeat else None
    said = Causes([], [], one_draw) if again is None else Causes([], [], again.lines(), again.cost)
    causes = Causes([], [lack]) if lack else _causes(case, recorded, cracked.first, summary, watch, longest)
    motions = Named(recorded if causes.motions is None else causes.motions, "monitor")
    return Budget(motions, causes + said, judge_of(case).truth(case), repeat=again), recorded, summary


def _causes(
    case: Case, recorded: Motions, until: float, summary: Mapping[str, Any], watch: Watch | None, longest: float | None
) -> Causes:
    """The causes of the error of a run up to its first break, at `until` (s)."""
    broken = [] if case.run.duration < until else [f"motion after {until:.4g} s, when the first bond broke"]
    case = replace(case, run=case.run.lasting(min(case.run.duration, until)))
    work = summary["particle_steps_per_second"] * summary["seconds"]["step"]
    causes = causes_of(case, recorded, summary["time_step"], work, watch, longest)
    causes += judge_of(case).at_start(case, causes.motions or recorded, summary)
    causes += Causes([], broken, list(judge_of(case).notes(case, summary)))
    return causes + Causes([], list(_at_rest(Budget(causes.motions or recorded, causes))))


def causes_of(
    case: Case,
    recorded: Motions,
    time_step: float,
    work: float,
    watch: Watch | None = None,
    longest: float | None = None,
) -> Causes:
    """The causes of the error of a run.

    case : to the end of the run. recorded : by monitor, up to the time until which errors are estimated. time_step : of
    the run, s. work : of the run, in the unit of its kind of body; companions take a tenth of it, or `SHORT`, if
    possible. watch : told of what is done. longest : CPU seconds that they may take, if that is more than by default.
    """
    return judge_of(case).causes(case, recorded, time_step, work, watch or Watch(), longest)


def estimate_if_asked(case: Case, folder: Path) -> str:
    """Estimate the error of a complete run of a case with ``output.estimate``; returns the reason if it cannot.

    Returns "" after an estimate, and for cases without ``output.estimate``. A run is complete without its estimate.
    """
    if case.output.estimate:
        try:
            found = estimate_results(folder)
        except DemboundError as error:
            return f"errors are not estimated: {'; '.join(str(error).splitlines())}"
        if not found.motions:
            return f"errors are not estimated: {'; '.join(found.causes.limits)}"
    return ""


def _at_rest(found: Budget) -> Iterator[str]:
    """Lines on monitors whose errors are not known, unless another line gives the reason."""
    said = {line.split(":")[0] for line in found.causes.limits}
    for name in found.motions if found.causes.found else ():
        if name not in said and not found.largest(name)[1].is_known:
            yield f"{name}: does not move"


def _summary(folder: Path) -> dict[str, Any]:
    """The summary of a complete run."""
    found = read_summary(folder)
    numbers = found["duration"], found["time_step"], found["particle_steps_per_second"], found["seconds"]["step"]
    if not all(isinstance(each, int | float) and each >= 0.0 for each in numbers):
        raise RecordError([f"{folder / 'summary.json'}: is damaged, a duration or a number of steps is none"])
    return found


def _recorded(record: Path, until: float) -> tuple[dict[str, History], str]:
    """Records of the monitors up to a time (s), and the reason if they are missing or too short."""
    found: dict[str, History] = {}
    samples = []
    with open_record(record) as file:
        for name, group in file.get("histories", {}).items():
            if name.endswith(FREE_FIELD):
                continue
            values = {}
            for quantity in UNITS:
                if quantity in group:
                    times, motion = history_of(group, quantity)
                    kept = times < until
                    values[quantity] = motion.reshape(len(motion), -1)[kept][:, :2]
            samples.append(int(np.count_nonzero(kept)) if values else 0)
            if samples[-1] >= LEAST_SAMPLES:
                place = np.atleast_1d(group.attrs["position"])
                found[name] = History(np.array([*place, 0.0][:2]), times[kept], values)
    return found, "" if found else _too_little(samples, until)


def _too_little(samples: Sequence[int], until: float) -> str:
    """Why histories of monitors with these numbers of samples up to a time (s) are too short."""
    most = max(samples, default=0)
    if not samples or (most == 0 and math.isinf(until)):
        return "has no monitor whose error could be estimated"
    needed = f"an estimate needs {LEAST_SAMPLES}"
    if math.isfinite(until):
        return f"the first bond broke at {until:.4g} s, after {most} samples of the monitors; {needed}"
    return f"has {most} samples of its monitors (output.history_interval); {needed}"


def _write(found: Budget, recorded: Motions, path: Path) -> None:
    """Write the error histories, the motions corrected for errors of sides where known, and the cracks of a repeat."""
    with new_file(path) as file:
        file.create_group("histories")
        for name, motion in found.motions.items():
            group = file.create_group(f"histories/{name}")
            write(group, "time", motion.time, "s")
            for quantity in found.quantities(name):
                _write_quantity(group.create_group(quantity), found, recorded[name].at(motion.time), name, quantity)
        if found.repeat is not None:
            group = file.create_group("repeat")
            write(group, "time", found.repeat.other.times, "s")
            write(group, "position", found.repeat.other.places, "m")


def _write_quantity(inner: Any, found: Budget, recorded: History, name: str, quantity: str) -> None:
    """The errors of a quantity by cause, its band, and the corrected history."""
    unit = UNITS[quantity]
    describe(inner, {"total": found.total(name, quantity).value})
    for cause in found.causes.found:
        error = cause.parts.get(name, {}).get(quantity)
        if isinstance(error, np.ndarray):
            write(inner, f"error of {cause.name}", error, unit)
        elif error is not None:
            describe(inner, {f"share of {cause.name}": error})
    write(inner, "band", found.band(name, quantity), unit)
    if (correction := found.correction(name, quantity)) is not None:
        write(inner, "corrected", recorded.values[quantity] - correction, unit)


BOUNDS = (0.1, 0.03, 0.01, 0.003)
"""Errors for which the cheapest choices are found where none is asked for."""


def advise(
    case: Case,
    bounds: Sequence[float] = BOUNDS,
    of: Truth | None = None,
    kept: Sequence[str] = (),
    seeds: int = 1,
    longest: float | None = None,
    watch: Watch | None = None,
) -> Advice:
    """The errors of a case, and for every bound the cheapest choice that keeps it, or else the most accurate choice.

    bounds : errors, RMS over RMS, such as 0.01, of velocity and displacement (of bars also stress) at all monitors
    whose motion is not negligible. of : "disks": errors relative to the disks as the material; "rock": relative to the
    rock that they discretise; None: "disks" where packings are random or bonds may break. kept : dotted keys whose
    values do not change, such as ``packing.radius`` or ``boundary``. seeds : number of random packings run to find the
    scatter between packings. longest : CPU seconds that the steps of a choice may take; by default 60 for disks, for
    bars 64 times the CPU seconds of the case. watch : told of what is done, and of what is
    known before all is.

    Raises CaseError for cases without monitors, without motion at them, or whose errors are not known, for a bound that
    is not a positive number and for unknown keys; the errors of building a scene and of running companions.
    """
    for bound in bounds:
        if not 0.0 < bound < 1.0:
            raise CaseError([f"--error: is {bound:g}, must be above 0 and below 1, such as 1% or 0.01"])
    if not case.monitor:
        raise CaseError(["advise: needs a monitor, at which errors are known; give a [[monitor]]"], case.name)
    for key in kept:
        value_at(case, key)
    judge, clock = judge_of(case), Clock(time.process_time)
    with clock.with_compiling(), clock.of("advise"):
        asked = Request(bounds, of or judge.truth(case), kept, longest, seeds, watch or Watch())
        found = judge.advise(case, asked)
    return replace(found, cpu_seconds=clock.seconds["advise"])
