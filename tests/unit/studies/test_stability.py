"""The measured largest step: that of the eigenvalue, and a verdict on the case's own."""

import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.kinds import kind_of, loads, with_changes
from dembound.studies.stability import measure

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


def test_columns_are_measured_alone() -> None:
    sides = {"boundary.left": {"type": "free_field"}, "boundary.right": {"type": "free_field"}}
    case = with_changes(loads(ROW), {"packing.size": [3.0, 5.0], "motion.held": [], **sides})
    (found,), _ = measure(case, steps=500)

    assert [run.part for run in found.long_runs] == ["column", "body"]
    assert found.is_stable
