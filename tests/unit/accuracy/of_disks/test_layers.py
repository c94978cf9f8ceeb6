"""Errors of layered ground: delays by layer, the exact column, larger disks, sides and distances."""

from dataclasses import replace

import numpy as np
import pytest
from small_cases import OPEN, SOIL, Tables, small

from dembound.accuracy.estimate import causes_of
from dembound.accuracy.judge import judge_of
from dembound.accuracy.of_disks.causes import Formulas
from dembound.accuracy.of_disks.coarser import coarser
from dembound.accuracy.runner import measure
from dembound.disks.material.layered import materials_in
from dembound.disks.scene import build
from dembound.disks.stability import choose_step
from dembound.errors import CaseError
from dembound.formulas.disks.entry import late_by
from dembound.formulas.disks.reflections import Reflections
from dembound.formulas.history import earlier
from dembound.results.compare import relative_error
from dembound.running import Progress

COLUMN: Tables = SOIL | {
    "packing": {
        "pattern": "B",
        "radius": 0.125,
        "radius_ratio": 1.5,
        "brick": [2.5, 2.5],
        "seed": 3,
        "size": [2.5, 12.5],
    },
    "wave": {"in": SOIL["wave"]["in"] | {"frequency": 10.0}},
    "monitor": [{"name": "top", "position": [1.25, 12.5]}, {"name": "sand", "position": [1.25, 5.0]}],
}
"""Random disks in long waves."""

LATTICE: Tables = SOIL | {
    "boundary": SOIL["boundary"] | {"bottom": SOIL["boundary"]["bottom"] | {"half_mass": True}},
}
"""Short waves without reflections at the bottom: errors are those of the disks."""


def test_estimates_of_a_column_are_near_its_errors_beside_the_exact_motion() -> None:
    case, within = small(LATTICE), 1.5
    scene = build(case)
    step = choose_step(scene)[0]
    run = measure(case, Progress())[0]
    recorded = {
        name: replace(own, values={quantity: values[:, :2] for quantity, values in own.values.items()})
        for name, own in run.motions.items()
    }
    moved = earlier(recorded, late_by(scene))
    solution = judge_of(case).exact(case)
    exact = solution.motions(case, moved)
    causes = [each for each in causes_of(case, recorded, step, 1e9).found if each.name != "places"]
    for name, own in moved.items():
        error = relative_error(own.velocity[:, 0] - exact[name].velocity[:, 0], exact[name].velocity[:, 0])
        assert 1e-3 < error < 0.05
        size = np.linalg.norm(own.velocity[:, 0])
        parts = [float(np.linalg.norm(each.parts[name]["velocity"][:, 0]) / size) for each in causes]
        assert error / within < np.linalg.norm(parts) < within * error


def test_larger_disks_have_the_layers_of_the_packing_where_sides_have_moved_them() -> None:
    scene = build(small(COLUMN))
    larger = coarser(scene.case, scene, 1e-4, 0.6).case
    stretch = larger.size[1] / 12.5
    assert larger.joints == pytest.approx([8.5 * stretch, 4.0 * stretch])
    for own, made in zip(materials_in(scene.ground), materials_in(build(larger).ground), strict=True):
        assert made.density == own.density
        np.testing.assert_allclose(made.wave_speeds(1), own.wave_speeds(1), rtol=1e-3)  # P and S are not quite apart
    # layers of whole cells of the largest disks
    thin = small(COLUMN, changes={"layer.sand.thickness": 0.75, "run.duration": 0.01})
    assert coarser(thin, build(thin), 1e-4, 0.3).case.joints[0] == pytest.approx(8.5)


def test_a_side_reflects_as_the_mean_of_its_layers() -> None:
    scene = build(small(LATTICE | OPEN))
    alone = {}
    for number, height in enumerate((10.0, 6.0, 1.0)):
        one = scene.case.uniform_at(height)
        alone[number] = Reflections().of(build(one), "left", 1e-4)["s"].size
    shares = np.array([4.0, 4.5, 4.0]) / 12.5
    mean = np.sqrt(shares @ np.square(list(alone.values())))
    # disks of 0.25 m, of which layers have whole numbers
    assert Reflections().of(scene, "left", 1e-4)["s"].size == pytest.approx(mean, rel=1e-6)
    assert min(alone.values()) < 0.9 * mean


def test_what_is_known_of_uniform_ground_alone_is_not_used() -> None:
    held = COLUMN["boundary"] | {"bottom": {"type": "velocity", "wave_s": "in"}}
    scene = build(small(LATTICE | {"boundary": held}))
    motions = {}
    (side,) = Formulas(scene, 1e-4).held_sides.causes(motions)
    assert side.how == "unknown"
    jumping = small(LATTICE, changes={"wave.in": {"type": "constant", "amplitude": 1.0, "start": 0.1}})
    with pytest.raises(CaseError, match="continuous"):
        judge_of(jumping).exact(jumping)
    assert judge_of(scene.case).exact(replace(scene.case, layer=())) is None
