"""A bar is drawn over place and time, or along itself, in the units its labels tell."""

from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from matplotlib.collections import PathCollection

from dembound.errors import CaseError
from dembound.plot.bar import FEWEST, plot_bar, plot_bar_field


@pytest.fixture
def recorded(spalled_run) -> dict[str, np.ndarray]:
    """Every snapshot's fields along the bar, (12, 41) each, their times, and the cracks, in SI units."""
    with h5py.File(spalled_run) as file:
        groups = list(file["snapshots"].values())
        motions = {name: np.array([each[name][:, 0] for each in groups]) for name in ("velocity", "displacement")}
        others = {name: np.array([each[name][:] for each in groups]) for name in ("stress", "damage")}
        cracks = {f"crack_{name}": file["cracks"][name][:] for name in ("time", "position")}
        return {**motions, **others, **cracks, "time": np.array([each.attrs["time"] for each in groups])}


@pytest.fixture
def changed(spalled_run, tmp_path):
    """A copy of the record, and the file to change it by."""
    path = tmp_path / "run.h5"
    path.write_bytes(spalled_run.read_bytes())
    with h5py.File(path, "r+") as file:
        yield path, file


def keep(file: h5py.File, count: int) -> None:
    """Leave only the last snapshots."""
    for number in list(file["snapshots"])[: len(file["snapshots"]) - count]:
        del file["snapshots"][number]
    file.flush()


def picture_of(panel):
    """The panel's picture over place and time."""
    (picture,) = panel.images
    return picture


def test_stress_and_damage_stand_over_place_and_time_and_below_along_the_bar(spalled_run, recorded):
    figure = plot_bar(spalled_run)
    stress, damage, *last = figure.axes[:4]
    np.testing.assert_array_equal(picture_of(stress).get_array(), recorded["stress"] / 1e6)
    np.testing.assert_array_equal(picture_of(damage).get_array(), recorded["damage"])
    largest = np.abs(recorded["stress"]).max() / 1e6
    assert picture_of(stress).get_clim() == (-largest, largest)
    assert picture_of(damage).get_clim() == (0.0, 1.0)
    for panel, name, scale in zip(last, ("stress", "damage"), (1e6, 1.0), strict=True):
        line = panel.lines[0]
        np.testing.assert_allclose(line.get_xdata(), np.linspace(0.0, 1.0, 41), rtol=1e-15)
        np.testing.assert_array_equal(line.get_ydata(), recorded[name][-1] / scale)
        assert panel.get_xlabel() == "x (m)"
        assert panel.get_title("left") == "at the end, t = 1.5 ms"
    assert [panel.get_xlabel() for panel in figure.axes[4:]] == ["stress, tension positive (MPa)", "local damage (–)"]
    assert stress.get_ylabel() == damage.get_ylabel() == "time (ms)"
    assert figure.get_suptitle() == "spalled: stress and local damage along the bar"


def test_cells_are_centred_on_nodes_and_snapshots_however_these_are_spaced(changed):
    run, file = changed
    left, right, bottom, top = picture_of(plot_bar(run).axes[0]).get_extent()
    # 41 nodes from 0 to 1 m, 12 snapshots from 0.125 to 1.5 ms, and half a cell around them
    assert (left, right, bottom, top) == pytest.approx((-0.0125, 1.0125, 0.0625, 1.5625))
    file["snapshots/0000"].attrs["time"] = 5e-5
    file.flush()
    picture = picture_of(plot_bar(run).axes[0])
    for time, row in ((0.14, 0), (0.16, 1), (0.31, 1), (0.32, 2)):  # half way between 0.05, 0.25 and 0.375 ms
        there = picture.get_cursor_data(SimpleNamespace(xdata=0.2, ydata=time))
        assert there == picture.get_array()[row, 8]


def test_broken_bonds_are_marked_where_and_when_they_broke(spalled_run, recorded):
    assert len(recorded["crack_time"]) > 0
    for panel in plot_bar(spalled_run).axes[:2]:
        (marks,) = [each for each in panel.collections if isinstance(each, PathCollection)]
        expected = np.column_stack([recorded["crack_position"][:, 0], 1e3 * recorded["crack_time"]])
        np.testing.assert_allclose(marks.get_offsets(), expected, rtol=1e-15)


