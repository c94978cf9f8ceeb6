"""The motion of the undisturbed ground: near ties, in the packing, and beside a column of disks."""

import numpy as np
from ground_motions import RAMP, ground, sine

from dembound.disks.surroundings.ground_waves import GroundMotion


def test_near_places_the_motion_is_that_of_the_waves() -> None:
    """Places within 8 m, half of the shortest wave: 1e-5 by the estimate of `DELAYS`; correctors as by differences."""
    waves = ground(sine(40.0), 1e-3)
    rng = np.random.default_rng(1)
    places, corrector = rng.uniform(0.0, 8.0, (20, 2)) * [1.0, 0.1], rng.normal(size=(3, 4, 20))
    near, times = waves.near(places), np.array([0.31, 0.35, 0.4])
    exact = waves.motion("displacement", times, places, corrector)
    found = np.einsum("tq,cdq->tdc", near.amplitudes(times, 0.0), near.motion(places, corrector))

    np.testing.assert_allclose(found, exact, atol=2e-4 * np.abs(exact).max())
    moving = waves.motion("velocity", times, places)
    behind = near.amplitudes(times + 1e-4, 1e-4) @ near.velocities(1e-4).T
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


def test_disks_of_a_band_count_by_their_mass_at_its_centre_of_mass() -> None:
    """Then a uniform strain is exact between the first and the last band, for any disks."""
    rng = np.random.default_rng(4)
    up, mass = rng.uniform(0.0, 8.0, 60), rng.uniform(1.0, 2.0, 60)
    heights = np.linspace(1.0, 7.0, 23)
    values = np.column_stack([3.0 * up - 1.0, 2.0 - 5.0 * up, up])
    found = GroundMotion(up, mass, 1.0, heights).at_heights(values)
    np.testing.assert_allclose(found[:, :2], np.column_stack([3.0 * heights - 1.0, 2.0 - 5.0 * heights]), atol=1e-12)
