"""Histories of monitors, and record sections."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.histories import plot_histories, plot_section


def names(figure):
    """Names of the monitors of a figure's panels."""
    return [panel.get_title("left").split()[0] for panel in figure.axes]


@pytest.mark.parametrize(
    ("component", "quantity", "column", "label"),
    [
        (None, "velocity", 0, "velocity along x (m/s)"),  # the push, 0.5 m/s, is larger than the shake, 0.2 m/s
        ("rotation", "displacement", 2, "displacement of rotation (rad)"),
    ],
)
def test_each_monitor_has_a_panel_with_its_history(small_run, component, quantity, column, label):
    figure = plot_histories([small_run], component, quantity)
    assert (figure.get_supylabel(), figure.axes[-1].get_xlabel()) == (label, "time (ms)")
    assert names(figure) == ["front", "back"]
    with h5py.File(small_run) as file:
        for panel, group in zip(figure.axes, file["histories"].values(), strict=True):
            (line,) = panel.lines
            np.testing.assert_array_equal(line.get_xdata(), group["time"][:] / 1e-3)
            np.testing.assert_array_equal(line.get_ydata(), group[quantity][:, column])


def test_twins_are_dashed_in_the_panel_of_their_monitor_or_alone(small_run, other_run, run, copied):
    with copied(small_run) as file:
        file.copy("histories/front", file["histories"], "front.free_field")
        file["histories/front.free_field/velocity"][:] *= 0.5
    figure = plot_histories([run])
    front, back = figure.axes
    own, twin = front.lines
    np.testing.assert_array_equal(twin.get_ydata(), 0.5 * own.get_ydata())
    assert len(back.lines) == 1
    (panel,) = plot_histories([run], monitors=["front.free_field"]).axes
    assert len(panel.lines) == 1


def test_gauges_of_bars_show_their_stress_and_their_place_along_the_bar(spalled_run):
    figure = plot_histories([spalled_run], quantity="stress")
    assert figure.get_supylabel() == "stress along x, tension positive (MPa)"
    (panel,) = figure.axes
    with h5py.File(spalled_run) as file:
        np.testing.assert_array_equal(panel.lines[0].get_ydata(), file["histories/gauge/stress"][:] / 1e6)


def test_what_runs_do_not_have_is_refused(spalled_run, small_run, run):
    with h5py.File(run, "w") as file:
        file.attrs["name"] = "empty"
    for runs, options, said in (
        ([spalled_run], {"component": "y", "quantity": "stress"}, "component: is of motions"),
        ([spalled_run, small_run], {"quantity": "stress"}, f"{small_run}: has no stress of its monitors; only runs of"),
        ([small_run], {"monitors": ["P9", "front", "P8"]}, "P9, must be one of front, back\n.*P8"),
        ([run], {}, "no monitors"),
    ):
        with pytest.raises(CaseError, match=said):
            plot_histories(runs, **options)


@pytest.mark.parametrize(("component", "column", "wide", "less"), [("x", 0, 0.25, 0.125), ("y", 1, 0.5, 0.0625)])
def test_the_band_of_an_estimate_lies_around_its_line(small_run, run, copied, component, column, wide, less):
    """Up to the half of the time for one of the monitors, at every second time, and for velocities alone."""
    with copied(small_run) as record, h5py.File(run.with_name("estimate.h5"), "w") as file:
        group = record["histories/front"]
        sampled = slice(0, len(group["time"]) // 2, 2)
        times, values = group["time"][sampled], group["velocity"][sampled, column]
        file["histories/front/time"] = times
        file["histories/front/velocity/band"] = np.tile([0.25, 0.5], (len(times), 1))
        file["histories/front/velocity/corrected"] = group["velocity"][sampled, :2] - [0.125, 0.0625]
    front, back = plot_histories([run], component).axes
    (band,) = front.collections
    x, y = band.get_paths()[0].vertices.T
    assert x.max() == pytest.approx(times[-1] / 1e-3)
    assert (y.min(), y.max()) == (pytest.approx(values.min() - wide), pytest.approx(values.max() + wide))
    np.testing.assert_allclose(front.lines[1].get_xdata(), times / 1e-3)
    np.testing.assert_allclose(front.lines[1].get_ydata(), values - less)
    assert (len(back.collections), len(back.lines)) == (0, 1)
    assert all(not panel.collections for panel in plot_histories([run], quantity="displacement").axes)


def test_a_section_has_each_history_at_its_distance(small_run):
    (panel,) = plot_section([small_run], monitors=["back", "front"]).axes
    with h5py.File(small_run) as file:
        groups = [file["histories/back"], file["histories/front"]]
        distance = np.hypot(*(groups[1].attrs["position"] - groups[0].attrs["position"]))
        largest = max(np.abs(group["velocity"][:, 0]).max() for group in groups)
        for line, group, begin in zip(panel.lines, groups, (0.0, distance), strict=True):
            # the largest value is as high as 0.9 of the mean distance between neighbours
            expected = begin + 0.9 * distance / largest * group["velocity"][:, 0]
            np.testing.assert_allclose(line.get_ydata(), expected)
            np.testing.assert_allclose(line.get_xdata(), group["time"][:] / 1e-3)
    assert panel.get_title("left") == f"{distance:.3g} m upwards is {largest / 0.9:.3g} m/s"