def test_a_method_that_takes_over_is_a_line_with_its_name(changed):
    run, file = changed
    del file["laws"]
    file["laws/name"] = ["finite differences", "peridynamics, m = 3"]
    file["laws/time"] = [0.0, 1.25e-3]
    file.flush()
    figure = plot_bar_field(run, "velocity")
    (line,) = figure.axes[0].lines
    assert list(line.get_ydata()) == [1.25, 1.25]
    assert "peridynamics, m = 3 from 1.25 ms" in [text.get_text() for text in figure.legends[0].get_texts()]


def test_of_few_snapshots_there_is_a_line_for_each(changed, recorded):
    run, file = changed
    keep(file, FEWEST)
    assert plot_bar(run).axes[0].images
    keep(file, FEWEST - 1)
    figure = plot_bar(run)
    stress, damage = figure.axes
    for panel, name, scale in ((stress, "stress", 1e6), (damage, "damage", 1.0)):
        lines = [line for line in panel.lines if line.get_label().startswith("t = ")]
        np.testing.assert_array_equal([line.get_ydata() for line in lines], recorded[name][3:] / scale)
        assert [line.get_label() for line in lines] == [f"t = {1e3 * time:.4g} ms" for time in recorded["time"][3:]]
    assert (stress.get_ylabel(), damage.get_xlabel()) == ("stress, tension positive (MPa)", "x (m)")
    looks = {(line.get_color(), line.get_linestyle()) for line in stress.lines}
    assert len(looks) == FEWEST - 1


def test_the_last_state_alone_is_enough(changed, recorded):
    run, file = changed
    keep(file, 1)
    stress, damage = plot_bar(run).axes
    np.testing.assert_array_equal(stress.lines[0].get_ydata(), recorded["stress"][-1] / 1e6)
    assert [line.get_label() for line in damage.lines] == ["t = 1.5 ms", "cracked from a damage of 0.3"]
    assert list(damage.lines[1].get_ydata()) == [0.3, 0.3]


@pytest.mark.parametrize(
    ("field", "scale", "label"),
    [
        ("stress", 1e6, "stress, tension positive (MPa)"),
        ("damage", 1.0, "local damage (–)"),
        ("velocity", 1.0, "velocity, positive to the right (m/s)"),
        ("displacement", 1e-3, "displacement, positive to the right (mm)"),
    ],
)
def test_one_field_is_shown_at_all_snapshots_or_one(spalled_run, recorded, field, scale, label):
    whole, _, colours = plot_bar_field(spalled_run, field).axes
    np.testing.assert_array_equal(picture_of(whole).get_array(), recorded[field] / scale)
    assert colours.get_xlabel() == label
    for snapshot in (5, -1):
        figure = plot_bar_field(spalled_run, field, snapshot)
        (panel,) = figure.axes
        np.testing.assert_array_equal(panel.lines[0].get_ydata(), recorded[field][snapshot] / scale)
        assert panel.lines[0].get_label() == f"t = {1e3 * recorded['time'][snapshot]:.4g} ms"
        assert panel.get_ylabel() == label


def test_a_bar_at_rest_is_drawn(changed):
    run, file = changed
    for snapshot in file["snapshots"].values():
        snapshot["stress"][:] = 0.0
    file.flush()
    assert picture_of(plot_bar_field(run, "stress").axes[0]).get_clim() == (-1.0, 1.0)


def test_what_a_bar_does_not_have_is_refused(spalled_run, changed):
    with pytest.raises(CaseError, match="field: is stress_xx, must be one of stress, damage, velocity, displacement"):
        plot_bar_field(spalled_run, "stress_xx")
    with pytest.raises(CaseError, match="no snapshot 12, they are 0 to 11"):
        plot_bar_field(spalled_run, "stress", 12)
    run, file = changed
    del file["snapshots"]
    file.flush()
    with pytest.raises(CaseError, match="no snapshot -1, they are none"):
        plot_bar(run)
