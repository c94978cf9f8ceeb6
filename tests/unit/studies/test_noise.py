"""Noise in a scene: what counts as growth, and the energy that central differences conserve."""

import numpy as np
import pytest

from dembound.kinds import kind_of
from dembound.motion.simulation import Simulation
from dembound.studies.noise import DECIDED, GROWN, Course, LongRun, conserved, long_run, short_run


@pytest.fixture
def trial(bar):
    """The first trial of the small bar with keys changed, with springs and dashpots on the right."""

    def make(changes: dict | None = None):
        side = {"type": "viscoelastic", "distance": 0.5}
        case = bar({"boundary.right": side, "boundary.left": {"type": "free"}, **(changes or {})})
        return kind_of(case).trials(case)[0][0]

    return make


def test_growth_is_a_large_energy_or_a_steady_rise() -> None:
    steps = list(range(0, 1000, 10))
    slow = [float(np.exp(2.1 * DECIDED * step / 1000)) for step in steps]
    slower = [float(np.exp(1.9 * DECIDED * step / 1000)) for step in steps]

    assert Course(steps, slow).is_growing
    assert not Course(steps, slower).is_growing
    assert Course(steps[:2], [1.0, 2.0 * GROWN]).is_growing
    assert Course(steps[:2], [1.0, np.nan]).is_growing
    # a transient of the first half does not count
    assert not Course(steps, [min(step / 10.0 + 1.0, 40.0) for step in steps]).is_growing


def test_noise_grows_above_the_limit_and_not_below(trial) -> None:
    chosen = trial()
    assert short_run(chosen, 1.001 * chosen.limit).is_growing
    assert not short_run(chosen, 0.9995 * chosen.limit).is_growing


def test_the_conserved_energy_is_constant_without_dashpots(trial) -> None:
    chosen = trial({"boundary.right": {"type": "fixed"}})
    run = long_run(chosen, "body", 2000)

    np.testing.assert_allclose(run.course.energy, 1.0, rtol=0, atol=run.allowed)
    assert run.is_stable
    assert len(run.course.energy) == 501


def test_springs_count_and_dashpots_only_take(trial) -> None:
    """What dashpots take in a step is C·v̄²Δt: the sum over all steps closes the balance."""
    chosen = trial()
    simulation = Simulation(chosen.scene, chosen.step, system=chosen.system(chosen.step))
    simulation.state.velocity = chosen.noise()
    rows = chosen.scene.supports
    parts = simulation.system.parts
    energy = [conserved(simulation, parts)]
    taken = 0.0
    for _ in range(50):
        before = simulation.state.velocity.copy()
        simulation.advance(1)
        mean = 0.5 * (before + simulation.state.velocity)[rows.component, rows.node]
        taken += float(np.sum(rows.damping * mean**2)) * chosen.step
        energy.append(conserved(simulation, parts))

    assert np.all(np.diff(energy) < 1e-12 * energy[0])
    assert energy[0] - energy[-1] == pytest.approx(taken, rel=1e-9)
    assert taken > 0.01 * energy[0]


def test_a_long_run_above_the_limit_or_a_rise_beyond_what_is_allowed_is_not_stable(trial) -> None:
    run = long_run(trial({"run.time_step": 1e-3}), "body", 2000)
    assert not run.is_stable
    assert run.course.steps[-1] < 2000
    assert run.shown == (run.course.steps, run.course.kinetic)

    course = Course([0, 1], [1.0, 1.0], [1.0, 1.0 + 2e-9])
    assert not LongRun("body", course, 1e-9, 10.0).is_stable
    assert LongRun("body", course, 3e-9, 10.0).is_stable
    assert not LongRun("body", Course([0, 1], [1.0, 11.0], [1.0, 1.0]), 1e-9, 10.0).is_stable
    assert LongRun("body", Course([0], [1.0]), 1e-9, 10.0).rise == np.inf
