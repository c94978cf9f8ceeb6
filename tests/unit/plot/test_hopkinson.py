"""Waves, forces, rates and the stress–strain curve of a split Hopkinson test are drawn in µε, MPa and per cent."""

import numpy as np
from hopkinson_bar import SETUP, signals

from dembound.gauge.hopkinson import at_faces, specimen
from dembound.plot.hopkinson import plot_hopkinson


def test_all_histories_are_drawn():
    faces = at_faces(signals(), SETUP)
    found = specimen(faces, SETUP)
    figure = plot_hopkinson(faces, found)
    waves, forces, rates, curve = figure.axes
    for line, values in zip(waves.lines, faces[1:4], strict=True):
        np.testing.assert_allclose(line.get_ydata(), 1e6 * values)
    for line, values in zip(forces.lines, (found.front, found.back), strict=True):
        np.testing.assert_allclose(line.get_ydata(), 1e-6 * values)
    np.testing.assert_allclose(rates.lines[0].get_xdata(), 1e6 * found.time)
    np.testing.assert_allclose(rates.lines[0].get_ydata(), found.rate)
    np.testing.assert_allclose(curve.lines[0].get_data(), [100.0 * found.strain, 1e-6 * found.stress])
    assert np.array_equal(np.isfinite(curve.lines[1].get_xdata()), found.in_equilibrium)
    assert curve.get_xlabel() == "strain (%)"
