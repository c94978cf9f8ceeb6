"""The picture of the reflection by a side."""

import numpy as np

from dembound.plot.reflection import LEAST, Curves, plot_reflection

ANGLES, FREQUENCIES = np.array([0.0, 30.0, 60.0]), np.array([1.0, 3.0])


def curves(name: str) -> Curves:
    same = np.array([[0.0, 0.1, 0.2], [0.2, np.nan, 0.4]])
    return Curves(name, same, 0.5 * same, {"in all, calibrated": 0.1 * same})


def test_means_and_their_range_are_drawn_against_angle_and_single_angles_against_frequency() -> None:
    figure = plot_reflection(ANGLES, FREQUENCIES, [curves("P"), curves("S")], "title")
    of_p, _, below_p, _ = figure.axes
    lines = {line.get_label(): line for line in of_p.get_lines()}
    np.testing.assert_array_equal(lines["in all"].get_xdata(), ANGLES)
    np.testing.assert_allclose(lines["in all"].get_ydata(), [0.15, 0.15, 0.45])
    np.testing.assert_allclose(lines["as the other type"].get_ydata(), [0.05, 0.05, 0.15])
    np.testing.assert_allclose(lines["in all, calibrated"].get_ydata(), [0.01, 0.01, 0.03])
    (band,) = of_p.collections
    low, high = (path(band.get_paths()[0].vertices[:, 1]) for path in (np.min, np.max))
    np.testing.assert_allclose([low, high], [LEAST, 0.6])
    below = {line.get_label(): line.get_ydata() for line in below_p.get_lines()}
    np.testing.assert_allclose(below["in all at 60°"], [0.3, 0.6])
    np.testing.assert_allclose(below["in all at 0°"], [LEAST, 0.3])
