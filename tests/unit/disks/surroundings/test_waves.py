"""The motion of the undisturbed ground: near ties, in the packing, and beside a column of disks."""

import numpy as np
import pytest
from ground_motions import GENERAL, RAMP, ground, sine
from small_cases import SURROUNDED, problems_in, small

from dembound.continuum.medium import Medium, incident_wave, reflected_waves
from dembound.disks.scene import build
from dembound.disks.surroundings.ground_waves import GroundMotion, GroundWaves
from dembound.disks.surroundings.incident import power_through
from dembound.disks.surroundings.layered_waves import rising_in_layers
from dembound.disks.surroundings.oblique_layers import ObliqueLayers, oblique_in_layers
from dembound.waves import Ricker


def require_near(waves, times: np.ndarray, places: np.ndarray, corrector: np.ndarray, step: float, of: float) -> None:
    """Motion, strain, and velocities half a step behind, near places and as by the waves."""
    near = waves.near(places)
    exact = waves.motion("displacement", times, places, corrector)
    found = np.einsum("tq,cdq->tdc", near.amplitudes(times, 0.0), near.motion(places, corrector))
    np.testing.assert_allclose(found, exact, atol=2e-4 * np.abs(exact).max())
    exact = waves.motion("velocity", times, places)
    behind = near.amplitudes(times + step, step) @ near.velocities(step).T
    found = np.einsum("tq,cdq->tdc", behind, near.motion(places, 0.0 * corrector))
    np.testing.assert_allclose(found, exact, atol=of * np.abs(exact).max())


def test_near_places_the_motion_is_that_of_the_waves() -> None:
    """Places within 8 m, half of the shortest wave: 1e-5 by the estimate of `DELAYS`; correctors as by differences."""
    waves = ground(sine(40.0), 1e-3)
    rng = np.random.default_rng(1)
    places, corrector = rng.uniform(0.0, 8.0, (20, 2)) * [1.0, 0.1], rng.normal(size=(3, 4, 20))
    require_near(waves, np.array([0.31, 0.35, 0.4]), places, corrector, 1e-4, 1e-3)
    # ties within 2 m on both sides of a joint, beside which each layer has its own gradients
    places, corrector = rng.uniform([0.0, 10.0], [2.0, 14.0], (20, 2)), rng.normal(size=(3, 4, 20))
    require_near(layers([SOFT, GENERAL], [12.0]), TIMES, places, corrector, 1e-3, 2e-4)


def test_the_packing_moves_beyond_its_mean_strain() -> None:
    """Under uniform gradients: u + χ : ∇u, with ∂u_a/∂b from differences of u itself, in the order xx, yy, xy, yx."""
    waves, corrector = ground(RAMP), np.random.default_rng(2).normal(size=(3, 4, 1))

    def u(x: float, y: float) -> np.ndarray:
        return waves.motion("displacement", np.array([1.0]), np.array([(x, y)]))[0, 0, :2]

    (xx, yx), (xy, yy) = u(3.0, 2.0) - u(2.0, 2.0), u(2.0, 3.0) - u(2.0, 2.0)
    moved = waves.motion("displacement", np.array([1.0]), np.array([(2.0, 2.0)]), corrector)[0, 0]
    expected = np.append(u(2.0, 2.0), 0.0) + corrector[:, :, 0] @ [xx, yy, xy, yx]
    np.testing.assert_allclose(moved, expected, rtol=1e-9)


def test_disks_of_a_band_count_by_their_mass_at_its_centre_of_mass() -> None:
    """Then a uniform strain is exact between the first and the last band, for any disks."""
    rng = np.random.default_rng(4)
    up, mass = rng.uniform(0.0, 8.0, 60), rng.uniform(1.0, 2.0, 60)
    heights = np.linspace(1.0, 7.0, 23)
    values = np.column_stack([3.0 * up - 1.0, 2.0 - 5.0 * up, up])
    found = GroundMotion(up, mass, 1.0, heights).at_heights(values)
    np.testing.assert_allclose(found[:, :2], np.column_stack([3.0 * heights - 1.0, 2.0 - 5.0 * heights]), atol=1e-12)


