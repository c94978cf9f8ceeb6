"""Windows and means over disks."""

import numpy as np

from dembound.plot.disks import Window, mean_on_grid


def test_a_window_just_holds_disks_and_is_touched_by_what_reaches_into_it():
    window = Window.around(np.array([[1.0, 2.0], [4.0, 3.0]]), np.array([0.5, 1.0]))
    assert window.extent == (0.5, 5.0, 1.5, 4.0)
    window = Window(np.zeros(2), np.array([2.0, 1.0]))
    positions = np.array([[1.0, 0.5], [2.4, 0.5], [2.5, 0.5], [2.4, 1.4]])
    # inside; across a face; only up to it; near the corner, 0.57 m away
    np.testing.assert_array_equal(window.touches(positions, np.full(4, 0.5)), [True, True, False, False])


def test_means_are_taken_cell_by_cell_and_empty_cells_stay_empty():
    positions = np.array([[0.2, 0.2], [0.4, 0.4], [1.5, 0.5], [0.5, 1.5]])
    means = mean_on_grid(positions, np.array([1.0, 3.0, 5.0, 7.0]), Window(np.zeros(2), np.full(2, 2.0)), 0.9)
    np.testing.assert_array_equal(means, [[2.0, 5.0], [7.0, np.nan]])
