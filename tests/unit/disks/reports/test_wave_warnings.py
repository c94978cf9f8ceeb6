"""Waves and loads that are too short for the disks, too long for the run, too weak or too strong."""

import numpy as np
import pytest
from warned_cases import DENSE, SLOW, warned

from dembound.casefile import Case
from dembound.casefile.magnitudes import stress_in_words
from dembound.disks.reports.wave_warnings import particles_per_wavelength
from dembound.disks.scene import build
from dembound.running import plan
from dembound.waves.spectrum import HANN_FADE


def test_particles_per_wavelength_at_the_waves_highest_frequency_and_slowest_speed(bar) -> None:
    # c_s = c_p/2 = 500 m/s, the Hann lobe fades at 3.27/T, disks are 0.5 m apart
    for held, speed in ((["rotation"], 1000.0 / np.sqrt(2.0)), ([], 500.0), (["y"], 500.0)):
        scene = build(bar({"motion.held": held}))
        found = particles_per_wavelength(scene)
        assert found == {"pulse": pytest.approx(speed * 0.01 / HANN_FADE / 0.5, rel=1e-9)}


@pytest.mark.parametrize(("count", "few"), [(19.9, True), (20.1, False)])
def test_waves_with_fewer_than_twenty_particles_are_warned_of(bar, count: float, few: bool) -> None:
    period = count * 0.5 * HANN_FADE / 500.0
    # the mean frequency of a Hann lobe's energy, sin²πx/[πx(1 − x²)]² over x = fT, is 0.505/T
    said = (
        "wave.pulse: has 19.9 particles in its shortest wavelength, fewer than 20, but 129 in that of its mean "
        "frequency; the packing will disperse its shortest parts only"
    )

    assert warned(bar({"wave.pulse.period": period, "run.duration": 0.1})) == few * [said]


GRIPPED = {
    "wave.pulse": {"type": "constant", "amplitude": 1e-3, "rise": 0.0},
    "boundary.left": {"type": "velocity", "wave_p": "pulse"},
}


def short_waves(case: Case) -> list[str]:
    return [warning for warning in warned(case) if "disperse" in warning]


@pytest.mark.parametrize(
    ("rise", "said"), [(0.0, "is a step (rise = 0)"), (1e-8, "rises within 1e-08 s"), (0.06, "rises within 0.06 s")]
)
def test_a_rise_too_short_for_the_particles_is_named_with_one_that_is_long_enough(bar, rise, said) -> None:
    # 20 disks of 0.5 m at 500 m/s, times 3.27
    changes = {"wave.pulse": {"type": "constant", "amplitude": 1e-3, "rise": rise}, "run.duration": 0.01}
    expected = (
        f"wave.pulse: {said}, which is shorter than the particles can follow, 0.065 s; the packing will disperse it"
    )
    assert short_waves(bar(changes)) == [expected]
    assert short_waves(bar({**changes, "wave.pulse.rise": 0.066})) == []


def test_a_period_below_that_of_one_disk_has_no_count(bar) -> None:
    found = short_waves(bar({"wave.pulse.period": 1e-4, "run.duration": 0.01}))
    assert found[0].startswith("wave.pulse: has a shortest wavelength below the diameter of a particle; ")


def test_a_slow_grip_may_start_suddenly(bar) -> None:
    # at 1000 m/s, 100 ways of 10 m are 1 s
    for duration, sudden in ((0.99, 1), (1.01, 0)):
        assert len(short_waves(bar({**GRIPPED, "run.duration": duration}))) == sudden
    load = [{"name": "tap", "position": [5.0, 0.5], "force": [1.0, 0.0], "wave": "pulse"}]
    assert len(short_waves(bar({**GRIPPED, "run.duration": 1.01, "load": load}))) == 1
    assert len(short_waves(bar({**GRIPPED, "run.duration": 1.01, "boundary.left.type": "viscous_input"}))) == 1


def test_a_wave_stronger_than_the_locked_in_stress_is_warned_of(bar) -> None:
    # the default locks in 10 MPa; ρcv = 2500·1000·v reaches that at 4 m/s; packings meet it within 0.05 %
    for amplitude, strong in ((3.99, False), (4.01, True)):
        found = warned(bar({**DENSE, "wave.pulse.amplitude": amplitude}))
        assert [warning.split(":")[0] for warning in found] == strong * ["wave.pulse"]


@pytest.mark.parametrize(("amplitude", "strong"), [(0.79, False), (0.81, True)])
def test_a_wave_stronger_than_the_stress_it_comes_upon_is_warned_of(bar, amplitude: float, strong: bool) -> None:
    # ρcv = 2500·1000·v reaches the mean of 1 and 3 MPa at 0.8 m/s; 0.81 m/s make 2.025
    static = {"stress": [-1e6, -3e6, 0.5e6]}
    found = warned(bar({**SLOW, "motion.held": [], "wave.pulse.amplitude": amplitude, "static": static}))
    said = "wave.pulse: has a stress ρcv of 2.03 MPa, above the confining stress of 2 MPa; "
    assert [warning[: len(said)] for warning in found if warning.startswith("wave")] == strong * [said]


