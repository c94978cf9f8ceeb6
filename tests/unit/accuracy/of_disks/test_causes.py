"""Errors by disks at other places than the monitors', compared with the exact plane wave in a bar."""

import numpy as np
import pytest
from plane_motion import in_plane, recorded
from scene_tables import grains, monitors
from small_cases import GRAINS, PUSHED, SOIL, Tables, around, small

from dembound.accuracy import runner
from dembound.accuracy.estimate import causes_of
from dembound.accuracy.judge import judge_of
from dembound.accuracy.of_disks.causes import Formulas, causes_of_run, ground_causes, rest_causes
from dembound.accuracy.of_disks.coarser import coarser
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.measured import cause_of_packing, settled_of
from dembound.accuracy.runner import Run, at_step, measure
from dembound.disks.material.layered import materials_in
from dembound.disks.scene import DiskScene, build
from dembound.disks.stability import choose_step
from dembound.errors import CaseError
from dembound.formulas.cause import STEP
from dembound.formulas.disks.entry import late_by
from dembound.formulas.history import History, earlier
from dembound.kinds import with_changes
from dembound.results.compare import relative_error
from dembound.running import Progress, plan

LENGTH, SPEED = 30.0, 1000.0

BAR = PUSHED | {
    "packing": {"pattern": "A", "size": [LENGTH, 1.5], "radius": 0.25},
    "boundary": {"left": {"type": "velocity", "wave_p": "push"}},
    "motion": {"held": ["y", "rotation"]},
    "wave": {"push": {"type": "cosine", "amplitude": 0.5, "period": 0.03}},
    "monitor": [{"name": "near", "position": [3.75, 0.75]}, {"name": "back", "position": [24.75, 0.75]}],
    "run": {"duration": 0.063},
}
"""A wave of 60 disks, which returns from the free end, and at the end not yet from the driven one."""


@pytest.fixture(scope="module")
def given() -> Companions:
    case = small(BAR)
    planned = plan(case)
    return Companions(case, planned.scene, planned.time_step, 0.0)


def exact(scene: DiskScene, place: float, time: np.ndarray) -> np.ndarray:
    """Velocity at a place (m): of the wave from the first disk, and of its reflection at the free end."""
    first = float(scene.positions[:, 0].min())
    wave = scene.case.wave["push"]
    return np.sum([wave.velocity(time - way / SPEED) for way in (place - first, 2 * LENGTH - place - first)], axis=0)


def test_other_places_change_the_motion_as_they_do_in_an_exact_wave(given: Companions) -> None:
    """Disks of 1.5 m: one monitor is 0.5 m from where it is asked for, so that ways there and back differ.

    The companion's disks, here as small as those given, delay what is compared by (qD)²/24 = 5e-4 of at most 60 m, q =
    2π/30 m: 0.03 m, which changes motion by q times that, 0.6 %. Between disks the polynomial has (qD)³/16 = 7e-5 of
    the motion, 7e-4 of a change that is q times 0.5 m of it. Half a per cent comes from the end of the record within a
    wave.
    """
    planned = plan(with_changes(given.case, {"packing.radius": 0.75}))
    scene = planned.scene
    places = next(cause for cause in ground_causes(given, scene, planned.time_step) if cause.name == "places")

    for name, own in given.recorded(scene).items():
        asked = next(monitor.position[0] for monitor in scene.case.monitor if monitor.name == name)
        expected = exact(given.scene, float(own.place[0]), own.time) - exact(given.scene, asked, own.time)
        assert np.linalg.norm(expected) > 0.03 * np.linalg.norm(own.values["velocity"][:, 0]) or asked == own.place[0]
        difference = np.asarray(places.parts[name]["velocity"])[:, 0] - expected
        assert np.linalg.norm(difference) <= 0.03 * np.linalg.norm(expected) + 1e-12


