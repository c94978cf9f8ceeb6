"""A case before its run: its scene, the time step, the simulation in its first state."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from dembound.casefile import Case
from dembound.casefile.magnitudes import waves_used
from dembound.casefile.unlikely import unlikely
from dembound.errors import CaseError, DemboundError
from dembound.kinds import checked, kind_of
from dembound.motion.clock import Clock
from dembound.motion.energy import Ledger
from dembound.motion.kind import Beginning, Kind, Plan
from dembound.motion.paths import first_arrivals
from dembound.motion.peak import Peak, peak_rule
from dembound.motion.scene import Scene
from dembound.motion.silence import Silence, monitored, silent_rule
from dembound.motion.simulation import Simulation
from dembound.results.kept_stages import FOLDER as STAGES
from dembound.results.kept_stages import settled_state

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
    return [each for each in _all_before(planned) if not each.startswith(silent)]


def _all_before(planned: Plan) -> list[str]:
    """All warnings before the run, including those about silent waves."""
    return [
        *unlikely(planned.scene.case),
        *_unused_waves(planned.scene.case),
        *_same_place(planned.scene),
        *_never_reached(planned),
        *planned.kind.warnings_before(planned.scene, planned.time_step),
        *_interval_warnings(planned),
    ]


def _unused_waves(case: Case) -> Iterator[str]:
    """Waves that no side and no load uses, probably as a name is misspelt."""
    for name in case.wave.keys() - waves_used(case):
        yield f"wave.{name}: no side and no load uses it"


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
    late = {
        monitor.name: time
        for monitor, time in zip(scene.case.monitor, first.tolist(), strict=True)
        if duration <= time < np.inf
    }
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
    simulation = Simulation(
        scene,
        planned.time_step,
        scene.probes,
        system=beginning.system,
        datum=beginning.datum,
        clock=clock,
        side_stride=steps_between_samples(planned),
    )
    until = scene.case.run.until
    if until != "duration":
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