def test_a_lattice_without_stress_is_not_warned_of(bar) -> None:
    assert warned(bar({**SLOW, "wave.pulse.amplitude": 10.0})) == []


@pytest.mark.parametrize(("period", "long"), [(0.99, False), (1.01, True)])
def test_a_wave_is_compared_with_the_way_through_the_scene(bar, period: float, long: bool) -> None:
    # 10 m at 1000 m/s
    found = warned(bar({"wave.pulse.period": period, "run.duration": 1.0}))
    said = "wave.pulse: has a period of 1.01 s, 101 times its way through the scene, 0.01 s; "
    assert [warning[: len(said)] for warning in found] == long * [said]


BREAKABLE = {**SLOW, "material.law": "linearpbond", "material.pb_ten": 5e6}


@pytest.mark.parametrize(("amplitude", "weak"), [(2.02e-4, False), (1.98e-4, True)])
def test_a_weak_wave_beside_the_strength(bar, amplitude: float, weak: bool) -> None:
    # ρc = 2.5e6 Pa·s/m
    found = warned(bar({**BREAKABLE, "wave.pulse.amplitude": amplitude}))
    said = "wave.pulse: its stress ρcv is 495 Pa, 0.0099 % of material.pb_ten, 5 MPa: Pa and MPa?"
    assert found == weak * [said]


@pytest.mark.parametrize(("strength", "strong"), [(1251.0, False), (1249.0, True)])
def test_a_wave_far_beyond_the_strength(bar, strength: float, strong: bool) -> None:
    found = warned(bar({**BREAKABLE, "material.pb_ten": strength}))
    said = "wave.pulse: its stress ρcv is 1.25 MPa, 1,001 times material.pb_ten, 1249 Pa: Pa and MPa?"
    assert found == strong * [said]


def test_the_strength_counts_only_where_bonds_have_one(bar) -> None:
    weak = {**SLOW, "wave.pulse.amplitude": 1e-9}
    assert warned(bar(weak)) == []
    assert warned(bar({**weak, "material.law": "linearpbond", "material.pb_coh": 5e6})) == []


def test_the_largest_of_all_stresses_counts(bar) -> None:
    weak = {**BREAKABLE, "wave.pulse.amplitude": 1e-9}
    # what has come to rest under 1 MPa is near its strength whatever the wave
    assert warned(bar({**weak, "static": {"stress": [0.0, 1e6, 0.0]}})) == []
    said = "static.stress: its largest component is 400 Pa, 0.008 % of material.pb_ten, 5 MPa: Pa and MPa?"
    assert warned(bar({**weak, "static": {"stress": [0.0, -400.0, 0.0]}})) == [said]


@pytest.mark.parametrize(
    ("load", "what", "stress"),
    [
        # 2 m of the height of 1 m count no more than that; the wave's peak is 1
        ({"force": [100.0, 0.0], "region": [4.0, 0.0, 6.0, 1.0]}, "its force over the width it acts on", 100.0),
        ({"force": [0.0, 100.0], "region": [4.0, 0.0, 6.0, 1.0]}, "its force over the width it acts on", 50.0),
        ({"force": [100.0, 0.0], "position": [5.0, 0.5]}, "its force over the width it acts on", 200.0),
        ({"acceleration": [0.01, 0.0]}, "its stress ρaL", 250.0),
        ({"acceleration": [0.01, 0.0], "region": [4.0, 0.0, 6.0, 1.0]}, "its stress ρaL", 50.0),
    ],
    ids=str,
)
def test_loads_beside_the_strength(bar, load: dict, what: str, stress: float) -> None:
    free = {"motion.held": [], "boundary.left": {"type": "viscous"}}
    tap = {"name": "tap", "wave": "pulse", **load}
    for strength, weak in ((0.99e4 * stress, False), (1.01e4 * stress, True)):
        case = bar({**BREAKABLE, **free, "load": [tap], "wave.pulse.amplitude": 1.0, "material.pb_ten": strength})
        against = f"material.pb_ten, {stress_in_words(strength)}: Pa and MPa?"
        said = f"load.tap: {what} is {stress:g} Pa, 0.0099 % of {against}"
        assert warned(case) == weak * [said]


@pytest.mark.parametrize("amplitude", [4.0, -4.0])
def test_a_load_is_as_strong_as_the_crest_of_its_wave(bar, amplitude: float) -> None:
    free = {"motion.held": [], "boundary.left": {"type": "viscous"}, "wave.pulse.amplitude": amplitude}
    tap = {"name": "tap", "wave": "pulse", "force": [100.0, 0.0], "region": [4.0, 0.0, 6.0, 1.0]}
    (found,) = warned(bar({**BREAKABLE, **free, "load": [tap]}))

    # 4·100 N per metre of thickness on a height of 1 m
    said = "load.tap: its force over the width it acts on is 400 Pa, 0.008 % of material.pb_ten, 5 MPa: Pa and MPa?"
    assert found == said


