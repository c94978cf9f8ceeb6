"""Sides show the diameters and peaks of their record."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.side import plot_boundary


@pytest.mark.parametrize(("side", "axis", "along"), [("left", 1, "y"), ("top", 0, "x")])
def test_diameters_and_peaks_stand_along_the_side(small_run, side, axis, along):
    upper, lower = plot_boundary([small_run], side).axes
    (diameters,), (peaks,) = upper.lines, lower.lines
    with h5py.File(small_run) as file:
        group = file[f"boundaries/{side}"]
        np.testing.assert_array_equal(diameters.get_xdata(), group["position"][:, axis])
        np.testing.assert_array_equal(diameters.get_ydata(), group["diameter"][:])
        largest = np.maximum(-group["peak_velocity"][:, 0, 0], group["peak_velocity"][:, 0, 1])
        np.testing.assert_array_equal(peaks.get_xdata(), group["position"][:, axis])
        np.testing.assert_array_equal(peaks.get_ydata(), largest)
    assert upper.get_ylabel() == "particle diameter (m)"
    assert lower.get_ylabel() == "peak |velocity| along x (m/s)"
    assert lower.get_xlabel() == f"{along}, along the side (m)"


def test_particles_stand_in_their_order_and_those_of_a_column_apart(small_run, run, copied):
    with copied(small_run) as file:
        file.attrs["column"] = 10
        group = file["boundaries/bottom"]
        for name in ("particle", "position", "diameter", "peak_velocity"):
            group[name][:] = group[name][:][::-1]
        positions, column = group["position"][:, 0][::-1], group["particle"][:][::-1] < 10
    assert 0 < np.count_nonzero(column) < len(column)
    figure = plot_boundary([run], "bottom")
    for panel in figure.axes:
        body, apart = panel.lines
        np.testing.assert_array_equal(body.get_xdata(), positions[~column])
        np.testing.assert_array_equal(apart.get_xdata(), positions[column])
        assert (apart.get_linestyle(), apart.get_markerfacecolor()) == ("None", "white")
    assert [text.get_text().split(":")[0] for text in figure.legends[0].get_texts()] == [
        "small",
        "small, free-field column",
    ]


def test_the_legend_counts_and_averages_each_run(small_run, other_run):
    figure = plot_boundary([small_run, other_run], "left")
    small, other = (text.get_text() for text in figure.legends[0].get_texts())
    # the driven side has moved as the wave did, up to its crest at half a period
    assert small == "small: 5 particles, mean 0.5 m/s, standard deviation 0.00 %"
    assert other.startswith("other: 5 particles")
    assert figure.axes[0].get_ylim() == pytest.approx((0.45, 0.55))  # a uniform side looks uniform


def test_what_is_no_side_is_refused(small_run, spalled_run):
    with pytest.raises(CaseError, match="no particles of side outer, sides there: bottom, left, right, top"):
        plot_boundary([small_run], "outer")
    with pytest.raises(CaseError, match="is a bar, each end of which is one node"):
        plot_boundary([spalled_run], "left")
