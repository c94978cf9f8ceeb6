"""The stable step, against closed forms of the square lattice."""

from dataclasses import replace

import numpy as np
import pytest
from disk_systems import LAMB
from scene_tables import lattice, pulse
from small_cases import GROUND, PULLED, SURROUNDED, problems_in, small

from dembound.bar.scene import build_bar
from dembound.boundaries.support import SupportBuilder
from dembound.disks.memory import SceneSizes, expected_bytes
from dembound.disks.rest.static_scene import StaticScene
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import OPENING, choose_step, step_limit
from dembound.disks.trials import PARTICLES
from dembound.errors import CaseError, RunError
from dembound.kinds import kind_of
from dembound.machine import Memory
from dembound.motion import memory, stability
from dembound.motion.stability import LEAST
from dembound.packings import random_brick

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
    (problem,) = problems_in(lambda: choose_step(given(bar, 1.01 * limit)))
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


RANDOM = {"pattern": "B", "bricks": [20, 4], "radius": 0.25, "radius_ratio": 1.5, "brick": [4.0, 4.0]}
FRAMED = {**RANDOM, "pattern": "C", "edge_radius": 0.25}
TWO = {**RANDOM, "bricks": [2, 1], "brick": [8.0, 8.0]}
FREE = {"monitor": [], "wave": {}, "boundary": {}}


@pytest.mark.parametrize("packing", [lattice(40.0, 10.0, 0.5), RANDOM, FRAMED, TWO], ids="ABC2")
def test_sizes_are_known_before_the_scene_is_built(bar, packing) -> None:
    scene = build(bar({**FREE, "packing": packing}))
    expected, sizes = SceneSizes.expected(scene.case), scene.sizes

    # bricks of 80 disks have a few more or less than the mean of large ones, and regular rows have fewer contacts
    assert expected.disks == pytest.approx(sizes.disks, rel=0.15)
    assert expected.slots / expected.disks == pytest.approx(sizes.slots / sizes.disks, rel=0.15)
    assert expected.contacts / expected.disks == pytest.approx(sizes.contacts / sizes.disks, rel=0.17)
    assert expected.in_rows == sizes.in_rows


def test_a_scene_too_large_is_refused_before_its_brick_is_packed(bar, monkeypatch) -> None:
    monkeypatch.setattr(memory, "memory_here", lambda: Memory(8e9, 6e9))
    monkeypatch.setattr(random_brick, "load_or_pack", None)  # a call would raise a TypeError
    case = bar({**FREE, "packing": {**RANDOM, "bricks": [1000, 1000]}})

    with pytest.raises(CaseError, match=r"^packing.bricks: 6.84e\+07 disks need about [\d.]+ GB of memory, this "):
        build(case)


def test_the_continuum_is_known_before_the_scene_is_built(bar) -> None:
    case = bar(LAMB | {"outside": {"element": 5.0, "margin": 20}})
    scene = build(case)
    expected, sizes = SceneSizes.expected(case), scene.sizes

    assert expected.grid == sizes.grid
    assert sizes.grid.nodes == scene.outside.count == scene.count - sizes.disks
    assert sizes.moving == pytest.approx(scene.layout.count, rel=0.01)
    assert sizes.ties == 80
    assert expected_bytes(case) == pytest.approx(scene.largest_memory, rel=0.02)


def trials(case, **options):
    """The trials of the kind of body of a case."""
    return kind_of(case).trials(case, **options)


def test_sides_keep_their_dashpots_and_springs_but_not_their_waves(bar) -> None:
    springs = {"type": "viscoelastic_input", "distance": 5.0, "wave_p": "push"}
    found, words = trials(bar({"boundary.left": springs, "wave.push": {"type": "cosine", "amplitude": 1, "period": 1}}))
    rows = found[0].scene.supports

    assert len(rows.drive) == 0
    assert np.any(rows.damping > 0.0)
    assert np.any(rows.stiffness > 0.0)
    assert "no loads and waves" in words


