"""A bar is drawn over place and time, or along itself, in the units of its labels."""

import h5py
import numpy as np
import pytest
from matplotlib.collections import PathCollection

from dembound.plot.bar import plot_bar, plot_bar_field


@pytest.fixture
def recorded(spalled_run) -> dict[str, np.ndarray]:
    """Every snapshot's fields along the bar, (12, 41) each, their times, and the cracks, in SI units."""
    with h5py.File(spalled_run) as file:
        groups = list(file["snapshots"].values())
        motions = {name: np.array([each[name][:, 0] for each in groups]) for name in ("velocity", "displacement")}
        others = {name: np.array([each[name][:] for each in groups]) for name in ("stress", "damage")}
        cracks = {f"crack_{name}": file["cracks"][name][:] for name in ("time", "position")}
        return {**motions, **others, **cracks, "time": np.array([each.attrs["time"] for each in groups])}


def picture_of(panel):
    """The panel's picture over place and time."""
    (picture,) = panel.images
    return picture


def from_rest(values: np.ndarray) -> np.ndarray:
    """Values (k, n) after those of a bar at rest."""
    return np.vstack([np.zeros(values.shape[1]), values])


def drawn(panel, place: float, time: float) -> np.ndarray:
    """The colour (red, green, blue) that the panel's picture has at a place in m and a time in ms."""
    image, left, bottom, _ = picture_of(panel).make_image(None)
    column, row = panel.transData.transform((place, time)) - (left, bottom)
    return image[int(row), int(column), :3].astype(float)


def test_stress_damage_and_cracks_stand_over_place_and_time_and_below_along_the_bar(spalled_run, recorded):
    figure = plot_bar(spalled_run)
    stress, damage, *last = figure.axes[:4]
    np.testing.assert_array_equal(picture_of(stress).get_array(), from_rest(recorded["stress"] / 1e6))
    np.testing.assert_array_equal(picture_of(damage).get_array(), from_rest(recorded["damage"]))
    largest = np.abs(recorded["stress"]).max() / 1e6
    assert picture_of(stress).get_clim() == (-largest, largest)
    broken = np.column_stack([recorded["crack_position"][:, 0], 1e3 * recorded["crack_time"]])
    for panel in (stress, damage):
        assert picture_of(panel).get_extent() == (0.0, 1.0, 0.0, 1.5)
        (marks,) = [each for each in panel.collections if isinstance(each, PathCollection)]
        np.testing.assert_allclose(marks.get_offsets(), broken, rtol=1e-15)
    for panel, name, scale in zip(last, ("stress", "damage"), (1e6, 1.0), strict=True):
        line = panel.lines[0]
        np.testing.assert_allclose(line.get_xdata(), np.linspace(0.0, 1.0, 41), rtol=1e-15)
        np.testing.assert_array_equal(line.get_ydata(), recorded[name][-1] / scale)


@pytest.mark.parametrize(
    ("field", "scale", "label", "snapshot"),
    [
        ("stress", 1e6, "stress, tension positive (MPa)", 5),
        ("damage", 1.0, "local damage (–)", -1),
        ("velocity", 1.0, "velocity, positive to the right (m/s)", 5),
        ("displacement", 1e-3, "displacement, positive to the right (mm)", 5),
    ],
)
def test_one_field_is_shown_at_all_snapshots_or_one(spalled_run, recorded, field, scale, label, snapshot):
    whole = plot_bar_field(spalled_run, field).axes[0]
    np.testing.assert_array_equal(picture_of(whole).get_array(), from_rest(recorded[field] / scale))
    (panel,) = plot_bar_field(spalled_run, field, snapshot).axes
    np.testing.assert_array_equal(panel.lines[0].get_ydata(), recorded[field][snapshot] / scale)
    assert panel.get_ylabel() == label