def test_a_wave_counts_with_the_largest_of_its_stresses(bar) -> None:
    # ρc_p v = 2.5e6·1e-4 Pa as a P wave, half of that as an S wave, which comes to too little by itself
    both = {"motion.held": [], "boundary.left": {"type": "viscous_input", "wave_p": "pulse", "wave_s": "pulse"}}
    shear = {"motion.held": [], "boundary.left": {"type": "viscous_input", "wave_s": "pulse"}}
    for driven, said in ((both, []), (shear, ["wave.pulse: its stress ρcv is 125 Pa"])):
        case = bar({**BREAKABLE, **driven, "wave.pulse.amplitude": 1e-4, "material.pb_ten": 2e6})
        assert [each.split(",")[0] for each in warned(case)] == said


def test_a_slow_grip_strains_the_body_to_its_strength(bar) -> None:
    # ρcv of 1 µm/s is 2.5 Pa, but 10 s of it strain 10 m by 1e-6, which is 2.5 kPa
    slow = {"type": "constant", "amplitude": 1e-6}
    grip = {"boundary.left": {"type": "velocity", "wave_p": "pulse"}, "wave.pulse": slow}
    for duration, weak in ((10.0, False), (1.9, True)):
        found = warned(bar({**BREAKABLE, **grip, "run.duration": duration}))
        said = "wave.pulse: its stress ρc²u/L is 475 Pa, 0.0095 % of material.pb_ten, 5 MPa: Pa and MPa?"
        assert [each for each in found if "stress" in each] == weak * [said]


def test_a_grip_strains_the_body_along_its_own_normal(bar) -> None:
    # 0.19 s of 1 µm/s on a height of 1 m; over the length of 10 m it were a tenth of that
    slow = {"wave.pulse": {"type": "constant", "amplitude": 1e-6}, "run.duration": 0.19, "motion.held": []}
    grip = {"boundary": {"bottom": {"type": "velocity", "wave_p": "pulse"}, "top": {"type": "fixed"}}}
    found = warned(bar({**BREAKABLE, **slow, **grip}))
    said = "wave.pulse: its stress ρc²u/L is 475 Pa, 0.0095 % of material.pb_ten, 5 MPa: Pa and MPa?"
    assert [each for each in found if "stress" in each] == [said]


@pytest.mark.parametrize(("side", "axis"), [("left", 0), ("bottom", 1)])
def test_a_wave_is_as_strong_as_its_speed_across_its_side(bar, side: str, axis: int) -> None:
    moduli = {"density": 2500.0, "law": "linearpbond", "emod": 1.25e9, "pb_emod": 1.25e9, "pb_ten": 1e9}
    packing = {key: DENSE[key] for key in ("packing", "monitor")}
    driven = {"boundary": {side: {"type": "viscous_input", "wave_p": "pulse"}}, "motion.held": []}
    case = bar({**packing, **SLOW, **driven, "material": moduli, "wave.pulse.amplitude": 1e-3})
    tensor = plan(case).scene.ground.material_tensor
    speeds = [float(np.sqrt(tensor[each, each] / 2500.0)) for each in (0, 1)]

    # a random brick is not as stiff along x as along y
    assert abs(speeds[1] / speeds[0] - 1.0) > 1e-3
    (found,) = (each for each in warned(case) if "stress" in each)
    assert found.startswith(f"wave.pulse: its stress ρcv is {stress_in_words(2500.0 * speeds[axis] * 1e-3)}, ")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"wave.pulse.amplitude": 50.0},
            "wave.pulse: particles move at up to 50 m/s, P waves along x run at 1000 m/s, so strains are v/c = 5 %; ",
        ),
        ({"wave.pulse.amplitude": 29.0}, ""),
        (
            {"load": [{"name": "weight", "acceleration": [0.0, -9.81e5]}]},
            "load.weight: its stress ρaL, 2452 MPa, is 98 % of the stiffness, 2500 MPa, and so are strains; ",
        ),
        ({"load": [{"name": "weight", "acceleration": [0.0, -9.81]}]}, ""),
    ],
)
def test_strains_far_beyond_those_of_the_elastic_law_are_warned_of(bar, changes: dict, said: str) -> None:
    """Above 3 %: of velocities 1000 m/s, that of the P waves that enter, of stresses 2.5 GPa; the body is 1 m high."""
    free = {"motion.held": []}
    lines = [line for line in warned(bar(free | changes)) if "the elastic law is for small ones" in line]
    assert [line.startswith(said) for line in lines] == [True] * bool(said)
    assert not any("for small ones" in line for line in warned(bar(free | changes | {"material.law": "linearpbond"})))
