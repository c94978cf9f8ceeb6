"""Monitors show their histories."""

import h5py
import numpy as np
import pytest
from typer.testing import CliRunner

from dembound import cli
from dembound.errors import CaseError
from dembound.plot import histories
from dembound.plot.histories import plot_histories
from dembound.plot.style import new_figure


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
    assert figure.axes[-1].get_xlabel() == "time (ms)"
    with h5py.File(small_run) as file:
        for panel, (name, group) in zip(figure.axes, file["histories"].items(), strict=True):
            places = ("({:.2f}, {:.2f}) m".format(*group.attrs[key]) for key in ("position", "wanted"))
            assert panel.get_title("left") == "{} at {}, wanted {}".format(name, *places)
            (line,) = panel.lines
            np.testing.assert_array_equal(line.get_xdata(), group["time"][:] / 1e-3)
            np.testing.assert_array_equal(line.get_ydata(), group[quantity][:, column])


def test_runs_that_are_not_all_short_tell_seconds(small_run, other_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(other_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file["histories/front/time"][-1] = 0.2
        last = file["histories/back/time"][-1]
    front, back = plot_histories([small_run, run]).axes
    assert back.get_xlabel() == "time (s)"
    assert front.lines[1].get_xdata()[-1] == 0.2
    assert back.lines[1].get_xdata()[-1] == last


def test_runs_lie_over_each_other_in_different_styles(small_run, other_run):
    figure = plot_histories([small_run, other_run])
    for panel in figure.axes:
        small, other = panel.lines
        assert len(small.get_xdata()) > len(other.get_xdata())
        assert small.get_color() != other.get_color()
        assert small.get_linestyle() != other.get_linestyle()
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["small", "other"]


def test_places_that_differ_stand_in_the_title(small_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file.attrs["name"] = "elsewhere"
        file["histories/front"].attrs.update({"wanted": (2.5, 1.2), "position": (2.5, 1.2)})
        file["histories/back"].attrs["position"] = (9.6, 1.2)
        (x, y) = file["histories/back"].attrs["position"]
    front, back = plot_histories([small_run, run]).axes
    with h5py.File(small_run) as file:
        own = {name: "({:.2f}, {:.2f}) m".format(*group.attrs["position"]) for name, group in file["histories"].items()}
    assert (
        front.get_title("left")
        == f"front at {own['front']} and (2.50, 1.20) m, wanted (2.40, 1.20) m and (2.50, 1.20) m"
    )
    assert back.get_title("left") == f"back at {own['back']} and ({x:.2f}, {y:.2f}) m, wanted (9.60, 1.20) m"


def test_many_places_are_counted(small_run, tmp_path):
    runs = [tmp_path / name for name in "abc"]
    for number, run in enumerate(runs):
        run.write_bytes(small_run.read_bytes())
        with h5py.File(run, "r+") as file:
            file["histories/front"].attrs["position"] = (2.0 + number, 1.2)
    front, _ = plot_histories(runs).axes
    assert front.get_title("left") == "front at (2.00, 1.20) m and 2 other places, wanted (2.40, 1.20) m"


@pytest.fixture
def twin_run(small_run, tmp_path):
    """A copy of the run with a twin of its monitor ``front``."""
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file.copy("histories/front", file["histories"], "front.free_field")
        file["histories/front.free_field/velocity"][:] *= 0.5
    return run


def test_twins_are_dashed_in_the_panel_of_their_monitor(twin_run):
    figure = plot_histories([twin_run])
    front, back = figure.axes
    own, twin = front.lines
    assert (own.get_linestyle(), twin.get_linestyle()) == ("-", "--")
    assert own.get_color() == twin.get_color()
    assert twin.get_linewidth() > own.get_linewidth()  # and below it, so that it is seen where they are equal
    assert twin.get_zorder() < own.get_zorder()
    np.testing.assert_array_equal(twin.get_ydata(), 0.5 * own.get_ydata())
    assert len(back.lines) == 1
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["small", "small, free field"]


def test_no_run_is_dashed_beside_twins(twin_run, other_run):
    front = plot_histories([twin_run, other_run]).axes[0]
    assert [line.get_linestyle() for line in front.lines] == ["-", "--", "-."]


def test_a_twin_may_be_shown_alone(twin_run):
    (panel,) = plot_histories([twin_run], monitors=["front.free_field"]).axes
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


def test_accelerations_have_their_units(small_run):
    assert plot_histories([small_run], quantity="acceleration").get_supylabel() == "acceleration along x (m/s²)"
    assert (
        plot_histories([small_run], "rotation", "acceleration").get_supylabel() == "acceleration of rotation (rad/s²)"
    )


def test_a_stress_has_no_component(spalled_run):
    with pytest.raises(CaseError, match="component: is of motions"):
        plot_histories([spalled_run], "y", "stress")


def test_monitors_stand_in_the_order_of_the_case(small_run):
    names = [panel.get_title("left").split()[0] for panel in plot_histories([small_run]).axes]
    assert names == ["front", "back"]


def test_only_the_monitors_asked_for_are_shown_in_that_order(small_run, other_run):
    for asked in (["back"], ["back", "front"], ["front", "front"]):
        figure = plot_histories([small_run, other_run], monitors=asked)
        assert [panel.get_title("left").split()[0] for panel in figure.axes] == list(dict.fromkeys(asked))
        assert [len(panel.lines) for panel in figure.axes] == [2] * len(figure.axes)


def test_the_component_is_that_of_the_monitors_shown(small_run, tmp_path):
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run, "r+") as file:
        file["histories/back/velocity"][0, 1] = 9.0
    assert plot_histories([run]).get_supylabel() == "velocity along y (m/s)"
    assert plot_histories([run], monitors=["front"]).get_supylabel() == "velocity along x (m/s)"


def test_unknown_monitors_are_refused_with_those_there(small_run):
    with pytest.raises(CaseError, match="is P9, must be one of front, back") as refused:
        plot_histories([small_run], monitors=["P9", "front", "P8"])
    assert len(refused.value.problems) == 2


def test_the_command_hands_on_the_monitors(small_run, tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr(
        histories, "plot_histories", lambda runs, **options: asked.append(options) or new_figure(1.0, 1.0)
    )
    for options in ([], ["--monitor", "back", "--monitor", "front"]):
        command = ["plot", str(small_run), "-o", str(tmp_path / "plot.png"), *options]
        assert CliRunner().invoke(cli.app, command).exit_code == 0
    assert [options["monitors"] for options in asked] == [None, ["back", "front"]]


def test_gauges_of_bars_show_their_stress_and_their_place_along_the_bar(spalled_run):
    figure = plot_histories([spalled_run], quantity="stress")
    assert figure.get_supylabel() == "stress along x, tension positive (MPa)"
    (panel,) = figure.axes
    assert panel.get_title("left") == "gauge at 0.525 m"
    with h5py.File(spalled_run) as file:
        np.testing.assert_array_equal(panel.lines[0].get_ydata(), file["histories/gauge/stress"][:] / 1e6)
    assert plot_histories([spalled_run]).get_supylabel() == "velocity along x (m/s)"


def test_stress_that_is_not_there_is_refused(spalled_run, small_run):
    with pytest.raises(CaseError, match=f"{small_run}: has no stress of its monitors; only runs of bars have it"):
        plot_histories([spalled_run, small_run], quantity="stress")


def test_without_monitors_there_is_nothing_to_show(tmp_path):
    path = tmp_path / "run.h5"
    with h5py.File(path, "w") as file:
        file.attrs["name"] = "empty"
    with pytest.raises(CaseError, match="no monitors"):
        plot_histories([path])


@pytest.fixture
def estimated(small_run, tmp_path):
    """A run with an estimate for one of its monitors, up to the half of its time."""
    run = tmp_path / "run.h5"
    run.write_bytes(small_run.read_bytes())
    with h5py.File(run) as record, h5py.File(tmp_path / "estimate.h5", "w") as file:
        group = record["histories/front"]
        half = len(group["time"]) // 2
        file["histories/front/time"] = group["time"][:half]
        file["histories/front/velocity/band"] = np.tile([0.25, 0.5], (half, 1))
        file["histories/front/velocity/corrected"] = group["velocity"][:half, :2] - [0.125, 0.0625]
    return run


@pytest.mark.parametrize(("component", "column", "wide", "less"), [("x", 0, 0.25, 0.125), ("y", 1, 0.5, 0.0625)])
def test_the_band_of_a_component_lies_around_its_line(estimated, component, column, wide, less):
    front, back = plot_histories([estimated], component).axes
    with h5py.File(estimated) as record:
        values = record["histories/front/velocity"][:, column]
    half = len(values) // 2
    (band,) = front.collections
    x, y = band.get_paths()[0].vertices.T
    assert x.max() == pytest.approx(front.lines[0].get_xdata()[half - 1])
    assert (y.min(), y.max()) == (pytest.approx(values[:half].min() - wide), pytest.approx(values[:half].max() + wide))
    np.testing.assert_allclose(front.lines[1].get_ydata(), values[:half] - less)
    assert len(back.collections) == 0
    assert len(back.lines) == 1


def test_quantities_without_an_estimate_have_no_band(estimated):
    assert all(not panel.collections for panel in plot_histories([estimated], quantity="displacement").axes)
