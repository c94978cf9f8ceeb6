"""Errors by disks at other places than the monitors', compared with the exact plane wave in a bar."""

from dataclasses import replace

import numpy as np
import pytest
from small_cases import PUSHED, small

from dembound.accuracy.of_disks.causes import Formulas, causes_of_run, ground_causes, rest_causes
from dembound.accuracy.of_disks.companions import Companions
from dembound.accuracy.of_disks.measured import settled_of
from dembound.accuracy.runner import at_step, measure
from dembound.disks.scene import DiskScene
from dembound.formulas.cause import STEP
from dembound.kinds import with_changes
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
    own, finer = (measure(case, Progress())[0].motions["m"] for case in (coarse, fine))
    own = replace(own, values={q: own.values[q][:, :2] for q in ("velocity", "displacement")})
    causes = causes_of_run(coarse, {"m": own}, 1e-4, 1e6, 1e7)
    (found,) = [each for each in causes.found if each.name == "bottom side"]
    assert found.of_disks
    for quantity, values in own.values.items():
        difference = (values - finer.at(own.time).values[quantity][:, :2])[:, 1]
        expected = 2.0 / 3.0 * np.asarray(found.parts["m"][quantity])[:, 1]
        assert np.linalg.norm(difference - expected) < 0.35 * np.linalg.norm(difference)


GRAVEL = PUSHED | {
    "packing": {"pattern": "A", "size": [10.0, 5.0], "radius": 0.25},
    "material": {"density": 2000.0, "p_wave_speed": 400.0, "law": "linearpbond", "fric": 0.3},
    "static": {"ratio": 1e-6, "boundary": {"bottom": {"type": "fixed"}}},
    "boundary": {
        "bottom": {"type": "velocity", "wave_s": "shake"},
        "left": {"type": "periodic"},
        "right": {"type": "periodic"},
    },
    "wave": {"shake": {"type": "cosine", "amplitude": 0.2, "period": 0.1}},
    "load": [{"name": "weight", "acceleration": [0.0, -9.81]}],
    "monitor": [{"name": "top", "position": [5.0, 4.75]}],
    "run": {"duration": 0.15},
}
"""Disks under their weight that slide as their base is shaken, from half of the run on."""

SHEARED = GRAVEL | {
    "material": GRAVEL["material"] | {"fric": 0.2, "pb_ten": 1e9, "pb_coh": 1e9},
    "static": {"stress": [-1e5, -1e5, 4e4]},
    "boundary": {"bottom": {"type": "viscous"}, "left": {"type": "viscous"}, "right": {"type": "viscous"}},
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
    recorded = {
        name: replace(own, values={q: v[:, :2] for q, v in own.values.items()}) for name, own in run.motions.items()
    }
    found = next(cause for cause in causes_of_run(case, recorded, step, run.work, 1e9).found if cause.name == STEP)
    assert (found.how, found.is_sample) == ("companion", True)

    own = recorded["top"].velocity[:, 0]
    true = np.linalg.norm(own - fine.motions["top"].at(recorded["top"].time).velocity[:, 0]) / np.linalg.norm(own)
    # one sample of a random error; were it all of the difference, or none of it, it would be 1.12 times or 0
    assert found.share("top", "velocity", recorded["top"]) == pytest.approx(true, rel=0.3)
    (formula,) = (cause for cause in Formulas(plan(case).scene, step).causes(recorded) if cause.name == STEP)
    assert true > 3.0 * formula.share("top", "velocity", recorded["top"])


def test_the_rest_is_that_of_the_given_disks_or_of_a_lattice_of_larger_ones() -> None:
    """Forces at rest are in proportion to the diameter, so that larger disks find the same error."""
    case = small(SHEARED)
    planned = plan(case)
    scene, step = planned.scene, planned.time_step
    own, larger = (Companions(case, scene, step, most) for most in (1e9, 0.0))
    assert larger.diameter > 1.5 * own.scene.ground.brick.mean_diameter
    found = [rest_causes(each, scene).found[0].parts["top"]["velocity"] for each in (own, larger)]
    peaks = [np.abs(each.recorded(scene)["top"].velocity[:, :2]).max() for each in (own, larger)]
    assert found[1] * peaks[1] == pytest.approx(found[0] * peaks[0], rel=0.15)
    assert settled_of(own) is not None
    assert not settled_of(own)["elastic"]
