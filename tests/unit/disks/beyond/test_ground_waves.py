"""The motion of the undisturbed ground: near ties, in the packing, and that of waves that run straight up."""

import numpy as np
from ground_motions import GENERAL, RAMP, ground, sine

from dembound.disks.beyond.ground_waves import GroundWaves, rising_waves
from dembound.disks.beyond.incident import power_through
from dembound.outside.medium import Medium


def test_near_places_the_motion_is_that_of_the_waves() -> None:
    """Places within 8 m, half of the shortest wave: 1e-5 by the estimate of `DELAYS`; correctors as by differences."""
    waves = ground(sine(40.0), 1e-3)
    rng = np.random.default_rng(1)
    places, corrector = rng.uniform(0.0, 8.0, (20, 2)) * [1.0, 0.1], rng.normal(size=(3, 4, 20))
    near, times = waves.near(places), np.array([0.31, 0.35, 0.4])
    exact = waves.motion("displacement", times, places, corrector)
    found = np.einsum("tq,cdq->tdc", near.amplitudes(times), near.motion(places, corrector))

    np.testing.assert_allclose(found, exact, atol=2e-4 * np.abs(exact).max())
    moving = waves.motion("velocity", times, places)
    behind = near.amplitudes(times + 1e-4) @ near.velocities(1e-4).T
    found = np.einsum("tq,cdq->tdc", behind, near.motion(places, np.zeros((3, 4, 20))))
    np.testing.assert_allclose(found, moving, atol=1e-3 * np.abs(moving).max())


def test_the_packing_moves_beyond_its_mean_strain() -> None:
    """Under uniform gradients: u + χ : ∇u, with ∂u_a/∂b from differences of u itself, in the order xx, yy, xy, yx."""
    waves, corrector = ground(RAMP), np.random.default_rng(2).normal(size=(3, 4, 1))

    def u(x: float, y: float) -> np.ndarray:
        return waves.motion("displacement", np.array([1.0]), np.array([(x, y)]))[0, 0, :2]

    (xx, yx), (xy, yy) = u(3.0, 2.0) - u(2.0, 2.0), u(2.0, 3.0) - u(2.0, 2.0)
    moved = waves.motion("displacement", np.array([1.0]), np.array([(2.0, 2.0)]), corrector)[0, 0]
    expected = np.append(u(2.0, 2.0), 0.0) + corrector[:, :, 0] @ [xx, yy, xy, yx]
    np.testing.assert_allclose(moved, expected, rtol=1e-9)


def rising(height: float) -> GroundWaves:
    return rising_waves(GENERAL, height, (sine(4.0), sine(7.0)), 0.1)


def test_rising_waves_have_the_given_velocities_at_their_height() -> None:
    times = np.linspace(0.0, 0.3, 50)
    given = np.stack([sine(frequency).velocity(times) for frequency in (4.0, 7.0)], axis=1)
    found = rising(3.0).motion("velocity", times, np.array([(7.0, 3.0)]))[:, 0]
    np.testing.assert_allclose(found[:, :2], given, atol=1e-12)
    assert not found[:, 2].any()


def test_rising_waves_obey_the_equation_of_motion_and_run_upwards() -> None:
    """ρü = C u″ with C = [[c66, c26], [c26, c22]]; the power is that of stress times velocity, upwards."""
    waves = rising(0.0)
    times, h = np.array([0.02, 0.05]), 0.3

    def u(y: float, after: float = 0.0) -> np.ndarray:
        return waves.motion("displacement", times + after, np.array([(0.0, y)]))[:, 0, :2]

    tensor = np.array([[0.9e9, 0.3e9], [0.3e9, 2.2e9]])
    bent = (u(-h) - 2.0 * u(0.0) + u(h)) / h**2 @ tensor
    faster = 2500.0 * (u(0.0, -1e-4) - 2.0 * u(0.0) + u(0.0, 1e-4)) / 1e-8
    np.testing.assert_allclose(bent, faster, atol=2e-3 * np.abs(faster).max())
    stress = (u(h) - u(-h)) / (2.0 * h) @ tensor
    velocity = waves.motion("velocity", times, np.array([(0.0, 0.0)]))[:, 0, :2]
    power = power_through("bottom", (0.0, 4.0, 0.0, 9.0), waves, 0.5)(times)
    np.testing.assert_allclose(-2.0 * np.sum(stress * velocity, axis=1), power, rtol=2e-3)


def test_of_an_isotropic_medium_each_is_one_wave() -> None:
    alike = Medium(2500.0, c11=2.5e9, c22=2.5e9, c12=0.7e9, c66=0.9e9)
    assert len(rising_waves(alike, 0.0, (RAMP, RAMP), 0.1).waves) == 2
    assert len(rising_waves(alike, 0.0, (None, RAMP), 0.1).waves) == 1
    assert len(rising_waves(GENERAL, 0.0, (RAMP, RAMP), 0.1).waves) == 4