INCIDENT = {"type": "sv", "angle": 20.0, "wave": "pulse"}
PULSE = {"type": "cosine", "amplitude": 1.0, "period": 0.05}
BELOW = SURROUNDED | {"incident": INCIDENT, "wave": {"pulse": PULSE}}


def test_the_power_through_a_side_is_that_of_the_waves_that_run_inwards() -> None:
    """Through the left side all three, as all run to the right; of a sine ½ F per m² in the mean; none on the right."""
    waves = ground(sine(20.0))
    edges, times = (-3.0, 5.0, 2.0, 12.0), np.linspace(0.0, 1.0, 4001)[:-1]
    along = sum(wave.flux(GENERAL)[0] for wave in waves.waves)

    assert power_through("left", edges, waves)(times).mean() == pytest.approx(0.5 * 10.0 * along, rel=1e-6)
    assert power_through("left", edges, waves, 0.25)(times).mean() == pytest.approx(0.125 * 10.0 * along, rel=1e-6)
    assert not power_through("right", edges, waves)(times).any()
    up = waves.waves[0].flux(GENERAL)[1]
    assert power_through("bottom", edges, waves)(times).mean() == pytest.approx(0.5 * 8.0 * up, rel=1e-6)
    assert power_through("top", edges, waves)(times).mean() == pytest.approx(0.5 * 8.0 * up, rel=1e-6)

    # a mass on the surface sends back as much; its delay is of the first order in ωm/ρc = 0.006, energies of the second
    heavy = ground(sine(20.0), mass=0.05 * GENERAL.density)
    for side, expected in (("left", 10.0 * along), ("top", 8.0 * up)):
        assert power_through(side, edges, heavy)(times).mean() == pytest.approx(0.5 * expected, rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "problem"),
    [
        ({"boundary.left": {"type": "viscous"}}, 'boundary.left.type: is "viscous", but the wave of [incident]'),
        ({"boundary.top": {"type": "fixed"}}, 'boundary.top.type: is "fixed", but the wave of [incident]'),
        ({"boundary.bottom.wave_s": "pulse"}, "boundary.bottom.wave_s: is not allowed together with [incident]"),
        # of the scene
        ({"incident.angle": 45.0}, "incident.angle: is 45; from the critical angle of this packing on, 45 degrees"),
        ({"incident.point": [30.0, 30.0]}, "incident.point: "),
    ],
)
def test_what_is_refused(changes, problem: str) -> None:
    found = "".join(problems_in(lambda: build(small(BELOW, changes=changes))))
    assert problem in found
    assert "point" not in problem or "give wave.pulse.start = 0.05" in found


WAVELET = Ricker(type="ricker", amplitude=1.0, frequency=20.0, start=0.02)
TIMES = np.array([0.05, 0.081, 0.11, 0.13])
SURFACE, MASS, GRAIN = 30.0, 30.0, 0.1
SOFT = Medium.isotropic(1800.0, 500.0, 250.0)


def test_ground_without_a_surface_sends_nothing_back() -> None:
    """Above the uppermost joint; below it runs what the joint reflects, (Z₁ − Z₂)/(Z₁ + Z₂) of the wave."""
    stiff = Medium.isotropic(2300.0, 1000.0, 500.0)
    waves = rising_in_layers([SOFT, stiff], [5.0], None, (WAVELET, None), 0.0, (0.0, 0.2), GRAIN)
    times, (below, above) = np.linspace(0.0, 0.2, 40), (2300.0 * 500.0, 1800.0 * 250.0)
    up, down = 5.0 / 500.0 + 2.0 / 250.0, 5.0 / 500.0 + 4.0 / 500.0
    passed = 2.0 * below / (below + above) * WAVELET.velocity(times - up)
    back = (below - above) / (below + above) * WAVELET.velocity(times - down)
    expected = np.stack([passed, WAVELET.velocity(times - 1.0 / 500.0) + back], axis=1)
    found = waves.motion("velocity", times, np.array([(0.0, 7.0), (0.0, 1.0)]))[:, :, 0]
    np.testing.assert_allclose(found, expected, atol=1e-5)


