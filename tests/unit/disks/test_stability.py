"""The stable step, against closed forms of the square lattice."""

from dataclasses import replace

import numpy as np
import pytest
from small_cases import SURROUNDED, small

from dembound.boundaries.support import SupportBuilder
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import OPENING, choose_step, step_limit
from dembound.errors import CaseError, RunError
from dembound.motion import stability
from dembound.motion.stability import LEAST

MASS = 2500.0 * 0.5**2
ONLY_X = {"motion.held": ["y", "rotation"]}


def test_springs_of_supports_count(bar) -> None:
    scene = build(bar({**ONLY_X, "packing.size": [0.5, 0.5], "monitor": []}))
    supports = SupportBuilder()
    supports.add(np.array([0]), 0, stiffness=9.0 * MASS)

    # ω = 3
    assert step_limit(replace(scene, supports=supports.table())) == pytest.approx(2.0 / 3.0, rel=1e-12)


def test_the_operator_beside_a_continuum_is_symmetric_where_disks_are_held() -> None:
    """Ties push disks that a side holds, too; counted, their forces would make it unsymmetric, and Lanczos fail."""
    weight = {"name": "g", "acceleration": [0.0, -9.81]}
    held = {"static": {"boundary": {"bottom": {"type": "fixed"}}}, "load": [weight]}
    body = {"packing": SURROUNDED["packing"] | {"size": [16.0, 6.0]}, "outside": {"element": 20.0}}
    scene = StaticScene(built := build(small(SURROUNDED | held | body)), built.case.static).scene
    free = replace(scene, supports=SupportBuilder().table())

    # holding disks never makes a limit shorter
    assert step_limit(scene) >= step_limit(free)


def test_a_limit_that_is_not_found_in_time_is_an_error(bar, monkeypatch) -> None:
    scene = build(bar({**ONLY_X, "packing.size": [50.0, 5.0]}))
    monkeypatch.setattr(stability, "MOST", LEAST)  # enough for scenes of few disks only
    with pytest.raises(RunError, match="was not found in 40 iterations"):
        step_limit(scene)


def given(bar, step: float | str, **more: object) -> DiskScene:
    return build(bar({"run.time_step": step, **more}))


def test_an_automatic_step_is_the_share_of_the_limit_asked_for_and_a_given_one_is_taken(bar) -> None:
    step, limit = choose_step(build(bar({"run.safety": 0.75})))

    # cut to four digits
    assert 0.0 <= 1.0 - step / (0.75 * limit) < 1e-3
    assert float(f"{step:.4g}") == pytest.approx(step, rel=1e-15)
    assert choose_step(given(bar, 1e-4)) == (1e-4, pytest.approx(limit))
    with pytest.raises(CaseError) as caught:
        choose_step(given(bar, 1.01 * limit))
    (problem,) = caught.value.problems
    assert problem.startswith("run.time_step: ")
    assert f"{limit:.6g}" in problem


@pytest.mark.parametrize(("fric", "most"), [(0.0, 6.0), (0.5, 24.0)])
def test_the_smallest_disks_of_loose_ground_may_come_to_lie_together(bar, fric: float, most: float) -> None:
    packing = {"pattern": "B", "size": [6.0, 5.0], "radius": 0.25, "radius_ratio": 1.5, "brick": [6.0, 5.0]}
    loose = {"density": 2500.0, "law": "linearpbond", "emod": 1e9, "pb_emod": 0.0, "fric": fric, "kratio": 1.0}
    springs = {"pb_emod": 1e6, "pb_ten": 1e6} if fric == 0.0 else {}  # a brick resists no shear without
    scene = build(bar({"packing": packing, "material": loose | springs, "motion.held": [], "monitor": []}))

    # of the hexagonal lattice of equal disks ω² = 6k_n/m where only normal springs act, when neighbouring rows move
    # against each other, and 24k_s/m where all disks turn alike; k_n = k_s = emod. Equal disks of the mean mass, half
    # as much again as the least, would come to less. Loose disks open and close their contacts
    least = float(scene.mass.min())
    assert float(scene.mass.mean()) > 1.5 * least
    assert step_limit(scene) <= 2.0 / np.sqrt(most * 1e9 / least / OPENING) * (1.0 + 1e-12)  # rounding
