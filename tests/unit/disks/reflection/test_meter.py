"""Reflections of plane waves by sides, beside formulas."""

import math

import numpy as np
import pytest
from oblique import dashpot_formula
from scene_tables import ISOTROPIC, lattice
from small_cases import GRAINS, SURROUNDED, around, small

from dembound.continuum.sizing import Signal
from dembound.disks.reflection import measure_side, measured_sides
from dembound.disks.reflection.arrivals import arrivals_of, over_spectrum
from dembound.disks.reflection.bricks import end_scene
from dembound.disks.reflection.meter import Meter, Reflections
from dembound.disks.reflection.smeared import by_smeared_supports
from dembound.disks.scene import ground_of
from dembound.errors import CaseError
from dembound.waves import FileWave

DIAMETER, SPEED = 0.5, 1000.0
LATTICE = {
    "packing": lattice(8.0, 4.0, DIAMETER),
    "material": ISOTROPIC,
    "boundary": around("viscous", "right"),
    "run": {"duration": 0.01},
}


def measured(tables, side: str, step: float, frequencies, angles, kinds=("p", "s"), changes=None) -> Reflections:
    (found,) = Meter.of(side, step, end_scene(small(tables, changes=changes), side)).measure(frequencies, angles, kinds)
    return found


@pytest.mark.parametrize("half", [False, True])
@pytest.mark.parametrize("step", [0.0, 1.5e-4])
def test_normal_incidence_on_a_chain_is_reflected_as_its_equations_say(half, step) -> None:
    """Two equations, with p_j = e^{−iqaj} + R e^{iqaj}: that of the chain gives q, that of its last node R.

    In continuous time |R| is tan(qa/4) for a whole last mass and its square for half of it.
    """
    frequency = 80.0
    changes = {"boundary.right.half_mass": half}
    found = measured(LATTICE, "right", step, [frequency], [0.0], ("p",), changes)
    omega = 2.0 * math.pi * frequency
    square = (2.0 / step * math.sin(0.5 * omega * step)) ** 2 if step else omega**2
    rate = 1j * (math.sin(omega * step) / step if step else omega)
    mass, damping = 2500.0 * DIAMETER**2, 2500.0 * SPEED * DIAMETER
    stiffness = mass * (SPEED / DIAMETER) ** 2
    qa = math.acos(1.0 - 0.5 * mass * square / stiffness)
    last = stiffness - mass * (0.5 if half else 1.0) * square + rate * damping
    expected = abs((last - stiffness * np.exp(1j * qa)) / (last - stiffness * np.exp(-1j * qa)))
    assert math.sqrt(found.same["p"][0, 0]) == pytest.approx(expected, rel=1e-7)
    assert found.converted["p"][0, 0] < 1e-20
    if step == 0.0:
        assert expected == pytest.approx(math.tan(0.25 * qa) ** (2 if half else 1), rel=1e-9)


def by_continuum(angles: list[float], kind: str) -> np.ndarray:
    """Energies (2, a) that matched dashpots send back as the same and as the other kind, of a continuum with ν = 0."""
    found = [dashpot_formula(kind, angle) for angle in angles]
    return np.array([(each[kind] ** 2, each["energy"] - each[kind] ** 2) for each in found]).T


@pytest.mark.parametrize("kind", ["p", "s"])
def test_oblique_incidence_is_that_of_a_continuum_for_long_waves(kind) -> None:
    """At 1 Hz waves are 1,400 disks long or more: the lattice deviates by (qa)² = 2e-5 with half cells."""
    angles = [10.0, 30.0, 60.0, 75.0]
    found = measured(LATTICE, "right", 0.0, [1.0], angles, (kind,), {"boundary.right.half_mass": True})
    same, converted = by_continuum(angles, kind)
    np.testing.assert_allclose(found.same[kind][0], same, rtol=2e-4, atol=1e-6)
    np.testing.assert_allclose(found.converted[kind][0], converted, rtol=2e-4, atol=1e-6)


@pytest.mark.parametrize("kind", ["p", "s"])
def test_a_quick_answer_is_that_of_the_continuum(kind) -> None:
    """To rounding, or to its root where a wave is about to run along the side: S at 45°."""
    angles = [0.0, 10.0, 30.0, 45.0, 60.0, 75.0]
    found = by_smeared_supports(end_scene(small(LATTICE), "right"), "right", [1.0, 50.0], angles)
    same, converted = by_continuum(angles, kind)
    for frequency in (0, 1):
        np.testing.assert_allclose(found.same[kind][frequency], same, rtol=1e-9, atol=5e-8)
        np.testing.assert_allclose(found.converted[kind][frequency], converted, rtol=1e-9, atol=5e-8)