def test_a_large_scene_is_a_reduced_copy_with_the_same_sides(bar) -> None:
    changes = {"packing.size": [200.0, 20.0], "hole": [{"name": "h", "type": "circle", "centre": [5, 5], "radius": 2}]}
    (reduced,), words = trials(bar(changes))
    (whole,), _ = trials(bar(changes), full=True)

    assert 0.5 * PARTICLES < reduced.scene.count <= PARTICLES
    assert whole.scene.count > 15_000
    assert set(reduced.scene.edges) == set(whole.scene.edges)
    # holes take particles and contacts away: the limit of the copy is that of the whole one within that of its size
    assert reduced.limit == pytest.approx(whole.limit, rel=2e-3)
    assert [word for word in words if "holes" in word]
    width, height = reduced.scene.size
    assert width / height == pytest.approx(10.0, rel=0.3)


def test_a_bar_is_measured_at_every_stage_of_its_method() -> None:
    case = small(PULLED, changes={"boundary.right": {"type": "viscous"}})
    found, words = trials(case)
    scene = build_bar(case)

    assert [trial.name for trial in found] == [f"patch, stage {k}" for k in range(1, 6)]
    assert min(trial.limit for trial in found) == scene.step_limit()
    assert {trial.step for trial in found} == {0.9 * scene.step_limit()}
    for trial in found:  # each with the bonds of its stage
        (part,) = trial.system(trial.step).parts
        assert scene.stable_step(part.bonds) == trial.limit
    assert words == ["101 nodes, the whole bar", "no loads and waves", "the method stays at each stage"]


def test_noise_has_the_same_expected_energy_in_all_components(bar) -> None:
    (trial,), _ = trials(bar({"motion.held": [], "packing.size": [50.0, 10.0]}))
    scene, noise = trial.scene, trial.noise()
    energy = np.stack([scene.mass, scene.mass, scene.inertia]) * noise**2

    np.testing.assert_array_equal(noise, trial.noise())
    # 2000 disks: means of χ² differ by √(2/2000) = 3 %, times four
    free = np.array([np.count_nonzero(row) for row in energy])
    np.testing.assert_allclose(energy.sum(axis=1) / free, energy.sum() / free.sum(), rtol=0.13)
    held = scene.supports.prescribed
    assert not noise[scene.supports.component[held], scene.supports.node[held]].any()


WEIGHT = {"load": [{"name": "gravity", "acceleration": [0.0, -9.81]}], "static.boundary.bottom.type": "fixed"}


@pytest.mark.parametrize("moves", [{"boundary.bottom.wave_s": "pulse", "wave": pulse(0.05)}, WEIGHT])
def test_the_column_beside_a_continuum_and_its_foot_are_kept(moves: dict[str, object]) -> None:
    """Though the waves or loads are left out for which there is one: the step limit is that of the whole scene."""
    case = small(SURROUNDED, changes=moves)
    (trial,), words = trials(case)

    assert words[0] == "12 m × 6 m, 78 disks and 793 nodes of a continuum, with the free-field column"
    assert list(trial.parts) == ["column", "body", "continuum", "foot"]
    assert not trial.scene.steady_load.any()
    assert len(trial.scene.supports.drive) == 0
    assert trial.limit == pytest.approx(step_limit(build(case)), rel=1e-6)


def test_ground_of_two_heights_is_tried_as_a_whole(monkeypatch) -> None:
    """Fewer bricks would be level, without the second column and the line on which both meet."""
    monkeypatch.setattr("dembound.disks.trials.PARTICLES", 20)
    surface = [[0.0, 20.0], [10.0, 20.0], [20.0, 10.0], [30.0, 10.0]]
    changes = {"ground": {"surface": surface}, "outside": {"element": 5.0}, "boundary.bottom.wave_s": "w"}
    case = small(GROUND, changes=changes)
    (trial,), words = trials(case)

    assert words[1] == "the whole scene, as the ground has two heights"
    assert len(trial.scene.seams) == len(trial.scene.feet) == 2
    assert trial.limit == pytest.approx(step_limit(build(case)), rel=1e-6)
