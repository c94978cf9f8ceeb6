"""Monitors show their histories."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.histories import plot_histories


@pytest.mark.parametrize(
    ("component", "quantity", "column", "label"),
    [
        (None, "velocity", 0, "velocity along x (m/s)"),  # the push, 0.5 m/s, is larger than the shake, 0.2 m/s
        ("y", "velocity", 1, "velocity along y (m/s)"),
        ("rotation", "displacement", 2, "displacement of rotation (rad)"),
    ],
)
def test_each_monitor_has_a_panel_with_its_history(small_run, component, quantity, column, label):
    figure = plot_histories([small_run], component, quantity)
    assert figure.get_supylabel() == label
    assert figure.axes[-1].get_xlabel() == "time (s)"
    with h5py.File(small_run) as file:
        for panel, (name, group) in zip(figure.axes, file["histories"].items(), strict=True):
            assert panel.get_title("left") == name + " at ({:g}, {:g}) m".format(*group.attrs["wanted"])
            (line,) = panel.lines
            np.testing.assert_array_equal(line.get_xdata(), group["time"][:])
            np.testing.assert_array_equal(line.get_ydata(), group[quantity][:, column])


def test_runs_lie_over_each_other_in_different_styles(small_run, other_run):
    figure = plot_histories([small_run, other_run])
    for panel in figure.axes:
        small, other = panel.lines
        assert len(small.get_xdata()) > len(other.get_xdata())
        assert small.get_color() != other.get_color()
        assert small.get_linestyle() != other.get_linestyle()
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["small", "other"]


def test_without_monitors_there_is_nothing_to_show(tmp_path):
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file.attrs["name"] = "empty"
    with pytest.raises(CaseError, match="no monitors"):
        plot_histories([path])