@pytest.mark.parametrize(("side", "kind"), [("left", "free"), ("bottom", "fixed")])
def test_sides_that_take_nothing_send_everything_back(side, kind) -> None:
    """For P and S waves of a random packing, at all sides, below the frequencies at which copies scatter."""
    found = measured(GRAINS, side, 1e-4, [20.0, 60.0], [0.0, 25.0], changes={"boundary": {side: {"type": kind}}})
    for wave in found.kinds:
        np.testing.assert_allclose(found.total(wave), 1.0, rtol=1e-8)
        assert found.converted[wave][0, 1] > 0.05


def test_a_side_is_measured_beside_matched_factors_and_a_continuum() -> None:
    """At the homogenised factors of long waves nothing comes back: amplitudes of the order qa/4 of whole masses."""
    case = small(GRAINS, changes={"boundary.right.beta_p": 0.5, "wave.pulse.period": 0.5})
    found = measure_side(case, "right", [0.0, 30.0], 3)
    assert found.matched is not None
    assert found.matched.total("p")[:, 0].max() < 1e-3 < found.found.total("p")[:, 0].min()
    nodes, continuum = found.continuum
    assert nodes > 100
    assert continuum.total("p").max() < 1e-3 < found.found.total("p").max()
    assert [arrival.name for arrival in found.arrivals] == ["waves from all directions"]


@pytest.mark.parametrize(
    ("side", "angles", "frequencies", "message"),
    [
        ("right", [90.0], 2, "--angle: is 90, must be at least 0 and below 90"),
        ("right", [0.0], [0.0], "--frequency: is 0, must be above 0"),
        ("top", [0.0], 2, "--side: is top, which is periodic"),
    ],
)
def test_what_is_refused(side, angles, frequencies, message) -> None:
    case = small(LATTICE | {"boundary": around("viscous", "right") | around("periodic", "top", "bottom")})
    with pytest.raises(CaseError, match=message):
        measure_side(case, side, angles, frequencies)
    with pytest.raises(CaseError, match="no side that absorbs"):
        measured_sides(small(LATTICE, changes={"boundary.right": {"type": "free"}}))


def test_springs_and_dashpots_along_the_normal_reflect_by_their_impedance() -> None:
    """R = (ρc − z)/(ρc + z) with z = c + k/iω of all supports per m of the side; on a lattice no P wave becomes S."""
    table = {"type": "viscoelastic", "distance": 3.0, "alpha_n": 2.0, "beta_p": 0.7}
    scene = end_scene(small(LATTICE | {"boundary": {"right": table}}), "right")
    found = by_smeared_supports(scene, "right", [15.0], [0.0])
    ground, supports = scene.ground, scene.supports
    length, own = scene.assembly.size[1], supports.component == 0
    z = (supports.damping[own].sum() + supports.stiffness[own].sum() / (2j * math.pi * 15.0)) / length
    impedance = ground.density * ground.wave_speeds(0)[0]
    assert found.same["p"][0, 0] == pytest.approx(abs((impedance - z) / (impedance + z)) ** 2, rel=1e-9)
    assert found.converted["p"][0, 0] < 1e-20


def test_the_end_of_a_side_is_whole_below_a_surface() -> None:
    """The strip of bricks is higher than the ground, which must not cut it off."""
    tables = LATTICE | {"boundary": {"bottom": {"type": "viscous"}}}
    surface = {"surface": [[0.0, 3.0], [3.0, 3.0], [5.0, 2.0], [8.0, 2.0]]}
    level, stepped = (end_scene(small(each), "bottom", 30) for each in (tables, tables | {"ground": surface}))
    assert stepped.disk_count == level.disk_count == 30


def test_a_side_is_answered_quickly_beside_matched_factors() -> None:
    case = small(GRAINS, changes={"boundary.right.beta_p": 1.0})
    found = measure_side(case, "right", [0.0, 30.0], 3, quick=True)
    assert found.matched is not None
    assert found.continuum is None
    # at its own factors nothing comes back, but for what cut bonds turn of P into S
    assert found.matched.total("p")[:, 0].max() < 1e-4 < found.found.total("p")[:, 0].min()
    assert measure_side(small(GRAINS), "right", [0.0], 3, quick=True).matched is None  # it has these factors
    outside = small({**GRAINS, "boundary": {"right": {"type": "outside"}}})
    with pytest.raises(CaseError, match="--quick: is not possible for side right"):
        measure_side(outside, "right", quick=True)


