"""Lattices are drawn with their frequencies and speeds, beside what was simulated."""

import numpy as np

from dembound.exact import Lattice
from dembound.plot.dispersion import CELLS, WIDENED, WIDTH, line_widths, name, plot_dispersion

COARSE = Lattice(3, spacing=0.01, time_step=1e-6, wave_speed=2500.0)
FINE = Lattice(1, spacing=0.005, time_step=0.0, wave_speed=2500.0)
UNSTABLE = Lattice(1, spacing=0.005, time_step=3e-6, wave_speed=2500.0)


def test_lines_are_the_lattices_own():
    figure = plot_dispersion([COARSE, FINE])
    left, middle, right = figure.axes
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
        assert panel.get_xlabel() == "spacings per wavelength (–)"
    assert left.get_xlabel() == "wave number k (rad/m)"
    assert left.get_ylabel() == "frequency ω/2π (kHz)"
    texts = [text.get_text() for text in figure.legends[0].get_texts()]
    assert texts == [name(COARSE), name(FINE), "no dispersion, c = 2500 m/s"]


def test_simulated_points_stand_at_their_frequencies_and_phase_velocities():
    wavenumber = np.array([100.0, 200.0])
    figure = plot_dispersion([COARSE, FINE], [(wavenumber, 2400.0 * wavenumber), (np.zeros(0), np.zeros(0))])
    left, middle, _ = figure.axes
    points = next(line for line in left.lines if line.get_label() == "simulated")
    assert points.get_linestyle() == "None"
    assert points.get_color() == left.lines[0].get_color()
    np.testing.assert_array_equal(points.get_xdata(), wavenumber)
    np.testing.assert_allclose(points.get_ydata(), 2.4 * wavenumber / (2.0 * np.pi), rtol=1e-14)
    speeds = next(line for line in middle.lines if line.get_linestyle() == "None")
    np.testing.assert_allclose(speeds.get_xdata(), 2.0 * np.pi / (0.01 * wavenumber), rtol=1e-14)
    np.testing.assert_allclose(speeds.get_ydata(), 0.96, rtol=1e-14)


def test_lattices_are_distinguished_in_words_and_below_each_other():
    assert name(COARSE) == "horizon 3, Δx = 10 mm, Δt = 1 µs"
    assert name(UNSTABLE) == "horizon 1, Δx = 5 mm, Δt = 3 µs, unstable"
    assert name(Lattice(2, 0.01, 0.0, 2500.0, (0.25, 0.75))) == "horizon 2 (0.25/0.75), Δx = 10 mm, exact in time"
    finer = Lattice(3, spacing=0.005, time_step=1e-6, wave_speed=2500.0)
    assert line_widths([COARSE, FINE, finer]) == [WIDTH + WIDENED, WIDTH, WIDTH]
