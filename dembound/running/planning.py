"""A case before its run: its scene, the time step, the simulation in its first state."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from dembound.casefile import Case
from dembound.errors import CaseError, DemboundError
from dembound.kinds import checked, kind_of
from dembound.motion.clock import Clock
from dembound.motion.energy import Ledger
from dembound.motion.kind import Beginning, Plan
from dembound.motion.silence import Silence, silent_rule
from dembound.motion.simulation import Simulation

MOST_STEPS = 1e11
"""Largest number of steps. Even a few nodes would take more than a day for it: a mistake in a time."""

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
    """Find errors that would stop a case later, as far as this takes little time.

    Builds the scene, whose brick is then cached. Where the time step is found quickly, it also plans the run. Raises
    the errors of `plan`.
    """
    kind = kind_of(case)
    if kind.is_planned_quickly(case):
        plan(case)
        return
    with about(case):
        kind.build(case)


def warnings_before(planned: Plan) -> list[str]:
    """Warnings about probable mistakes, known before the run, one line each."""
    return planned.kind.warnings_before(planned.scene, planned.time_step)


def simulation_of(planned: Plan, beginning: Beginning, clock: Clock) -> tuple[Simulation, Ledger]:
    """The simulation of a planned run in its first state, with the monitors as probes, and its energy ledger.

    The ledger still has to be tracked.
    """
    scene = planned.stepped
    simulation = Simulation(
        scene,
        planned.time_step,
        list(scene.monitors.values()),
        system=beginning.system,
        datum=beginning.datum,
        clock=clock,
        side_stride=_steps_between_samples(planned),
    )
    if scene.case.run.until == "silent":
        simulation.track(Silence(silent_rule(planned.scene, planned.kind.sources(planned.scene)), planned.time_step))
    return simulation, Ledger(simulation, _steps_between_entries(planned), last=planned.steps - 1)


def _steps_between_samples(planned: Plan) -> int:
    """Steps from one sample of the sides to the next."""
    output = planned.scene.case.output
    if output.side_interval > 0.0:
        return max(1, round(output.side_interval / planned.time_step))
    return max(SIDE_STEPS, round(output.history_interval / planned.time_step))


def _steps_between_entries(planned: Plan) -> int:
    """Steps from one entry of the energy ledger to the next."""
    interval = planned.scene.case.output.energy_interval
    return max(1, round(interval / planned.time_step) if interval > 0.0 else planned.regular_steps // ENTRIES)