def test_waves_of_a_load_come_back_early_from_disks_that_are_held() -> None:
    """Compared with disks three times smaller, which have a third of this error.

    The depth of fixed sides is D/2 for P and 0.77 D for S waves; with the mean the error of P waves is 0.27 too large.
    Companions change the way of waves by up to 6 D, a third of the shorter waves of this pulse, by which they find
    sin(π/6)/(π/6) = 0.95 of the first order; and disks of 1 m disperse, 0.03 of the difference.
    """
    tables = {
        "packing": {"pattern": "A", "size": [21.0, 15.0], "radius": 0.5},
        "material": {"density": 1800.0, "p_wave_speed": 400.0, "fric": 0.5},
        "boundary": {"bottom": {"type": "fixed", "artificial": False}},
        "wave": {"q": {"type": "cubic_spline", "amplitude": 1.0, "period": 0.07}},
        "load": [{"name": "f", "force": [0.0, -1e5], "region": [9.0, 9.0, 12.0, 12.0], "wave": "q"}],
        "monitor": [{"name": "m", "position": [10.5, 4.5]}],
        "run": {"duration": 0.1},
    }
    coarse, fine = (small(tables, changes={"packing.radius": radius}) for radius in (0.5, 0.5 / 3))
    own, finer = (recorded(case)["m"] for case in (coarse, fine))
    causes = causes_of_run(coarse, {"m": own}, 1e-4, 1e6, 1e7)
    (found,) = [each for each in causes.found if each.name == "bottom side"]
    assert found.of_disks
    for quantity, values in own.values.items():
        difference = (values - finer.at(own.time).values[quantity])[:, 1]
        expected = 2.0 / 3.0 * np.asarray(found.parts["m"][quantity])[:, 1]
        assert np.linalg.norm(difference - expected) < 0.35 * np.linalg.norm(difference)


GRAVEL = PUSHED | {
    "packing": {"pattern": "A", "size": [10.0, 5.0], "radius": 0.25},
    "material": {"density": 2000.0, "p_wave_speed": 400.0, "law": "linearpbond", "fric": 0.3},
    "static": {"ratio": 1e-6, "boundary": {"bottom": {"type": "fixed"}}},
    "boundary": around("periodic", "left", "right") | {"bottom": {"type": "velocity", "wave_s": "shake"}},
    "wave": {"shake": {"type": "cosine", "amplitude": 0.2, "period": 0.1}},
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "monitor": [{"name": "top", "position": [5.0, 4.75]}],
    "run": {"duration": 0.15},
}
"""Disks under their weight that slide as their base is shaken, from half of the run on."""

SHEARED = GRAVEL | {
    "material": GRAVEL["material"] | {"fric": 0.2, "pb_ten": 1e9, "pb_coh": 1e9},
    "static": {"stress": [-1e5, -1e5, 4e4]},
    "boundary": around("viscous"),
    "load": [{"name": "hit", "force": [0.0, 1e3], "region": [4.0, 2.0, 6.0, 3.0], "wave": "shake"}],
    "run": {"duration": 0.05},
}
"""Disks whose contacts slide while they settle, under twice the shear that friction bears, and then a weak wave."""


def test_where_contacts_slide_the_time_step_is_found_with_half_of_it() -> None:
    """The error of the time step is 3.8 times that of the formula, which holds for elastic contacts."""
    case = small(GRAVEL)
    step = plan(case).time_step
    run, fine = (measure(at_step(case, step / n), Progress())[0] for n in (1, 8))
    assert run.laws == ("elastic", "linearpbond")
    motions = in_plane(run.motions)
    found = next(cause for cause in causes_of_run(case, motions, step, run.work, 1e9).found if cause.name == STEP)
    assert (found.how, found.is_sample) == ("companion", True)

    top = motions["top"]
    own = top.velocity[:, 0]
    true = np.linalg.norm(own - fine.motions["top"].at(top.time).velocity[:, 0]) / np.linalg.norm(own)
    # one sample of a random error; were it all of the difference, or none of it, it would be 1.12 times or 0
    assert found.share("top", "velocity", top) == pytest.approx(true, rel=0.3)
    (formula,) = (cause for cause in Formulas(plan(case).scene, step).causes(motions) if cause.name == STEP)
    assert true > 3.0 * formula.share("top", "velocity", top)


def test_the_rest_is_that_of_the_given_disks_or_of_a_lattice_of_larger_ones() -> None:
    """Forces at rest are in proportion to the diameter, so that larger disks find the same error."""
    case = small(SHEARED)
    planned = plan(case)
    scene, step = planned.scene, planned.time_step
    own, larger = (Companions(case, scene, step, most) for most in (1e9, 0.0))
    assert larger.diameter > 1.5 * own.scene.ground.brick.mean_diameter
    found = [rest_causes(each, scene).found[0].parts["top"]["velocity"] for each in (own, larger)]
    peaks = [np.abs(each.recorded(scene)["top"].velocity[:, :2]).max() for each in (own, larger)]
    # rests under friction differ: with the density changed by 1e-13 the second over the first is 0.73 to 1.0
    assert found[1] * peaks[1] == pytest.approx(found[0] * peaks[0], rel=0.35)
    assert settled_of(own) is not None
    assert not settled_of(own)["elastic"]


