"""Scenes for noise: without loads and waves, with all else, reduced if they are large."""

import numpy as np
import pytest
from small_cases import PULLED, SURROUNDED, small

from dembound.bar.scene import build_bar
from dembound.disks.scene import build
from dembound.disks.stability import step_limit
from dembound.disks.trials import PARTICLES
from dembound.kinds import kind_of


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


@pytest.mark.parametrize(
    "moves",
    [
        {"boundary.bottom.wave_s": "pulse", "wave.pulse": {"type": "cosine", "amplitude": 1.0, "period": 0.05}},
        {
            "load": [{"name": "gravity", "acceleration": [0.0, -9.81]}],
            "static.boundary.bottom.type": "fixed",
            "static.ratio": 1e-3,
        },
    ],
    ids=["waves", "static"],
)
def test_the_column_beside_a_continuum_and_its_foot_are_kept(moves: dict[str, object]) -> None:
    """Though the waves or loads are left out for which there is one: the step limit is that of the whole scene."""
    case = small(SURROUNDED, changes=moves)
    (trial,), words = trials(case)

    assert words[0] == "12 m × 6 m, 78 disks and 793 nodes of a continuum, with the free-field column"
    assert list(trial.parts) == ["column", "body", "continuum", "foot"]
    assert not trial.scene.steady_load.any()
    assert len(trial.scene.supports.drive) == 0
    assert trial.limit == pytest.approx(step_limit(build(case)), rel=1e-6)
