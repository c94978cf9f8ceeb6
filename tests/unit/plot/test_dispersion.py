"""Lattices are drawn with their frequencies and speeds, beside what was simulated."""

import numpy as np

from dembound.exact import Lattice
from dembound.plot.dispersion import CELLS, plot_dispersion

COARSE = Lattice(3, spacing=0.01, time_step=1e-6, wave_speed=2500.0)
FINE = Lattice(1, spacing=0.005, time_step=0.0, wave_speed=2500.0)


def test_lines_are_the_lattices_own():
    left, middle, right = plot_dispersion([COARSE, FINE]).axes
    coarse, fine, exact = left.lines
    for line, lattice in ((coarse, COARSE), (fine, FINE)):
        wavenumber = np.asarray(line.get_xdata())
        assert wavenumber[-1] == lattice.shortest
        np.testing.assert_allclose(line.get_ydata(), lattice.frequency(wavenumber) / (2000.0 * np.pi), rtol=1e-14)
    np.testing.assert_allclose(exact.get_ydata(), [0.0, 2.5 * FINE.shortest / (2.0 * np.pi)], rtol=1e-14)
    for panel, speed in ((middle, COARSE.phase_velocity), (right, COARSE.group_velocity)):
        np.testing.assert_array_equal(panel.lines[0].get_xdata(), CELLS)
        np.testing.assert_allclose(
            panel.lines[0].get_ydata(), speed(2.0 * np.pi / (0.01 * CELLS)) / 2500.0, rtol=1e-12, atol=1e-12
        )