POINT = {"name": "blow", "position": [2.0, 4.0], "force": [0.0, -1e3], "wave": "pulse"}


def test_driven_sides_send_waves_along_the_normal_and_loads_spread_them() -> None:
    case = small(GRAINS | {"load": [POINT]})
    ground = ground_of(case)
    along = [("wave pulse along the normal", (kind,)) for kind in "ps"]
    assert [(each.name, each.kinds) for each in arrivals_of(case, "top", ground)][:2] == along
    (spreading,) = arrivals_of(case, "right", ground)
    assert spreading.name == "waves from load blow"
    assert spreading.kinds == ("p", "s")
    # the side is 6 m from the load, which is at its upper end: angles from 0 to atan(4/6)
    assert spreading.angles.max() == pytest.approx(math.degrees(math.atan2(4.0, 6.0)))
    assert spreading.angles.min() == pytest.approx(0.0)
    assert spreading.shares.sum() == pytest.approx(1.0)
    # cos θ / r of waves that spread in the plane: cos² θ at the same distance of the side
    shares = np.cos(np.radians(spreading.angles)) ** 2
    np.testing.assert_allclose(spreading.shares / spreading.shares.max(), shares, rtol=1e-12)


def test_a_load_on_the_side_does_not_reach_it_and_without_sources_all_directions_do() -> None:
    case = small(GRAINS | {"load": [POINT | {"position": [8.0, 2.0]}]})
    (only,) = arrivals_of(case, "right", ground_of(case))
    assert only.name == "waves from all directions"
    np.testing.assert_allclose(only.shares / only.shares[0], np.cos(np.radians(only.angles)))


def test_shares_are_weighted_with_the_spectrum_of_the_wave() -> None:
    """Two tones of amplitudes 2 and 1 have 4/5 and 1/5 of the energy; of a force √f times as large amplitudes.

    The tones last 100 and 1000 periods, so that 1/(2π²·100) = 5e-4 or somewhat more of the energy is far from them.
    """
    times = np.arange(20_001) * 0.005
    values = 2.0 * np.sin(2.0 * np.pi * times) + np.sin(20.0 * np.pi * times)
    text = "\n".join(f"{time:.3f} {value!r}" for time, value in zip(times, values.tolist(), strict=True))
    tones = FileWave.model_validate({"type": "file", "path": "tones.txt"}, context={"files": {"tones.txt": text}})
    shares = np.array([[0.1, 0.3, 0.2], [0.6, 0.3, np.nan]])
    found = over_spectrum(shares, np.array([1.0, 10.0]), Signal(tones, is_force=False))
    np.testing.assert_allclose(found, [0.2, 0.3, 0.2], rtol=5e-3)
    of_force = over_spectrum(shares, np.array([1.0, 10.0]), Signal(tones, is_force=True))
    np.testing.assert_allclose(of_force, [(4.0 * 0.1 + 10.0 * 0.6) / 14.0, 0.3, 0.2], rtol=5e-3)
    # halfway between two frequencies in log f the mean of both shares, beyond them that of the nearer one
    between = over_spectrum(np.array([[0.0], [1.0]]), np.array([0.1, 10.0]), Signal(tones, is_force=False))
    np.testing.assert_allclose(between, 0.6, rtol=1e-2)
    np.testing.assert_allclose(over_spectrum(shares, np.array([1.0, 10.0]), None), [0.35, 0.3, 0.2])
    assert np.isnan(over_spectrum(np.full((2, 1), np.nan), np.array([1.0, 10.0]), None)).all()


@pytest.mark.parametrize(("side", "angle"), [("bottom", 20.0), ("top", 20.0), ("left", 70.0), ("right", 70.0)])
def test_an_incident_wave_meets_upright_sides_at_the_complement_of_its_angle(side: str, angle: float) -> None:
    case = small(SURROUNDED | {"incident": {"type": "sv", "angle": -20.0, "wave": "pulse"}, "wave": GRAINS["wave"]})
    (only,) = arrivals_of(case, side, ground_of(case))
    assert only.kinds == ("s",)
    assert only.angles.tolist() == [angle]
