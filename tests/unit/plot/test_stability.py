"""Energies of noise against steps."""

import numpy as np

from dembound.plot.stability import LEAST, Line, plot_stability


def test_energies_stand_against_steps_on_a_log_axis() -> None:
    short = [Line("below", 0, [0, 10, 20], [1.0, 0.5, 0.6], dashed=True), Line("above", 0, [0, 10], [1.0, np.inf])]
    long = [Line("own", 0, [0, 1000], [1.0, -1.0])]
    figure = plot_stability(short, long, "noise")
    left, right = figure.axes

    assert [line.get_label() for line in left.lines[:2]] == ["below", "above"]
    np.testing.assert_array_equal(left.lines[0].get_ydata(), [1.0, 0.5, 0.6])
    assert left.lines[0].get_linestyle() == "--"
    assert left.lines[0].get_color() == left.lines[1].get_color()
    np.testing.assert_array_equal(right.lines[0].get_ydata(), [1.0, LEAST])
    assert (left.get_yscale(), right.get_yscale()) == ("log", "log")
    assert {panel.get_xlabel() for panel in figure.axes} == {"steps"}
    assert all("(–)" in panel.get_ylabel() for panel in figure.axes)
