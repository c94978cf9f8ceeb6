"""The motion of the ground at heights beside a column of disks."""

import numpy as np

from dembound.disks.surroundings.ground_waves import GroundMotion


def test_rows_of_a_lattice_are_joined_by_straight_lines() -> None:
    up = np.repeat([0.5, 1.5, 2.5], 2)
    values = np.column_stack([np.repeat([1.0, 3.0, 2.0], 2), np.repeat([-4.0, 0.0, 8.0], 2), np.ones(6)])
    found = GroundMotion(up, np.ones(6), 1.0, np.array([0.0, 0.5, 1.0, 2.25, 3.0])).at_heights(values)
    np.testing.assert_allclose(found[:, 0], [1.0, 1.0, 2.0, 2.25, 2.0], rtol=1e-14)
    np.testing.assert_allclose(found[:, 1], [-4.0, -4.0, -2.0, 6.0, 8.0], rtol=1e-14)
    np.testing.assert_array_equal(found[:, 2], 0.0)


def test_disks_of_a_band_count_by_their_mass_at_its_centre_of_mass() -> None:
    """Then a uniform strain is exact between the first and the last band, for any disks."""
    rng = np.random.default_rng(4)
    up, mass = rng.uniform(0.0, 8.0, 60), rng.uniform(1.0, 2.0, 60)
    heights = np.linspace(1.0, 7.0, 23)
    values = np.column_stack([3.0 * up - 1.0, 2.0 - 5.0 * up, up])
    found = GroundMotion(up, mass, 1.0, heights).at_heights(values)
    np.testing.assert_allclose(found[:, :2], np.column_stack([3.0 * heights - 1.0, 2.0 - 5.0 * heights]), atol=1e-12)
