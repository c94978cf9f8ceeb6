"""A case before its run: its scene, the time step, the first state, the size of its results."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from dembound.casefile.magnitudes import waves_used
from dembound.casefile.model import Case
from dembound.casefile.unlikely import unlikely
from dembound.errors import CaseError, DemboundError
from dembound.kinds import kind_of
from dembound.machine import disk_free
from dembound.motion.endings import Peak, Silence, monitored, peak_rule, silent_rule
from dembound.motion.energy import Entry, Ledger, SideEntry
from dembound.motion.kind import Beginning, Kind, Plan
from dembound.motion.memory import in_words, total
from dembound.motion.paths import first_arrivals
from dembound.motion.scene import Scene
from dembound.motion.simulation import Simulation
from dembound.motion.trackers import Clock
from dembound.results.checkpoint import FOLDER as STAGES
from dembound.results.checkpoint import settled_state
from dembound.schemas import checked

MOST_STEPS = 1e11
"""Largest number of steps. Even a few nodes would take more than a day: probably a mistake in a time."""

ROUNDING = 1e-6
"""Part of a time step by which an interval may be shorter because of rounding."""

ENTRIES = 100
"""Entries of the energy ledger where the case does not give an interval."""

SIDE_STEPS = 8
"""Steps between two samples of the sides where the case does not give an interval."""


def plan(case: Case, clock: Clock | None = None) -> Plan:
    """Build the scene and choose the step; the clock counts the time under "build".

    Raises PackingError for an impossible brick. Raises CaseError for an invalid case that was not read from a file, a
    load that acts on no particle, a material without stiffness, a step above the stability limit, and a step so small
    that the run would take more than `MOST_STEPS`.
    """
    case = checked(case)
    kind = kind_of(case)
    with about(case), (clock or Clock()).of("build"):
        scene = kind.build(case)
        time_step, limit = kind.choose_step(scene)
        steps = case.run.duration / time_step
        if steps > MOST_STEPS:
            asked = f"takes {steps:.3g} steps of {time_step:.3g} s"
            raise CaseError([f"run.duration: {asked}, must take no more than {MOST_STEPS:g}"])
        reduction = kind.reduced(scene)
    count = max(1, int(np.ceil(steps - 1e-9)))
    return Plan(kind, scene, reduction.scene, time_step, limit, count, count, reduction.refused)


@contextmanager
def about(case: Case) -> Iterator[None]:
    """Adds the name of the case to failures raised inside."""
    try:
        yield
    except DemboundError as error:
        error.source = case.name
        raise


def preflight(case: Case) -> None:
    """Find errors that would stop a case later, if this takes little time.

    Builds the scene, whose brick is then cached. Where the time step is found quickly, it also plans the run. Raises
    the errors of `plan` and `require_ready`.
    """
    kind = kind_of(case)
    if kind.is_planned_quickly(case):
        require_ready(plan(case))
        return
    with about(case):
        scene = kind.build(case)
        if kind.stages_from(case) is not None:
            _require_stages(kind, kind.reduced(scene).scene)


def require_ready(planned: Plan) -> None:
    """Raise all further errors that stop a run before its first step, so that a check and a run refuse the same cases.

    They are those of stages of another run that are missing, damaged, or of another body, and those of `Kind`.
    """
    with about(planned.scene.case):
        _require_stages(planned.kind, planned.stepped)
        planned.kind.require_ready(planned.scene, planned.stepped)


def _require_stages(kind: Kind[Any, Any], stepped: Scene) -> None:
    """Require the stages of a case for the stepped scene."""
    if (source := kind.stages_from(stepped.case)) is not None:
        for name in kind.stage_names(stepped):
            settled_state(source / STAGES, name, kind.stage_keys(stepped))


def warnings_before(planned: Plan) -> list[str]:
    """Warnings about probable mistakes, known before the run, one line each; without silent waves."""
    case = planned.scene.case
    silent = tuple(f"wave.{name}:" for name in case.silent if case.wave[name].begin() >= case.run.duration)
    warnings = [
        *unlikely(case),
        # probably their names are misspelt
        *(f"wave.{name}: no side and no load uses it" for name in case.wave.keys() - waves_used(case)),
        *_same_place(planned.scene),
        *_never_reached(planned),
        *planned.kind.warnings_before(planned.scene, planned.time_step),
        *_interval_warnings(planned),
    ]
    return [each for each in warnings if not each.startswith(silent)]


def _same_place(scene: Scene) -> Iterator[str]:
    """Monitors that record the particle or node of another one."""
    first: dict[tuple[float, ...], str] = {}
    for name in (monitor.name for monitor in scene.case.monitor):
        place = tuple(float(each) for each in scene.monitored[name])
        if (other := first.setdefault(place, name)) != name:
            listed = ", ".join(f"{each:.4g}" for each in place)
            yield f"monitor.{name}: is nearest to the same place as monitor.{other}, ({listed}) m, and records the same"


def _never_reached(planned: Plan) -> Iterator[str]:
    """Monitors that no wave reaches before the run ends, as the way is too long or waves begin too late."""
    scene, duration = planned.scene, planned.scene.case.run.duration
    if not scene.case.monitor or not (sources := planned.kind.sources(scene)):
        return
    first = first_arrivals(sources, planned.kind.front(scene, planned.time_step), monitored(scene))
    times = zip((monitor.name for monitor in scene.case.monitor), first.tolist(), strict=True)
    late = {name: time for name, time in times if duration <= time < np.inf}
    if late:
        soonest = min(late, key=lambda name: late[name])
        yield (
            f"monitor.{soonest}: the first wave reaches it at {late[soonest]:.4g} s, not within run.duration, "
            f"{duration:g} s ({len(late)} of {len(first)} monitors: {', '.join(late)}); it records no motion"
        )


def _interval_warnings(planned: Plan) -> Iterator[str]:
    """Warnings about outputs that the case requests more often than there are steps."""
    output = planned.scene.case.output
    if output.snapshots == 0 and (asked := [key for key in ("stress", "contacts") if getattr(output, key)]):
        yield (
            f"output.{' and output.'.join(asked)}: is about snapshots, but output.snapshots is 0, so nothing "
            "is written; give output.snapshots = 1 or more"
        )
    if output.snapshots > planned.steps:
        yield f"output.snapshots: is {output.snapshots}, the run has {planned.steps:,} steps and as many snapshots"
    for key in ("history_interval", "side_interval", "energy_interval"):
        interval = getattr(output, key)
        if 0.0 < interval < (1.0 - ROUNDING) * planned.time_step:
            yield f"output.{key}: is {interval:g} s, below the time step, {planned.time_step:.4g} s; every step is kept"


def simulation_of(planned: Plan, beginning: Beginning, clock: Clock) -> tuple[Simulation, Ledger]:
    """The simulation of a planned run in its first state, with the probes of its monitors, and its energy ledger.

    The ledger is not yet one of its trackers.
    """
    scene = planned.stepped
    state: dict[str, Any] = {"system": beginning.system, "datum": beginning.datum}
    stride = steps_between_samples(planned)
    simulation = Simulation(scene, planned.time_step, scene.probes, **state, clock=clock, side_stride=stride)
    until = scene.case.run.until
    if until in ("silent", "peak"):
        sources = planned.kind.sources(planned.scene)
        if until == "silent":
            simulation.track(Silence(silent_rule(planned.scene, sources), planned.time_step))
        else:
            simulation.track(Peak(peak_rule(planned.scene, sources), planned.scene, planned.time_step))
    return simulation, Ledger(simulation, steps_between_entries(planned), last=planned.steps - 1)


def steps_between_samples(planned: Plan) -> int:
    """Steps from one sample of the sides to the next."""
    output = planned.scene.case.output
    if output.side_interval > 0.0:
        return max(1, round(output.side_interval / planned.time_step))
    return max(SIDE_STEPS, round(output.history_interval / planned.time_step))


def steps_between_entries(planned: Plan) -> int:
    """Steps from one entry of the energy ledger to the next."""
    interval = planned.scene.case.output.energy_interval
    return max(1, round(interval / planned.time_step) if interval > 0.0 else planned.regular_steps // ENTRIES)


ALWAYS = 1e6
"""Bytes of pictures, the summary, and the first chunks of datasets that grow."""


def results_bytes(planned: Plan) -> dict[str, float]:
    """Estimated bytes of the results of a run, by the key of the case that determines them.

    While a checkpoint is written, there are two of them; they contain the ledger. A run that is continued to a later
    time keeps the interval of its snapshots.
    """
    kind, scene, case = planned.kind, planned.scene, planned.scene.case
    whole, stepped = kind.storage(scene), kind.storage(planned.stepped)
    copies = 2 if case.run.checkpoint > 0.0 else 0
    samples = planned.steps / max(1, round(case.output.history_interval / planned.time_step))
    histories = total({"sample": samples * len(scene.monitors)}, "history", history_stress=scene.record_width > 6)
    columns = len(fields(Entry)) + len(SideEntry._fields) * len(scene.edges)
    of_sides = planned.steps / steps_between_samples(planned) * len(scene.edges)
    entries = planned.steps / steps_between_entries(planned) * (1 + copies)
    snapshots = min(case.output.snapshots, planned.regular_steps) * planned.steps / planned.regular_steps
    snapshots += bool(snapshots and kind.stage_names(scene))
    settled = len(kind.stage_names(scene)) if copies and kind.stages_from(case) is None else 0
    return {
        "output.snapshots": snapshots * whole.snapshot,
        "output.history_interval": histories,
        "output.side_interval": total({"sample": of_sides}, "side"),
        "output.energy_interval": total({"number": entries * columns}, "entry"),
        "run.checkpoint": (copies + settled) * stepped.checkpoint,
        "": ALWAYS + whole.header,
    }


def bytes_left(planned: Plan, written: float = 0.0) -> dict[str, float]:
    """Bytes still to be written by a run, given the written bytes; all keys have an equal share."""
    sizes = results_bytes(planned)
    share = max(0.0, 1.0 - written / sum(sizes.values()))
    return {key: share * size for key, size in sizes.items()}


def space_in_words(planned: Plan, results: Path, written: float = 0.0) -> str:
    """The size of the results of a run as text, less the bytes already written, and the free space for them."""
    size, free = in_words(sum(bytes_left(planned, written).values())), disk_free(results)
    there = "" if free is None else f"; the disk has {in_words(free)} free"
    return f"about {size}{' more' if written > 0.0 else ''} of results{there}"


def space_warnings(planned: Plan, results: Path, written: float = 0.0) -> Iterator[str]:
    """A warning about results whose remaining bytes exceed the free space of their disk."""
    sizes, free = bytes_left(planned, written), disk_free(results)
    need = sum(sizes.values())
    if free is not None and need > free:
        key = max(filter(None, sizes), key=lambda name: sizes[name])
        yield (
            f"{key}: the results take about {in_words(need)}{' more' if written > 0.0 else ''}, "
            f"{in_words(sizes[key])} of them by this key; the disk has {in_words(free)} free"
        )
