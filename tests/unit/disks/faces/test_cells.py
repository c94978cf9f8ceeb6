"""The intervals into which disks cut a line: those of the power diagram, once each, limited where nothing is near."""

import numpy as np

from dembound.disks.faces.cells import intervals


def test_equal_disks_in_a_row_have_a_diameter_each():
    low, high = intervals(np.arange(5.0), np.full(5, 0.5), np.full(5, 0.5))
    np.testing.assert_allclose(low, np.arange(5.0) - 0.5)
    np.testing.assert_allclose(high, np.arange(5.0) + 0.5)


def test_every_point_belongs_to_the_disk_of_the_smallest_power():
    rng = np.random.default_rng(1)
    along, height, radius = np.sort(rng.uniform(0, 20, 60)), rng.uniform(0.0, 0.6, 60), rng.uniform(0.3, 0.7, 60)
    low, high = intervals(along, height, radius)
    places = np.linspace(1.0, 19.0, 2001)
    nearest = np.argmin((places[:, None] - along) ** 2 + height**2 - radius**2, axis=1)
    inside = (places[:, None] > low) & (places[:, None] < high)  # nan: none
    assert (inside.sum(axis=1) == 1).mean() > 0.995  # others lie on a border
    assert (inside[np.arange(len(places)), nearest]).mean() > 0.995


def test_a_larger_disk_has_more_and_one_behind_others_none():
    low, high = intervals(np.array([0.0, 1.0, 0.5]), np.array([0.5, 0.5, 3.0]), np.array([0.6, 0.4, 0.5]))
    np.testing.assert_allclose([high[0], low[1]], 0.5 + 0.5 * (0.6**2 - 0.4**2))
    assert np.isnan([low[2], high[2]]).all()


def test_a_disk_alone_has_its_diameter():
    low, high = intervals(np.array([0.0, 50.0]), np.zeros(2), np.array([0.5, 2.0]))
    np.testing.assert_allclose([low, high], [[-0.5, 48.0], [0.5, 52.0]])