LIGHT = 3.0


def layers(media: list[Medium], joints: list[float], kind: str = "sv") -> ObliqueLayers:
    incident = incident_wave(media[-1], kind, -25.0).shifted(0.01)
    return oblique_in_layers(media, joints, (SURFACE, LIGHT), incident, WAVELET, (0.0, 0.2), GRAIN)


def require_alike(equal, uniform: GroundWaves, box: tuple[float, ...], of: float, sides: tuple[str, ...]) -> None:
    """Motion with correctors, and the power through sides, of layers of one medium and of uniform ground."""
    rng = np.random.default_rng(1)
    places, corrector = rng.uniform([-9.0, 0.0], 30.0, (20, 2)), 0.1 * rng.normal(size=(3, 4, 20))
    for quantity in ("displacement", "velocity"):
        expected = uniform.motion(quantity, TIMES, places, corrector)
        found = equal.motion(quantity, TIMES, places, corrector)
        np.testing.assert_allclose(found, expected, atol=of * np.abs(expected).max())
    times = np.linspace(0.0, 0.15, 50)
    for side in sides:
        expected = power_through(side, box, uniform)(times)
        np.testing.assert_allclose(power_through(side, box, equal)(times), expected, atol=1e-4 * np.abs(expected).max())


def test_equal_layers_under_a_wave_from_below_move_as_uniform_ground() -> None:
    """Of any symmetry, with a mass on its surface; the incident wave moves along x and, less, along y."""
    waves, signals = [], []
    for kind in ("sv", "p"):
        incident = incident_wave(GENERAL, kind, 0.0)
        part = incident.motion[0] + 0.5 * incident.motion[1]
        own = [incident, *reflected_waves(GENERAL, incident, SURFACE, MASS)]
        waves, signals = waves + own, signals + [WAVELET.model_copy(update={"amplitude": part})] * len(own)
    both = (WAVELET, WAVELET.model_copy(update={"amplitude": 0.5}))
    equal = rising_in_layers([GENERAL] * 3, [20.0, 8.0], (SURFACE, MASS), both, 0.0, (0.0, 0.15), GRAIN)
    uniform = GroundWaves(GENERAL, tuple(waves), tuple(signals), GRAIN)
    require_alike(equal, uniform, (0.0, 10.0, 2.0, 29.0), 2e-5, ("bottom",))
    assert not power_through("left", (0.0, 10.0, 2.0, 29.0), equal)(TIMES).any()


@pytest.mark.parametrize("kind", ["sv", "p"])
def test_equal_layers_move_as_uniform_ground(kind: str) -> None:
    """With the same first arrival, and with the same power through all sides."""
    incident = incident_wave(GENERAL, kind, -25.0).shifted(0.01)
    waves = (incident, *reflected_waves(GENERAL, incident, SURFACE, LIGHT))
    uniform, equal = (
        GroundWaves(GENERAL, waves, (WAVELET,) * len(waves), GRAIN),
        layers([GENERAL] * 3, [20.0, 8.0], kind),
    )
    require_alike(equal, uniform, (0.0, 10.0, 15.0, 24.0), 1e-5, ("left", "right", "bottom", "top"))
    below = np.random.default_rng(1).uniform([-9.0, 0.0], [30.0, 8.0], (20, 2))
    assert equal.arrives(below) == uniform.arrives(below)
    assert equal.arrives(np.array([(1.0, 9.0)])) <= uniform.arrives(np.array([(1.0, 9.0)])) + 1e-12