COLUMN: Tables = SOIL | {
    "packing": grains(2.5, 12.5, 0.25, 2.5, 3),
    "wave": {"in": SOIL["wave"]["in"] | {"frequency": 10.0}},
    "monitor": monitors(top=(1.25, 12.5), sand=(1.25, 5.0)),
}
"""Random disks in long waves."""

BELOW = {"bottom": SOIL["boundary"]["bottom"] | {"half_mass": True}}
LATTICE: Tables = SOIL | {"boundary": SOIL["boundary"] | BELOW}
"""Short waves without reflections at the bottom: errors are those of the disks."""


def test_estimates_of_a_column_are_near_its_errors_beside_the_exact_motion() -> None:
    case, within = small(LATTICE), 1.5
    scene = build(case)
    step = choose_step(scene)[0]
    motions = recorded(case)
    moved = earlier(motions, late_by(scene))
    solution = judge_of(case).exact(case)
    exact = solution.motions(case, moved)
    causes = [each for each in causes_of(case, motions, step, 1e9).found if each.name != "places"]
    for name, own in moved.items():
        error = relative_error(own.velocity[:, 0] - exact[name].velocity[:, 0], exact[name].velocity[:, 0])
        assert 1e-3 < error < 0.05
        size = np.linalg.norm(own.velocity[:, 0])
        parts = [float(np.linalg.norm(each.parts[name]["velocity"][:, 0]) / size) for each in causes]
        assert error / within < np.linalg.norm(parts) < within * error


@pytest.mark.slow
def test_larger_disks_have_the_layers_of_the_packing_where_sides_have_moved_them() -> None:
    scene = build(small(COLUMN))
    larger = coarser(scene.case, scene, 1e-4, 0.6).case
    stretch = larger.size[1] / 12.5
    assert larger.layer_planes == pytest.approx([8.5 * stretch, 4.0 * stretch])
    for own, made in zip(materials_in(scene.ground), materials_in(build(larger).ground), strict=True):
        assert made.density == own.density
        np.testing.assert_allclose(made.wave_speeds(1), own.wave_speeds(1), rtol=1e-3)  # P and S are not quite apart
    # layers of whole cells of the largest disks
    thin = small(COLUMN, changes={"layer.sand.thickness": 0.75, "run.duration": 0.01})
    assert coarser(thin, build(thin), 1e-4, 0.3).case.layer_planes[0] == pytest.approx(8.5)


TIME = np.linspace(0.0, 1.0, 21)


def test_runs_with_several_seeds_scatter_about_their_mean_and_lattices_have_none(monkeypatch):
    case = small(GRAINS, changes={"packing.seed": 7, "run.until": "silent"})
    seen = []

    def other(given, *_, **__):
        seen.append(given)
        motion = given.packing.seed * np.outer(TIME, [1.0, 2.0, 9.0])
        return Run(work=300, motions={"top": History.of(np.zeros(2), TIME, motion, 3.0 * motion)}), 0.0, 0.0

    monkeypatch.setattr(runner, "measure", other)
    times = np.array([0.0, 0.13, 0.7])
    motion = {"velocity": np.zeros((3, 2)), "displacement": np.zeros((3, 2))}
    (cause,) = cause_of_packing(case, {"top": History(np.zeros(2), times, motion)}, 3).found
    assert [each.packing.seed for each in seen] == [7, 8, 9]
    assert all(each.run.until != "silent" for each in seen)  # they must not end before the record
    # the first is one less than the mean of 7, 8 and 9; of three runs it is nearer to their own mean by √(2/3)
    np.testing.assert_allclose(cause.parts["top"]["displacement"], -np.outer(times, [1.0, 2.0]) * 1.5**0.5, atol=1e-12)
    rate = -3.0 * np.outer(times, [1.0, 2.0]) * 1.5**0.5
    np.testing.assert_allclose(cause.parts["top"]["velocity"], rate, atol=1e-12)
    assert cause.is_sample
    assert cause.of_disks
    with pytest.raises(CaseError, match="no random packing"):
        cause_of_packing(small(PUSHED), {}, 2)
