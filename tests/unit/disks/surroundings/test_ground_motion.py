"""The motion of the ground at heights beside a column of disks."""

import numpy as np

from dembound.disks.surroundings.ground_waves import GroundMotion


def test_disks_of_a_band_count_by_their_mass_at_its_centre_of_mass() -> None:
    """Then a uniform strain is exact between the first and the last band, for any disks."""
    rng = np.random.default_rng(4)
    up, mass = rng.uniform(0.0, 8.0, 60), rng.uniform(1.0, 2.0, 60)
    heights = np.linspace(1.0, 7.0, 23)
    values = np.column_stack([3.0 * up - 1.0, 2.0 - 5.0 * up, up])
    found = GroundMotion(up, mass, 1.0, heights).at_heights(values)
    np.testing.assert_allclose(found[:, :2], np.column_stack([3.0 * heights - 1.0, 2.0 - 5.0 * heights]), atol=1e-12)
