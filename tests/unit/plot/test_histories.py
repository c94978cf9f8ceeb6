"""Monitors show their histories."""

import h5py
import numpy as np
import pytest

from dembound.errors import CaseError
from dembound.plot.histories import plot_histories


def names(figure):
    """Names of the monitors of a figure's panels."""
    return [panel.get_title("left").split()[0] for panel in figure.axes]


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
    assert (figure.get_supylabel(), figure.axes[-1].get_xlabel()) == (label, "time (ms)")
    assert names(figure) == ["front", "back"]
    with h5py.File(small_run) as file:
        for panel, (name, group) in zip(figure.axes, file["histories"].items(), strict=True):
            places = ("({:.2f}, {:.2f}) m".format(*group.attrs[key]) for key in ("position", "requested"))
            assert panel.get_title("left") == "{} at {}, requested {}".format(name, *places)
            (line,) = panel.lines
            np.testing.assert_array_equal(line.get_xdata(), group["time"][:] / 1e-3)
            np.testing.assert_array_equal(line.get_ydata(), group[quantity][:, column])


def test_runs_lie_over_each_other_and_tell_seconds_if_one_is_long(small_run, other_run, run, copied):
    with copied(other_run) as file:
        file["histories/front/time"][-1] = 0.2
        last = file["histories/back/time"][-1]
    figure = plot_histories([small_run, run])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["small", "other"]
    front, back = figure.axes
    small, other = front.lines
    assert len(small.get_xdata()) > len(other.get_xdata())
    assert small.get_color() != other.get_color()
    assert small.get_linestyle() != other.get_linestyle()
    assert back.get_xlabel() == "time (s)"
    assert front.lines[1].get_xdata()[-1] == 0.2
    assert back.lines[1].get_xdata()[-1] == last


def test_places_that_differ_stand_in_the_title_and_many_are_counted(small_run, tmp_path):
    runs = [tmp_path / name for name in "abc"]
    for number, run in enumerate(runs):
        run.write_bytes(small_run.read_bytes())
        with h5py.File(run, "r+") as file:
            file["histories/front"].attrs["position"] = (2.0 + number, 1.2)
            if number == 1:
                file["histories/front"].attrs["requested"] = (2.5, 1.2)
                file["histories/back"].attrs["position"] = (9.6, 1.2)
    front, back = (panel.get_title("left") for panel in plot_histories(runs[:2]).axes)
    assert front == "front at (2.00, 1.20) m and (3.00, 1.20) m, requested (2.40, 1.20) m and (2.50, 1.20) m"
    assert back == "back at (9.75, 1.25) m and (9.60, 1.20) m, requested (9.60, 1.20) m"
    runs[1].write_bytes(runs[0].read_bytes())
    with h5py.File(runs[1], "r+") as file:
        file["histories/front"].attrs["position"] = (3.0, 1.2)
    front, _ = (panel.get_title("left") for panel in plot_histories(runs).axes)
    assert front == "front at (2.00, 1.20) m and 2 other places, requested (2.40, 1.20) m"


def test_twins_are_dashed_in_the_panel_of_their_monitor_or_alone(small_run, other_run, run, copied):
    with copied(small_run) as file:
        file.copy("histories/front", file["histories"], "front.free_field")
        file["histories/front.free_field/velocity"][:] *= 0.5
    figure = plot_histories([run])
    front, back = figure.axes
    own, twin = front.lines
    assert (own.get_linestyle(), twin.get_linestyle()) == ("-", "--")
    assert own.get_color() == twin.get_color()
    assert twin.get_linewidth() > own.get_linewidth()  # and below it, so that it is seen where they are equal
    assert twin.get_zorder() < own.get_zorder()
    np.testing.assert_array_equal(twin.get_ydata(), 0.5 * own.get_ydata())
    assert len(back.lines) == 1
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["small", "small, free field"]
    # no run is dashed beside twins
    front = plot_histories([run, other_run]).axes[0]
    assert [line.get_linestyle() for line in front.lines] == ["-", "--", "-."]
    (panel,) = plot_histories([run], monitors=["front.free_field"]).axes
    assert panel.get_title("left").startswith("front.free_field at ")
    assert len(panel.lines) == 1


def test_both_components_stand_side_by_side(small_run):
    figure = plot_histories([small_run], "both")
    assert figure.get_supylabel() == "velocity (m/s)"
    assert [panel.get_ylabel() for panel in figure.axes] == ["along x", "along y"] * 2
    with h5py.File(small_run) as file:
        for number, panel in enumerate(figure.axes):
            name = ("front", "back")[number // 2]
            np.testing.assert_array_equal(panel.lines[0].get_ydata(), file[f"histories/{name}/velocity"][:, number % 2])


def test_only_the_monitors_asked_for_are_shown_in_that_order_in_the_component_that_is_theirs(
    small_run, other_run, run, copied
):
    for asked in (["back"], ["back", "front"], ["front", "front"]):
        figure = plot_histories([small_run, other_run], monitors=asked)
        assert names(figure) == list(dict.fromkeys(asked))
        assert [len(panel.lines) for panel in figure.axes] == [2] * len(figure.axes)
    with copied(small_run) as file:
        file["histories/back/velocity"][0, 1] = 9.0
    assert plot_histories([run]).get_supylabel() == "velocity along y (m/s)"
    assert plot_histories([run], monitors=["front"]).get_supylabel() == "velocity along x (m/s)"


def test_gauges_of_bars_show_their_stress_and_their_place_along_the_bar(spalled_run):
    figure = plot_histories([spalled_run], quantity="stress")
    assert figure.get_supylabel() == "stress along x, tension positive (MPa)"
    (panel,) = figure.axes
    assert panel.get_title("left") == "gauge at 0.525 m"
    with h5py.File(spalled_run) as file:
        np.testing.assert_array_equal(panel.lines[0].get_ydata(), file["histories/gauge/stress"][:] / 1e6)
    assert plot_histories([spalled_run]).get_supylabel() == "velocity along x (m/s)"


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
