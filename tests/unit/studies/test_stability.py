"""The measured largest step is that of the eigenvalue; what counts as growth of noise, and what is conserved."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.kinds import kind_of, loads, with_changes
from dembound.motion.simulation import Simulation
from dembound.studies.stability import DECIDED, GROWN, Course, LongRun, conserved, long_run, measure, short_run

ROW = """
[packing]
pattern = "A"
size = [10.0, 0.5]
radius = 0.25
[material]
density = 2500.0
p_wave_speed = 1000.0
[motion]
held = ["y", "rotation"]
[boundary.right]
type = "viscous"
beta_p = 5.0
half_mass = true
[run]
duration = 1.0
"""

LIMIT = 0.5e-3
"""D/c of a row whose ends have whole or half masses, s, but for (π/4N)² of a free end."""


def test_the_measured_step_is_that_of_the_eigenvalue_whatever_that_of_the_case() -> None:
    lines: list[str] = []
    (found,), words = measure(loads(ROW), steps=1000, report=lines.append)

    assert found.trial.limit == pytest.approx(LIMIT, rel=1e-3)
    assert found.measured == pytest.approx(found.trial.limit, rel=1e-3)
    assert found.below < found.above <= found.below + 1.001e-3 * found.trial.limit
    assert found.is_stable
    assert [run.part for run in found.long_runs] == ["body"]
    assert words == ["10 m × 0.5 m, 20 disks", "the whole scene"]
    assert len(lines) >= 3
    (found,), _ = measure(with_changes(loads(ROW), {"run.time_step": 1.01 * LIMIT}), steps=1000)
    assert not found.is_stable
    assert found.trial.step > found.above
    with pytest.raises(CaseError, match="--steps: is 0"):
        measure(loads(ROW), steps=0)


def test_of_contacts_that_open_energy_only_falls() -> None:
    free = loads(ROW.split("[boundary.right]")[0] + "[run]\nduration = 1.0\n")
    linear, full = measure(with_changes(free, {"material.law": "linearpbond"}), steps=1000)[0]

    assert linear.is_stable
    assert full.is_stable
    assert full.trial.limit == pytest.approx((0.75 / 1.05) ** 0.5 * linear.trial.limit, rel=1e-3)
    assert full.long_runs[0].course.energy[-1] < 1.0
    assert linear.long_runs[0].course.energy[-1] == pytest.approx(1.0, abs=1e-10)


def test_noise_does_not_turn_a_free_body() -> None:
    """Rounding of growing displacements would grow as energy: by 3e-9 in 100,000 steps of twelve disks."""
    free = with_changes(loads(ROW.split("[boundary.right]")[0] + "[run]\nduration = 1.0\n"), {"motion.held": []})
    trial = kind_of(free).trials(free)[0][0]
    scene, velocity = trial.scene, trial.noise()
    x, y = scene.positions.T
    spins = np.stack([scene.mass * (x * velocity[1] - y * velocity[0]), scene.inertia * velocity[2]])

    # of some hundred terms, each rounded to eps
    assert abs(spins.sum()) < 1e-13 * np.abs(spins).sum()
    assert np.abs(velocity).min() > 0.0


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
